//! Casters that a host draws itself into the maps of lights: what bends in the wind, terrain,
//! particles, scenes that the GPU drives.

use crate::{error::Error, fullscreen, gpu::Gpu};
use std::sync::Arc;
use umbrage_core::glam::{DMat4, DVec3};
use umbrage_core::{Bounds, Frustum, light_view::LightView};

/// What a technique has to know of casters, see [`crate::TechniqueInfo::casters`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Nothing.
    Nothing,
    /// What they look like from the light: a host may draw them itself, see [`HostCasters`].
    Depth,
    /// Their triangles.
    Triangles,
    /// Their edges, and the triangles at these.
    Edges,
}

/// Draws casters that no mesh stands for, see [`super::Casters::set_host_casters`].
pub trait HostCasters: wgpu::WasmNotSendSync {
    /// Draws into one view of a light; called while a technique is recorded, after the casters that
    /// the library draws. Group 0 is bound, see [`CasterView::layout`]; all else is the host's, and
    /// need not be put back.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView<'_>);
}

/// A view of a light that casters are drawn into.
#[derive(Clone, Copy, Debug)]
pub struct CasterView<'a> {
    /// The matrix and the size of the map, and the layer that it is.
    pub light_view: &'a LightView,
    /// What positions are relative to in the host's shader: [`super::Casters::origin`].
    pub origin: DVec3,
    /// True where a compute shader crops the view to what is seen: the matrix of
    /// [`CasterView::layout`] has more than [`CasterView::light_view`] says of it, which is around
    /// all.
    pub is_cropped_on_gpu: bool,
}

impl CasterView<'_> {
    /// The layout of group 0: a uniform at binding 0 that starts with a `mat4x4f`, which takes
    /// positions relative to [`CasterView::origin`] to the clip space of the view.
    pub fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        fullscreen::layout(gpu, "map view", stages, &[fullscreen::UNIFORM])
    }

    /// What the host's pipelines draw into: there is no colour, and 1 is nearest.
    pub fn depth_stencil() -> wgpu::DepthStencilState {
        wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }
    }

    /// Takes points of the world to clip space, in double precision.
    pub fn clip_from_world(&self) -> DMat4 {
        self.light_view.clip_from_world
    }

    /// What the view may see, to leave out the rest.
    pub fn frustum(&self) -> Frustum {
        self.light_view.frustum()
    }
}

/// What a host draws, and where that is.
pub(super) struct Host {
    pub draws: Arc<dyn HostCasters>,
    pub bounds: Bounds,
}

impl Host {
    /// # Errors
    /// [`Error::Scene`] for a box that is not finite.
    pub fn new(bounds: Bounds, draws: Arc<dyn HostCasters>) -> Result<Self, Error> {
        if bounds.is_empty() || !bounds.min.is_finite() || !bounds.max.is_finite() {
            let what = "the box around casters that the host draws is empty or not finite; maps are fitted to it";
            return Err(Error::Scene(what.into()));
        }
        Ok(Self { draws, bounds })
    }
}

/// # Errors
/// [`Error::Unsupported`]: a technique can't do with casters that the host draws.
pub(crate) fn refuse(why: &str) -> Result<(), Error> {
    let what = format!("casters that the host draws, since {why}; give them as meshes, or choose another technique");
    Err(Error::Unsupported { technique: "this technique".into(), what })
}
