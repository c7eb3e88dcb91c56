//! What follows where an instance has changed: boxes, draws, trees and logs.

use super::batches::Key;
use super::placed::{Placed, is_outward, moved_plane};
use super::sides::Sides;
use super::world::Casters;

impl Casters {
    /// After what bounds an instance has changed: its transform, or its mesh.
    pub(super) fn shape(&mut self, place: u32) {
        let placed = &mut self.placed[place as usize];
        let part = &self.geometry.meshes[placed.mesh as usize];
        let many = placed.many.as_ref();
        placed.posed = placed.has_own_mesh || part.is_moving() || part.is_unknown() || many.is_some();
        placed.sides = Sides::of(&placed.world_from_mesh);
        let bounds = many.map_or(part.bounds, |many| many.bounds);
        placed.bounds = bounds.transformed(&placed.world_from_mesh);
        let plane = part.plane.filter(|_| many.is_none());
        placed.plane = plane.map(|p| moved_plane(p, &placed.world_from_mesh));
        self.look(place);
        self.track(place);
    }

    /// After an instance got another material, or its material has changed: what is opaque, and
    /// was, casts the same.
    pub(super) fn look_otherwise(&mut self, place: u32, was_masked: bool) {
        self.look(place);
        if was_masked || self.placed[place as usize].masked {
            self.track(place);
        } else {
            self.changed.push(place);
        }
    }

    /// After what an instance looks like has changed.
    pub(super) fn look(&mut self, place: u32) {
        let placed = &mut self.placed[place as usize];
        let look = &self.appearance.looks[placed.material as usize];
        placed.masked = look.masked;
        let part = &self.geometry.meshes[placed.mesh as usize];
        let is_solid = part.solid && !look.masked && placed.many.is_none();
        self.solid.set(place, is_solid && is_outward(&placed.world_from_mesh));
        let texture = look.texture.map(|texture| self.appearance.pictures[texture as usize].order);
        let many = placed.many.as_ref();
        let key = Key {
            masked: look.masked,
            texture,
            is_posed: placed.has_own_mesh,
            mesh: part.order,
            many: many.map_or(0, |_| placed.order),
        };
        let batch = self.batches.join(key, placed.mesh, look.texture, many.map(|_| place));
        let form = part.form(many.map(|many| &many.matrices));
        if !self.forms.contains(&form) {
            self.forms.push(form);
        }
        // The first batch of one that has just come is the one that it has.
        if std::mem::replace(&mut placed.is_batched, true) {
            self.batches.leave(placed.batch);
        }
        placed.batch = batch;
    }

    /// After anything of an instance has changed: trees, logs and what is made of them follow.
    pub(super) fn track(&mut self, place: u32) {
        let placed = &mut self.placed[place as usize];
        let did_cast = std::mem::replace(&mut placed.casts, placed.shown && placed.wanted.casts);
        placed.receives = placed.shown && placed.wanted.receives;
        let Placed { casts, receives, bounds, .. } = *placed;
        let stands = placed.shown && !casts && !receives;
        let trees = [(&mut self.casting, casts), (&mut self.receiving, receives), (&mut self.bystanders, stands)];
        for (tree, within) in trees {
            if within {
                tree.update(place, bounds);
            } else {
                tree.remove(place);
            }
        }
        if did_cast || casts {
            self.moves.push(place);
        }
        let part = &mut self.geometry.meshes[placed.mesh as usize];
        part.casting = part.casting + u32::from(casts) - u32::from(did_cast);
        let is_blind = casts && (part.is_unknown() || placed.many.is_some());
        let was_blind = std::mem::replace(&mut placed.is_blind, is_blind);
        self.blind = self.blind + u32::from(is_blind) - u32::from(was_blind);
        self.changed.push(place);
        if let Some(planes) = self.receiver_planes.get_mut() {
            planes.note(place);
        }
    }

    /// The mesh that a host gave an instance: not its own, where that is bent.
    fn given_mesh(&self, place: u32) -> u32 {
        let mesh = self.placed[place as usize].mesh;
        self.geometry.meshes[mesh as usize].source.unwrap_or(mesh)
    }

    pub(super) fn join_mesh(&mut self, place: u32) {
        let mesh = self.given_mesh(place);
        self.placed[place as usize].member[0] = join(&mut self.geometry.meshes[mesh as usize].members, place);
    }

    pub(super) fn leave_mesh(&mut self, place: u32) {
        let mesh = self.given_mesh(place);
        leave(&mut self.geometry.meshes[mesh as usize].members, &mut self.placed, place, 0);
    }

    pub(super) fn join_material(&mut self, place: u32) {
        let material = self.placed[place as usize].material;
        self.placed[place as usize].member[1] = join(&mut self.appearance.looks[material as usize].members, place);
    }

    pub(super) fn leave_material(&mut self, place: u32) {
        let material = self.placed[place as usize].material;
        leave(&mut self.appearance.looks[material as usize].members, &mut self.placed, place, 1);
    }
}

/// Adds to a list; where in it.
fn join(list: &mut Vec<u32>, place: u32) -> u32 {
    list.push(place);
    list.len() as u32 - 1
}

/// Takes out of a list, whose last one takes the free place in it.
fn leave(list: &mut Vec<u32>, placed: &mut [Placed], place: u32, kind: usize) {
    let at = placed[place as usize].member[kind];
    list.swap_remove(at as usize);
    if let Some(moved) = list.get(at as usize) {
        placed[*moved as usize].member[kind] = at;
    }
}
