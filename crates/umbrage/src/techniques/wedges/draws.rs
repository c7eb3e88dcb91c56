//! What is drawn, and how: shaders, faces, stencil and target of each draw.

use super::tables::Term;
use crate::fullscreen::additive;
use crate::gpu::Gpu;
use crate::shader::Shader;

/// A kind of draw. Each is one of its own, whatever others look like.
pub(super) struct Draw {
    pub vertex: &'static str,
    pub fragment: &'static str,
    /// Where both are, by how shares are found.
    pub shader: fn(Term) -> Shader,
    /// Draws bodies of wedges, not sides of hard shadows.
    pub is_body: bool,
    /// The fragment shader goes by the light's face.
    pub shares: bool,
    pub cull_mode: Option<wgpu::Face>,
    pub stencil: wgpu::StencilState,
    /// What it is drawn into.
    pub target: fn(&Gpu) -> wgpu::ColorTargetState,
    /// What group 3 is, where it has one.
    pub more: Option<fn(&Gpu) -> wgpu::BindGroupLayout>,
}

impl PartialEq for Draw {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

/// Sides of hard shadow volumes.
pub(super) static SIDES: Draw = HARD;

/// Surfaces of casters, where the eye may see through them.
pub(super) static CAPS: Draw = Draw { vertex: "cap", fragment: "add_cap", ..HARD };

/// Bodies of all wedges.
pub(super) static BODIES: Draw = SOFT;

/// Of wedges that lie close together the bodies around four of them.
pub(super) static BUNDLES: Draw = Draw { vertex: "bundle_body", fragment: "add_bundle", ..SOFT };

/// The bodies of all others.
pub(super) static SINGLES: Draw = Draw { vertex: "single_body", ..SOFT };

/// What draws of hard shadows start from.
pub(super) const HARD: Draw = Draw {
    vertex: "side",
    fragment: "add_side",
    shader: Term::draw_shader,
    is_body: false,
    shares: false,
    cull_mode: None,
    stencil: NO_STENCIL,
    target: |gpu| additive(shares_format(gpu)),
    more: None,
};

/// What draws of wedges start from.
pub(super) const SOFT: Draw = Draw {
    vertex: "body",
    fragment: "add_wedge",
    is_body: true,
    shares: true,
    cull_mode: Some(wgpu::Face::Front),
    ..HARD
};

const NO_STENCIL: wgpu::StencilState = wgpu::StencilState {
    front: wgpu::StencilFaceState::IGNORE,
    back: wgpu::StencilFaceState::IGNORE,
    read_mask: 0,
    write_mask: 0,
};

/// Of covered shares: sums of many small terms.
pub(super) fn shares_format(gpu: &Gpu) -> wgpu::TextureFormat {
    let blends = gpu.has(wgpu::Features::FLOAT32_BLENDABLE);
    if blends { wgpu::TextureFormat::Rg32Float } else { wgpu::TextureFormat::Rg16Float }
}
