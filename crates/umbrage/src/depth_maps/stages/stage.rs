//! The contract of what a technique does between rendering its maps and looking them up.

use crate::casters::Casters;
use crate::depth_maps::frame::MapFrame;
use crate::inline::Binding;
use crate::{error::Error, gpu::Gpu, passes::Passes, technique::DebugView, view::View};

/// Passes over a light's maps or over its casters, and what the look-up binds besides the maps.
pub trait Stage: wgpu::WasmNotSend {
    /// True where it needs edges of casters: then there may be none that a host draws itself, see
    /// [`crate::HostCasters`].
    fn needs_edges(&self) -> bool {
        false
    }

    /// The layout of [`Stage::bind_group`], the shader's group 2.
    fn layout(&self) -> &wgpu::BindGroupLayout;

    /// Whether maps of another size need no new stage; a filter's width may go by it.
    fn takes_any_size(&self) -> bool {
        true
    }

    /// With the views and the texture of this frame, before anything is recorded.
    ///
    /// # Errors
    /// As [`crate::Technique::prepare_view`].
    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &MapFrame) -> Result<(), Error>;

    /// Passes after the maps are drawn, which are in [`MapFrame::texture`]. To draw casters into a
    /// map of its own a stage has a [`crate::depth_maps::CasterPass`], and to draw their edges an
    /// [`crate::depth_maps::EdgePass`]. Returns the number of draws.
    fn record(&mut self, _passes: &mut Passes<'_>, _frame: &MapFrame, _casters: &Casters) -> u32 {
        0
    }

    /// `None` only where there is nothing to look up.
    fn bind_group(&self) -> Option<&wgpu::BindGroup>;

    /// What is in the bind group, for [look-ups in shaders of hosts](crate::Inline), once there is
    /// something to look up. `None` where the stage has no use for them: the technique then refuses
    /// to lend its maps.
    fn lends(&self) -> Option<Vec<Binding>> {
        None
    }

    /// Bytes of GPU memory held.
    fn bytes(&self) -> u64;

    /// See [`crate::Inside::reads`].
    fn reads(&self, _pass: &str) -> Option<u64> {
        None
    }

    /// As [`crate::Inside::inspect`].
    fn inspect(&mut self, _view: Option<&str>) {}

    /// Pictures of what is inside.
    fn debug_views(&self) -> Vec<DebugView<'_>> {
        Vec::new()
    }
}
