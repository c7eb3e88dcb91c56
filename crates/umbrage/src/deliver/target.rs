//! A host's target, or a part of it.

use crate::{
    error::Error,
    gpu::Gpu,
    passes::{Pass, Passes},
};

/// What pipelines and passes need to know of it.
pub(super) struct HostTarget {
    state: wgpu::ColorTargetState,
}

impl HostTarget {
    /// One that takes numbers from 0 to 1.
    pub fn new(gpu: &Gpu, state: wgpu::ColorTargetState) -> Result<Self, Error> {
        let format = state.format;
        let features = gpu.device.features();
        let takes_floats =
            matches!(format.sample_type(None, Some(features)), Some(wgpu::TextureSampleType::Float { .. }));
        let can_attach = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let known = format.guaranteed_format_features(features);
        let can_blend = known.flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE);
        if takes_floats && known.allowed_usages.contains(can_attach) {
            if can_blend || state.blend.is_none() {
                return Ok(Self { state });
            }
            return Err(Error::Lent(format!(
                "{format:?} can't be blended to on this device; leave out the blend state"
            )));
        }
        Err(Error::Lent(format!(
            "visibility can't be drawn to {format:?}; choose a format of floats or of numbers from 0 to 1, such as R8Unorm"
        )))
    }

    /// The target of pipelines.
    pub fn state(&self) -> wgpu::ColorTargetState {
        self.state.clone()
    }

    /// A pass that draws to a part of `view`, from `corner` on, and keeps what it leaves out.
    pub fn begin<'p>(
        &self,
        passes: &'p mut Passes<'_>,
        label: &str,
        view: &wgpu::TextureView,
        corner: (u32, u32),
        size: (u32, u32),
    ) -> Result<Pass<'p>, Error> {
        let texture = view.texture();
        let (width, height) = (texture.width(), texture.height());
        let end = |corner: u32, size: u32| u64::from(corner) + u64::from(size);
        let (right, bottom) = (end(corner.0, size.0), end(corner.1, size.1));
        if right > width.into() || bottom > height.into() {
            return Err(Error::Lent(format!(
                "visibility ends at {right}, {bottom} and its target at {width}, {height}; choose a part of it"
            )));
        }
        let is_all = (right, bottom) == (width.into(), height.into())
            && corner == (0, 0)
            && self.state.write_mask == wgpu::ColorWrites::ALL
            && self.state.blend.is_none();
        let load = if is_all { wgpu::LoadOp::Clear(wgpu::Color::WHITE) } else { wgpu::LoadOp::Load };
        let mut pass = passes.render(label, &[crate::fullscreen::attachment(view, load)], None);
        pass.set_viewport(corner.0 as f32, corner.1 as f32, size.0 as f32, size.1 as f32, 0.0, 1.0);
        Ok(pass)
    }
}
