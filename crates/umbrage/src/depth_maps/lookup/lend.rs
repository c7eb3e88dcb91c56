//! The look-up for shaders of hosts: the same maps and the same shader, and uniforms of their own,
//! since their receivers are given relative to the eye.

use super::pass::{BINDINGS, Lookup, LookupInput, all_layers};
use crate::gpu::Gpu;
use crate::inline::{Binding, Lent, LentLookup, Resource};

impl LookupInput {
    /// From the next frame on, what shaders of hosts read is kept up to date. Returns the uniforms.
    pub fn keep_lent(&mut self) -> &wgpu::Buffer {
        self.in_eye.is_lent = true;
        &self.in_eye.uniforms
    }
}

impl Lookup {
    /// What shaders of hosts need, for the maps `input` was last prepared for. `stage` are bindings
    /// of the stage.
    pub fn lend(&self, gpu: &Gpu, maps: Option<&wgpu::Texture>, input: &mut LookupInput, stage: Vec<Binding>) -> Lent {
        let current = input.current.and_then(|current| self.pipelines.get(current));
        let in_eye = &mut input.in_eye;
        if !std::mem::replace(&mut in_eye.is_lent, true) {
            // The frame was recorded without it.
            gpu.queue.write_buffer(&in_eye.uniforms, 0, bytemuck::bytes_of(&in_eye.data));
        }
        let (Some((variant, _)), Some(maps)) = (current, maps) else { return in_eye.last.clone() };
        if in_eye.maps.as_ref().is_none_or(|(of, _)| of != maps) {
            in_eye.maps = Some((maps.clone(), all_layers(maps)));
        }
        let Some((_, view)) = &in_eye.maps else { return in_eye.last.clone() };
        let own = [
            Resource::Buffer(in_eye.uniforms.clone()),
            Resource::View(view.clone()),
            Resource::Sampler(self.sampler.clone()),
        ];
        let own = (0..).zip(BINDINGS).zip(own).map(|((i, ty), resource)| Binding { at: (1, i), ty, resource });
        let (shader, constants) = (self.shader, self.constants_of(*variant));
        in_eye.last = Lent { lookup: Some(LentLookup { shader, constants, bindings: own.chain(stage).collect() }) };
        in_eye.last.clone()
    }
}
