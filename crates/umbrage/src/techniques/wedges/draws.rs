//! What is drawn, and how: shaders, faces, stencil and target of each draw.

use super::pipelines::Pipelines;
use crate::fullscreen::additive;

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Draw {
    /// Sides of hard shadow volumes.
    Sides,
    /// Surfaces of casters, where the eye may see through them.
    Caps,
    /// Bodies of wedges.
    Bodies,
    /// Of wedges that lie close together the bodies around four of them, and those of all others.
    Bundles,
    Singles,
    /// The stencil mask of what is seen inside of bodies, and bodies within it.
    Mask,
    MaskedBodies,
    /// Of one wedge what lies behind a half's near faces, which its far faces leave out (PX 4.1.3 the other way round, so that the
    /// eye may be in it).
    FrontMask,
    MaskedFront,
    MaskedBack,
    /// The same without a mask.
    Front,
    Back,
    /// Sides and bodies of one loop, and what it comes to.
    LoopSides,
    LoopBodies,
    Loop,
    /// The largest share of casters.
    Most,
}

/// State of a draw.
pub(super) struct How {
    pub vertex: &'static str,
    pub fragment: &'static str,
    pub is_body: bool,
    /// The shader goes by the light's face.
    pub shares: bool,
    pub cull_mode: Option<wgpu::Face>,
    pub stencil: wgpu::StencilState,
    target: Target,
}

enum Target {
    Sum,
    Loop,
    Most,
    Nothing,
}

impl Draw {
    /// Reads the sums of a loop or a caster.
    pub fn is_apart(self) -> bool {
        matches!(self, Self::Loop | Self::Most)
    }

    /// How it is drawn.
    pub fn how(self) -> How {
        let side = |fragment, target| How::new("side", fragment, target);
        let body = |vertex, fragment, target| How {
            is_body: true,
            shares: true,
            cull_mode: Some(wgpu::Face::Front),
            ..How::new(vertex, fragment, target)
        };
        let half = |fragment| body("half_body", fragment, Target::Sum);
        match self {
            Self::Sides => side("add_side", Target::Sum),
            Self::Caps => How::new("cap", "add_cap", Target::Sum),
            Self::Bodies => body("body", "add_wedge", Target::Sum),
            Self::Bundles => body("bundle_body", "add_bundle", Target::Sum),
            Self::Singles => body("single_body", "add_wedge", Target::Sum),
            Self::Mask => How { stencil: marks(), shares: false, ..body("body", "mark", Target::Nothing) },
            Self::MaskedBodies => How { stencil: is_marked(), ..body("body", "add_wedge", Target::Sum) },
            Self::FrontMask => How {
                stencil: marks(),
                shares: false,
                cull_mode: Some(wgpu::Face::Back),
                ..body("half_body", "mark_all", Target::Nothing)
            },
            Self::MaskedFront => How { stencil: is_not_marked(), ..half("add_front_half") },
            Self::MaskedBack => How { stencil: is_not_marked(), ..half("add_back_half") },
            Self::Front => half("add_front_half"),
            Self::Back => half("add_back_half"),
            Self::LoopSides => side("add_side_of_loop", Target::Loop),
            Self::LoopBodies => body("body", "add_wedge_of_loop", Target::Loop),
            Self::Loop => How::new("screen", "add_loop", Target::Sum),
            Self::Most => How::new("screen", "most_of_casters", Target::Most),
        }
    }
}

impl How {
    fn new(vertex: &'static str, fragment: &'static str, target: Target) -> Self {
        let (is_body, shares, cull_mode, stencil) = (false, false, None, Default::default());
        Self { vertex, fragment, is_body, shares, cull_mode, stencil, target }
    }

    /// What it is drawn into.
    pub fn target(&self, pipelines: &Pipelines) -> wgpu::ColorTargetState {
        match self.target {
            Target::Sum => additive(pipelines.format),
            Target::Loop => additive(pipelines.loop_format),
            Target::Most => most(pipelines.format),
            Target::Nothing => {
                wgpu::ColorTargetState { write_mask: wgpu::ColorWrites::empty(), ..pipelines.format.into() }
            }
        }
    }
}

fn most(format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
    let max = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Max,
    };
    wgpu::ColorTargetState { blend: Some(wgpu::BlendState { color: max, alpha: max }), ..format.into() }
}

/// The stencil is 0 where nothing was marked.
fn stencil(
    compare: wgpu::CompareFunction,
    fail: wgpu::StencilOperation,
    pass: wgpu::StencilOperation,
) -> wgpu::StencilState {
    let face =
        wgpu::StencilFaceState { compare, fail_op: fail, depth_fail_op: wgpu::StencilOperation::Keep, pass_op: pass };
    wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff }
}

fn marks() -> wgpu::StencilState {
    use wgpu::StencilOperation as Operation;
    stencil(wgpu::CompareFunction::Always, Operation::Keep, Operation::IncrementClamp)
}

fn is_marked() -> wgpu::StencilState {
    use wgpu::StencilOperation as Operation;
    stencil(wgpu::CompareFunction::NotEqual, Operation::Keep, Operation::Keep)
}

/// Takes marks away where it meets them, for the next wedge.
fn is_not_marked() -> wgpu::StencilState {
    use wgpu::StencilOperation as Operation;
    stencil(wgpu::CompareFunction::Equal, Operation::Zero, Operation::Keep)
}
