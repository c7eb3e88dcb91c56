//! Whether casters are those that a transfer was baked of.

use crate::Error;
use crate::casters::{Casters, Placed};
use umbrage_core::Bounds;
use umbrage_core::transfer::{BakedMesh, Transfer};

/// What of the casters was found with a transfer.
pub(super) struct Fits {
    /// Boxes around the baked meshes, in their own space, and the instances that they are of.
    meshes: Vec<(usize, Bounds)>,
    /// Instances that have a transfer, by number.
    known: Vec<bool>,
    /// When first seen: the casters, and for each mesh its number, its version and its box.
    seen: Option<(u64, Vec<Seen>)>,
}

type Seen = Option<(u32, u64, Bounds)>;

impl Fits {
    pub fn new(transfer: &Transfer, instances: usize) -> Self {
        let mut known = vec![false; instances];
        transfer.meshes.iter().for_each(|mesh| known[mesh.instance] = true);
        let bounds = |mesh: &BakedMesh| (mesh.instance, mesh.mesh.bounds());
        Self { meshes: transfer.meshes.iter().map(bounds).collect(), known, seen: None }
    }

    /// # Errors
    /// [`Error::Scene`] where something is drawn that has no transfer, or has another form than in
    /// the bake.
    pub fn check(&mut self, casters: &Casters) -> Result<(), Error> {
        let stranger = (0..)
            .zip(casters.placed())
            .find(|(place, placed)| placed.shown && !self.is_known(casters, *place) && has_triangles(casters, placed));
        if let Some((place, _)) = stranger {
            return Err(unfit(&format!("instance {place} has none")));
        }
        let now: Vec<Seen> = self.meshes.iter().map(|(instance, _)| seen(casters, *instance)).collect();
        let before = self.seen.take().filter(|(version, _)| *version == casters.version());
        let Some((version, before)) = before else {
            self.check_bounds(casters)?;
            self.seen = Some((casters.version(), now));
            return Ok(());
        };
        let changed = before.iter().zip(&now).position(|(a, b)| b.is_some() && a != b);
        self.seen = Some((version, before));
        match changed.and_then(|i| self.meshes.get(i)) {
            Some((instance, _)) => Err(unfit(&format!("instance {instance} was bent, or has another mesh now"))),
            None => Ok(()),
        }
    }

    fn is_known(&self, casters: &Casters, place: usize) -> bool {
        self.known.get(place).is_some_and(|known| *known) && is_there(casters, place)
    }

    /// A mesh that joints bend has a box for each joint, which need not be tight.
    fn check_bounds(&self, casters: &Casters) -> Result<(), Error> {
        for (instance, bounds) in &self.meshes {
            let Some((_, _, now)) = seen(casters, *instance) else { continue };
            let is_bent = casters.placed().get(*instance).is_some_and(Placed::is_bent);
            let room = 1e-4 * bounds.size().length() + 1e-30;
            let off = (now.min - bounds.min).abs().max((now.max - bounds.max).abs()).max_element();
            if !is_bent && bounds.size().is_finite() && off.is_finite() && off > room {
                return Err(unfit(&format!("instance {instance} has another form there")));
            }
        }
        Ok(())
    }
}

fn unfit(what: &str) -> Error {
    Error::Scene(format!(
        "the transfer that `prt` was given is not of these casters: {what}; bake the scene as it is now"
    ))
}

/// True while the first user of a place has it.
pub(super) fn is_there(casters: &Casters, place: usize) -> bool {
    casters.instance(place).is_some_and(|id| casters.has(id))
}

fn seen(casters: &Casters, instance: usize) -> Seen {
    let placed = casters.placed().get(instance).filter(|p| p.shown && is_there(casters, instance))?;
    let part = casters.meshes().get(placed.mesh as usize)?;
    Some((placed.mesh, part.version, part.bounds))
}

fn has_triangles(casters: &Casters, placed: &Placed) -> bool {
    casters.meshes().get(placed.mesh as usize).is_some_and(|part| part.index_count() > 0)
}
