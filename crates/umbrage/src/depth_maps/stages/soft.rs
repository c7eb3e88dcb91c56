//! What filters that follow the light's size bind besides the maps: taps for search and filter, and
//! bounds of depth.

use super::bounds::BoundsPyramid;
use super::stage::Stage;
use super::taps::{Shape, Taps};
use crate::casters::Casters;
use crate::depth_maps::frame::MapFrame;
use crate::fullscreen::{STORAGE, bind, layout};
use crate::inline::{Binding, Resource};
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
    bind_group: Option<wgpu::BindGroup>,
}

impl TapStage {
    /// What a filter that follows the light binds: taps and bounds.
    pub(crate) const LIGHT_BINDINGS: [wgpu::BindingType; 2] = [STORAGE, BoundsPyramid::BINDING];

    /// Bytes that a pixel reads of the bounds at most: three by three cells, in two rounds.
    pub(crate) const BOUNDS_BYTES: u64 = 2 * 9 * 4;

    /// For a filter of one width all around.
    pub(crate) fn disc(gpu: &Gpu, taps: Taps) -> Self {
        let layout = layout(gpu, "taps", wgpu::ShaderStages::FRAGMENT, &[STORAGE]);
        Self { taps, bounds: None, reads_bounds: false, follows_light: false, layout, bind_group: None }
    }

    /// For a filter that follows the light.
    pub(crate) fn light(gpu: &Gpu, taps: Taps, reads_bounds: bool) -> Self {
        let layout = layout(gpu, "taps and bounds", wgpu::ShaderStages::FRAGMENT, &Self::LIGHT_BINDINGS);
        let bounds = Some(BoundsPyramid::new(gpu));
        Self { taps, bounds, reads_bounds, follows_light: true, layout, bind_group: None }
    }

    /// Makes or keeps the tables for this frame; true where one is new.
    pub(crate) fn prepare_tables(&mut self, gpu: &Gpu, view: &View<'_>, maps: &MapFrame) -> bool {
        let Some(texture) = &maps.texture else { return false };
        let shape = if self.follows_light { Shape::of(&view.light.shape) } else { Shape::DISC };
        let has_new_bounds = self.bounds.as_mut().is_some_and(|b| b.prepare(gpu, texture));
        self.taps.prepare(gpu, shape, view.textures) || has_new_bounds
    }

    /// The tables for shaders of hosts.
    pub(crate) fn lends(&self) -> Vec<Binding> {
        let bounds = self.bounds.as_ref().and_then(BoundsPyramid::buffer);
        let buffers = self.taps.buffer().into_iter().chain(bounds);
        let lent = (0..).zip(Self::LIGHT_BINDINGS).zip(buffers);
        lent.map(|((i, ty), buffer)| Binding::of_stage(i, ty, Resource::Buffer(buffer.clone()))).collect()
    }

    /// The tables, in the order of the layout.
    pub(crate) fn resources(&self) -> Vec<wgpu::BindingResource<'_>> {
        let bounds = self.bounds.as_ref().and_then(BoundsPyramid::buffer);
        self.taps.buffer().into_iter().chain(bounds).map(wgpu::Buffer::as_entire_binding).collect()
    }
}

impl Stage for TapStage {
    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &MapFrame) -> Result<(), Error> {
        if self.prepare_tables(gpu, view, maps) {
            self.bind_group = Some(bind(gpu, "taps", &self.layout, &self.resources()));
        }
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, maps: &MapFrame, _: &Casters) -> u32 {
        if let Some(bounds) = self.bounds.as_mut().filter(|_| self.reads_bounds) {
            bounds.record(passes, maps);
        }
        0
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bind_group.as_ref()
    }

    fn lends(&self) -> Option<Vec<Binding>> {
        Some(TapStage::lends(self))
    }

    fn bytes(&self) -> u64 {
        self.taps.bytes() + self.bounds.as_ref().map_or(0, BoundsPyramid::bytes)
    }
}
