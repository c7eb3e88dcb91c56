//! What a camera sees of the scene, drawn by a host's own pipelines.

use super::draw_list::{DrawList, InstanceNumbers, Surface};
use super::material::texture_layout;
use super::placed::Placed;
use super::vertices::vertex_layouts;
use super::world::Casters;
use crate::{gpu::Gpu, passes::Passes, view::around_eye};
use umbrage_core::{CameraView, Frustum};

/// What a host chooses a pipeline of [`SeenCasters::draw`] by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SeenSurface {
    /// It has an alpha mask.
    pub masked: bool,
    /// It has a picture; without one, that of group 2 is white.
    pub textured: bool,
    /// No more than its front faces can be seen, which are wound counter-clockwise as the library's
    /// own cameras see them: it is a closed convex body, and the camera is outside of it.
    pub one_sided: bool,
}

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
    /// What the camera may look into, in order.
    pierced: Vec<u32>,
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
        // Single precision moves surfaces, and the near plane is close.
        let eye = around_eye(camera);
        let eye = eye.grown(0.1 * eye.radius() + 1e-6 * eye.largest_coordinate());
        self.places.clear();
        self.pierced.clear();
        for (place, placed) in seen {
            self.places.push(place);
            if placed.bounds.overlaps(&eye) {
                self.pierced.push(place);
            }
        }
        casters.sort(&mut self.places);
        self.numbers.clear(gpu, casters, 1);
        self.numbers.list(casters, &self.places, None, Some(&self.pierced), &mut self.list);
        self.numbers.upload(passes);
    }

    /// Draws what was found, each surface by the pipeline that `pipeline` has for it.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        casters: &Casters,
        pipeline: impl Fn(SeenSurface) -> &'p wgpu::RenderPipeline,
    ) {
        let of = |surface, textured| SeenSurface {
            masked: surface == Surface::Masked,
            textured,
            one_sided: surface == Surface::Solid,
        };
        self.numbers
            .draw(pass, casters, &self.list, true, |surface, textured, _| Some(pipeline(of(surface, textured))));
    }
}
