//! Which instances one draw can hold: those of one mesh with one texture.

use std::collections::HashMap;

/// Instances of one mesh with one texture: one draw.
pub(super) struct Batch {
    key: Key,
    /// Index into the meshes.
    pub mesh: u32,
    /// Index into the textures.
    pub texture: Option<u32>,
    pub masked: bool,
    /// The one place whose matrices a host has, where it is that.
    pub many: Option<u32>,
    members: u32,
}

/// Batches are drawn in this order, which does not depend on how the scene came about.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Key {
    pub masked: bool,
    /// When texture and mesh were added; the meshes of posed instances come last.
    pub texture: Option<u64>,
    pub is_posed: bool,
    pub mesh: u64,
    /// When an instance came whose matrices a host has; 0 for others.
    pub many: u64,
}

/// All that have members.
#[derive(Default)]
pub(super) struct Batches {
    all: Vec<Batch>,
    spare: Vec<u32>,
    by_key: HashMap<Key, u32>,
    order: Vec<u32>,
}

impl Batches {
    /// Whether any instance has an alpha mask: these come last.
    pub fn has_masked(&self) -> bool {
        self.order.last().is_some_and(|last| self.get(*last).masked)
    }

    /// The batch of an instance that came.
    pub fn join(&mut self, key: Key, mesh: u32, texture: Option<u32>, many: Option<u32>) -> u32 {
        let number = match self.by_key.get(&key) {
            Some(number) => *number,
            None => self.start(Batch { key, mesh, texture, masked: key.masked, many, members: 0 }),
        };
        self.all[number as usize].members += 1;
        number
    }

    fn start(&mut self, batch: Batch) -> u32 {
        let key = batch.key;
        let at = self.order.partition_point(|other| self.all[*other as usize].key < key);
        let number = match self.spare.pop() {
            Some(number) => {
                self.all[number as usize] = batch;
                number
            }
            None => {
                self.all.push(batch);
                self.all.len() as u32 - 1
            }
        };
        self.by_key.insert(key, number);
        self.order.insert(at, number);
        number
    }

    /// After an instance went.
    pub fn leave(&mut self, number: u32) {
        let batch = &mut self.all[number as usize];
        batch.members -= 1;
        if batch.members == 0 {
            let key = batch.key;
            self.by_key.remove(&key);
            let at = self.order.partition_point(|other| self.all[*other as usize].key < key);
            self.order.remove(at);
            self.spare.push(number);
        }
    }

    pub fn get(&self, number: u32) -> &Batch {
        &self.all[number as usize]
    }

    /// Numbers are below this.
    pub fn end(&self) -> usize {
        self.all.len()
    }

    /// In the order of drawing.
    pub fn order(&self) -> &[u32] {
        &self.order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_are_in_order_whatever_came_and_went() {
        let key = |mesh| Key { masked: mesh % 2 == 1, texture: Some(mesh % 3), is_posed: false, mesh, many: 0 };
        let mut batches = Batches::default();
        let mut held: Vec<(u64, u32)> = Vec::new();
        for round in 0..300_u64 {
            let mesh = round * 7 % 17;
            held.push((mesh, batches.join(key(mesh), mesh as u32, None, None)));
            if round % 3 != 0 {
                let (mesh, number) = held.swap_remove((round * 5) as usize % held.len());
                assert_eq!(batches.get(number).mesh, mesh as u32);
                batches.leave(number);
            }
            let keys: Vec<Key> = batches.order().iter().map(|n| batches.get(*n).key).collect();
            assert_eq!(batches.has_masked(), held.iter().any(|(mesh, _)| mesh % 2 == 1));
            let mut wanted: Vec<Key> = held.iter().map(|(mesh, _)| key(*mesh)).collect();
            wanted.sort();
            wanted.dedup();
            assert!(keys == wanted, "round {round}");
        }
        assert!(batches.end() <= 17);
    }
}
