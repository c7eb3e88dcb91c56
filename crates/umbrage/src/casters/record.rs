//! From the CPU to the GPU: once a frame, in the host's encoder.

use super::edges::Edges;
use super::world::{Casters, group, next_version};
use crate::{error::Error, passes::Passes};

impl Casters {
    /// Sends all that has changed since the last time, and moves the vertices of all instances that
    /// [`Casters::set_pose`] bent: once a frame, before anything of it is drawn and before
    /// techniques are prepared. Costs what has changed; nothing, where nothing has. Where the box
    /// around everything crosses a power of two of metres, or moves away, all instances are sent
    /// and all maps are drawn anew: things that hold the scene's extent avoid that.
    ///
    /// A host that drops the encoder loses nothing: the next call records it again.
    ///
    /// # Errors
    /// [`Error::Size`] where the vertices of a scene with poses have grown beyond what the device's
    /// shaders may write; [`Error::DeviceLost`].
    pub fn record(&mut self, passes: &mut Passes<'_>) -> Result<(), Error> {
        self.gpu.check_loss()?;
        if !self.journal.holds() {
            self.poses.mark_all();
            self.following.mark_all();
            // Maps may show what was drawn without.
            self.version = next_version();
        }
        self.settle();
        self.write_instances()?;
        self.make_edges_that_follow();
        self.bind();
        self.journal.record(passes, self.poses.have_changed() || self.following.have_changed());
        self.following.record(&self.gpu, passes, self.geometry.positions.buffer())?;
        let edges = self.edges.get();
        let planes = edges.map(Edges::pose_group);
        let planes_of = |mesh| edges.map(|edges| edges.of_mesh(mesh).planes());
        let moved: Vec<u32> = self.following.changed().collect();
        self.poses.record(&self.gpu, passes, &self.geometry, (planes, &moved), planes_of)?;
        self.following.settle();
        if let Some(planes) = self.receiver_planes.get_mut() {
            planes.follow(&self.geometry.meshes, &self.placed, &self.solid);
        }
        Ok(())
    }

    /// # Errors
    /// [`Error::Scene`] where something has changed since [`Casters::record`].
    pub(crate) fn check_recorded(&self) -> Result<(), Error> {
        let have_moved = self.poses.have_changed() || self.following.have_changed();
        if self.changed.is_empty() && self.journal.is_recorded() && !have_moved {
            return Ok(());
        }
        let what = "casters have changed and the GPU does not know: call `Casters::record` once a frame, before \
                    techniques are prepared";
        Err(Error::Scene(what.into()))
    }

    /// Planes between vertices that a host moves are made in frames alone, so edges have to be
    /// there before a technique asks. Where they do not fit, techniques that ask say why.
    fn make_edges_that_follow(&mut self) {
        if self.following.is_empty() || self.edges.get().is_some() || self.edges_do_not_fit {
            return;
        }
        self.edges_do_not_fit = self.make_all_edges(&self.gpu).is_err();
        self.following.mark_all();
    }

    /// Where the scene has grown out of its region, or moved: trees, planes and instances are made
    /// anew, since all of them go by that.
    pub(super) fn settle(&mut self) {
        let region = super::region::Region::of(&self.all_bounds());
        if region == self.region {
            return;
        }
        self.region = region;
        self.version = next_version();
        for tree in [&mut self.casting, &mut self.receiving, &mut self.bystanders] {
            let mut new = region.tree();
            (0..self.placed.len() as u32)
                .filter_map(|place| tree.bounds(place).map(|bounds| (place, bounds)))
                .for_each(|(place, bounds)| new.insert(place, bounds));
            new.put_in_order();
            *tree = new;
        }
        let live = (0..).zip(&self.placed).filter(|(_, placed)| placed.is_batched);
        live.for_each(|(place, _)| self.changed.push(place));
        self.receiver_planes.take();
    }

    /// Notes what has to be copied of instances that have changed.
    pub(super) fn write_instances(&mut self) -> Result<(), Error> {
        self.instances.fit(&self.gpu, self.placed.len() as u64, &mut self.journal)?;
        for places in self.changed.take() {
            let origin = self.region.origin;
            let all = &self.placed[places.start as usize..places.end as usize];
            let data: Vec<_> = all.iter().map(|placed| placed.data(origin)).collect();
            self.instances.write(&mut self.journal, places.start, &data);
        }
        Ok(())
    }

    /// Binds the buffers that there are now.
    pub(super) fn bind(&mut self) {
        let buffers = [self.instances.buffer(), self.appearance.store.buffer()];
        if self.bound.each_ref() != buffers {
            self.bound = buffers.map(wgpu::Buffer::clone);
            self.bind_group = group(&self.gpu, &self.instances, &self.appearance);
        }
        let of_vertices = [self.geometry.positions.buffer(), self.geometry.indices.buffer(), self.instances.buffer()];
        // Where they do not fit a shader, techniques that ask for edges say why.
        if self.edges.get_mut().is_some_and(|edges| edges.bind(&self.gpu, of_vertices).is_err()) {
            self.edges.take();
            self.version = next_version();
        }
    }
}

#[cfg(test)]
mod tests;
