//! What a camera sees of the scene, drawn by a host's own pipelines.

use super::draw_list::{DrawList, InstanceNumbers, Surface};
use super::material::texture_layout;
use super::vertices::vertex_layouts;
use super::world::Casters;
use crate::{gpu::Gpu, passes::Passes};
use umbrage_core::{CameraView, Frustum};

/// Draws the instances that a camera sees: into a G-buffer, say. Keeps its memory from frame to
/// frame.
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
        vertex_layouts(true)
    }

    /// Finds what `camera` sees, before the pass that draws it begins.
    pub fn find(&mut self, gpu: &Gpu, passes: &mut Passes<'_>, casters: &Casters, camera: &CameraView) {
        let frustum = Frustum::of(&camera.clip_from_world());
        let seen = (0..).zip(casters.placed()).filter(|(_, placed)| placed.shown && frustum.may_see(&placed.bounds));
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
        let pipeline = |surface| if surface == Surface::Masked { masked } else { opaque };
        self.numbers.draw(pass, casters, &self.list, true, pipeline);
    }
}
