//! What a technique does between rendering its maps and looking them up.

use super::DepthMaps;
use crate::{error::Error, gpu::Gpu, passes::Passes, technique::DebugView, view::View};

/// Passes over the maps, and what the look-up binds besides them.
pub(crate) trait Stage: Send {
    /// The layout of [`Stage::bind_group`], the shader's group 2.
    fn layout(&self) -> &wgpu::BindGroupLayout;

    /// Whether maps of another size need no new stage; a filter's width may go by it.
    fn takes_any_size(&self) -> bool {
        true
    }

    /// After the maps' own `prepare`, with the views of this frame.
    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &DepthMaps) -> Result<(), Error>;

    /// Passes after the maps are rendered; returns the number of draws.
    fn record(&mut self, _passes: &mut Passes<'_>, _maps: &DepthMaps) -> u32 {
        0
    }

    /// `None` only where there is nothing to look up.
    fn bind_group(&self) -> Option<&wgpu::BindGroup>;

    /// Bytes of GPU memory held.
    fn bytes(&self) -> u64;

    /// Pictures of what is inside.
    fn debug_views(&self) -> Vec<DebugView<'_>> {
        Vec::new()
    }
}
