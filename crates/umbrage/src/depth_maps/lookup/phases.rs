//! A look-up's draws. Some decide what is quick everywhere, and the rest only where that left it
//! open: the stencil remembers where, so that whole blocks of pixels are skipped without a branch.

use crate::{fullscreen::target_texture, gpu::Gpu};

/// Stencil of the pixels that are still open.
const OPEN: u32 = 1;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Stencil8;

/// One draw of a look-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// All at once.
    Whole,
    /// Writes what it can decide, discards the rest.
    Quick,
    /// Draws what the quick one left open.
    Rest,
}

impl Phase {
    /// The fragment shader.
    pub fn entry(self) -> &'static str {
        match self {
            Self::Quick => "quick_visibility",
            Self::Whole | Self::Rest => "visibility",
        }
    }

    /// Stencil reference.
    pub fn reference(self) -> u32 {
        match self {
            Self::Rest => OPEN,
            Self::Whole | Self::Quick => OPEN - 1,
        }
    }

    /// In a pass with [`OpenPixels`], which all but [`Phase::Whole`] need.
    pub fn state(self) -> Option<wgpu::DepthStencilState> {
        let (compare, pass_op) = match self {
            Self::Quick => (wgpu::CompareFunction::Always, wgpu::StencilOperation::Replace),
            Self::Rest => (wgpu::CompareFunction::Equal, wgpu::StencilOperation::Keep),
            Self::Whole => return None,
        };
        let face = wgpu::StencilFaceState { compare, pass_op, ..wgpu::StencilFaceState::IGNORE };
        Some(wgpu::DepthStencilState {
            format: FORMAT,
            depth_write_enabled: None,
            depth_compare: None,
            stencil: wgpu::StencilState { front: face, back: face, read_mask: !0, write_mask: !0 },
            bias: Default::default(),
        })
    }
}

/// The stencil, as large as the receivers.
#[derive(Default)]
pub(super) struct OpenPixels {
    made: Option<((u32, u32), wgpu::TextureView)>,
}

impl OpenPixels {
    pub fn prepare(&mut self, gpu: &Gpu, size: (u32, u32)) {
        if self.made.as_ref().is_none_or(|(s, _)| *s != size) {
            let texture = target_texture(gpu, "open pixels", size, 1, FORMAT);
            self.made = Some((size, texture.create_view(&Default::default())));
        }
    }

    /// All open at first; nobody reads it afterwards.
    pub fn attachment(&self) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
        self.made.as_ref().map(|(_, view)| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: None,
            stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(OPEN), store: wgpu::StoreOp::Discard }),
        })
    }

    pub fn bytes(&self) -> u64 {
        self.made.as_ref().map_or(0, |((width, height), _)| u64::from(*width) * u64::from(*height))
    }
}
