//! What a camera sees of the scene, drawn by a host's own pipelines.

use super::draw_list::{DrawList, InstanceNumbers, Surface};
use super::material::texture_layout;
use super::placed::Placed;
use super::vertices::vertex_layouts;
use super::world::Casters;
use crate::{gpu::Gpu, passes::Passes};
use umbrage_core::{CameraView, Frustum};

/// Draws the instances that a camera sees: into a G-buffer, say. Keeps its memory from frame to
/// frame. What a host lends is left to its own draws.
///
/// A host's pipelines have its own group 0, then [`SeenCasters::layouts`], and
/// [`SeenCasters::vertex_layouts`]. Their shaders read positions as location 0, instance numbers as
/// 1, normals as 2 and texture coordinates as 3, and use the modules `casters` and `materials` to
/// get into the world and to materials.
#[derive(Default)]
pub struct SeenCasters {
    places: Vec<u32>,
    numbers: InstanceNumbers,
    list: DrawList,
}

impl SeenCasters {
    /// Layouts of groups 1 and 2.
    pub fn layouts(gpu: &Gpu) -> [wgpu::BindGroupLayout; 2] {
        [Casters::layout(gpu), texture_layout(gpu)]
    }

    /// Vertex buffers of the pipelines.
    pub fn vertex_layouts() -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
        vertex_layouts()
    }

    /// Finds what `camera` sees, before the pass that draws it begins.
    pub fn find(&mut self, gpu: &Gpu, passes: &mut Passes<'_>, casters: &Casters, camera: &CameraView) {
        let frustum = Frustum::of(&camera.clip_from_world());
        let is_own = |placed: &Placed| placed.many.is_none() && casters.meshes()[placed.mesh as usize].lent.is_none();
        let is_seen = |placed: &Placed| placed.shown && frustum.may_see(&placed.bounds) && is_own(placed);
        let seen = (0..).zip(casters.placed()).filter(|(_, placed)| is_seen(placed));
        self.places.clear();
        self.places.extend(seen.map(|(place, _)| place));
        casters.sort(&mut self.places);
        self.numbers.clear(gpu, casters, 1);
        self.numbers.list(casters, &self.places, None, None, &mut self.list);
        self.numbers.upload(passes);
    }

    /// Draws what was found, surfaces with an alpha mask by the pipeline `masked`.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        casters: &Casters,
        opaque: &wgpu::RenderPipeline,
        masked: &wgpu::RenderPipeline,
    ) {
        let pipeline = |surface, _: &_| Some(if surface == Surface::Masked { masked } else { opaque });
        self.numbers.draw(pass, casters, &self.list, true, pipeline);
    }
}
