//! What filters that follow the light's size bind besides the maps: taps for search and filter, and bounds of depth.

use super::bounds::BoundsPyramid;
use super::taps::{Shape, Taps};
use super::{DepthMaps, Stage};
use crate::fullscreen::{STORAGE, bind, layout};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};

/// Taps alone, or with bounds.
pub(crate) struct TapStage {
    taps: Taps,
    bounds: Option<BoundsPyramid>,
    /// The look-up reads the bounds, so that they have to be filled.
    reads_bounds: bool,
    /// Taps fill the light's shape, else always a disc.
    follows_light: bool,
    layout: wgpu::BindGroupLayout,
    bind_group: Option<(wgpu::Buffer, wgpu::BindGroup)>,
}

impl TapStage {
    /// For a filter of one width all around.
    pub(crate) fn disc(gpu: &Gpu, taps: Taps) -> Self {
        let layout = layout(gpu, "taps", wgpu::ShaderStages::FRAGMENT, &[STORAGE]);
        Self { taps, bounds: None, reads_bounds: false, follows_light: false, layout, bind_group: None }
    }

    /// For a filter that follows the light.
    pub(crate) fn light(gpu: &Gpu, taps: Taps, reads_bounds: bool) -> Self {
        let layout = layout(gpu, "taps and bounds", wgpu::ShaderStages::FRAGMENT, &[STORAGE, BoundsPyramid::BINDING]);
        let bounds = Some(BoundsPyramid::new(gpu));
        Self { taps, bounds, reads_bounds, follows_light: true, layout, bind_group: None }
    }
}

impl Stage for TapStage {
    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &DepthMaps) -> Result<(), Error> {
        let Some(texture) = maps.result() else { return Ok(()) };
        let shape = if self.follows_light { Shape::of(&view.light.shape) } else { Shape::DISC };
        let is_new = self.bounds.as_mut().is_some_and(|b| b.prepare(gpu, texture));
        let buffer = self.taps.buffer(gpu, shape, view.textures);
        if is_new || self.bind_group.as_ref().is_none_or(|(b, _)| b != buffer) {
            let mut resources = vec![buffer.as_entire_binding()];
            let pyramid = self.bounds.as_ref().and_then(BoundsPyramid::buffer);
            resources.extend(pyramid.map(wgpu::Buffer::as_entire_binding));
            let bind_group = bind(gpu, "taps", &self.layout, &resources);
            self.bind_group = Some((buffer.clone(), bind_group));
        }
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, maps: &DepthMaps) -> u32 {
        if let Some(bounds) = self.bounds.as_mut().filter(|_| self.reads_bounds) {
            bounds.record(passes, maps);
        }
        0
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bind_group.as_ref().map(|(_, group)| group)
    }

    fn bytes(&self) -> u64 {
        self.taps.bytes() + self.bounds.as_ref().map_or(0, BoundsPyramid::bytes)
    }
}
