//! Handles: numbers that are used again, told apart by how often they were.

use crate::error::Error;

/// What a handle holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Id {
    slot: u32,
    /// Odd for what is there.
    generation: u32,
    /// Whose it is: [`Slots::of`].
    of: u32,
}

macro_rules! handles {
    ($($(#[$doc:meta])* $name:ident)*) => {
        $(
            $(#[$doc])*
            ///
            /// A handle of what was removed, or of other casters, names nothing: who is given one
            /// answers with [`Error::Handle`], and never takes it for what came later.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
            pub struct $name(pub(super) Id);
        )*
    };
}

handles! {
    /// Handle of an instance of [`super::Casters`].
    InstanceId
    /// Handle of a mesh of [`super::Casters`].
    MeshId
    /// Handle of a material of [`super::Casters`].
    MaterialId
    /// Handle of a texture of [`super::Casters`].
    TextureId
}

/// Numbers of things that come and go, the lowest free ones first in a world that only grows.
pub(super) struct Slots {
    /// For errors: what these are.
    what: &'static str,
    of: u32,
    generations: Vec<u32>,
    free: Vec<u32>,
}

impl Slots {
    pub fn new(what: &'static str, of: u32) -> Self {
        Self { what, of, generations: Vec::new(), free: Vec::new() }
    }

    /// A number for something new.
    pub fn insert(&mut self) -> (u32, Id) {
        let slot = self.free.pop().unwrap_or_else(|| {
            self.generations.push(0);
            self.generations.len() as u32 - 1
        });
        let generation = &mut self.generations[slot as usize];
        *generation += 1;
        (slot, Id { slot, generation: *generation, of: self.of })
    }

    /// Takes a number back; it must be in use.
    pub fn remove(&mut self, slot: u32) {
        let generation = &mut self.generations[slot as usize];
        *generation += 1;
        // One that has been used so often that generations would repeat stays unused.
        if *generation < u32::MAX - 1 {
            self.free.push(slot);
        }
    }

    /// The number that a handle stands for.
    pub fn find(&self, id: Id) -> Result<u32, Error> {
        match self.generations.get(id.slot as usize) {
            Some(generation) if *generation == id.generation && id.of == self.of => Ok(id.slot),
            _ => Err(Error::Handle { what: self.what }),
        }
    }

    /// The handle of what has a number now.
    pub fn at(&self, slot: u32) -> Option<Id> {
        let generation = *self.generations.get(slot as usize)?;
        (generation % 2 == 1).then_some(Id { slot, generation, of: self.of })
    }

    /// The handle of the first user of a number, where there has been one.
    pub fn first_at(&self, slot: usize) -> Option<Id> {
        (slot < self.generations.len()).then_some(Id { slot: slot as u32, generation: 1, of: self.of })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_of_what_was_removed_names_nothing() {
        let (mut slots, mut others) = (Slots::new("thing", 1), Slots::new("thing", 2));
        let (slot, first) = slots.insert();
        assert_eq!(slots.find(first), Ok(slot));
        assert_eq!(others.find(first), Err(Error::Handle { what: "thing" }));
        others.insert();
        assert_eq!(others.find(first), Err(Error::Handle { what: "thing" }), "of others");
        slots.remove(slot);
        assert!(slots.find(first).is_err() && slots.at(slot).is_none());
        let (again, second) = slots.insert();
        assert_eq!(again, slot, "the number is used again");
        assert!(slots.find(first).is_err() && slots.find(second) == Ok(slot));
        assert_eq!((slots.at(slot), slots.first_at(0)), (Some(second), Some(first)));
        slots.generations[slot as usize] = u32::MAX - 2;
        slots.remove(slot);
        assert_ne!(slots.insert().0, slot, "generations would repeat");
    }
}
