//! Skins from the edges of casters.

use super::channel::{NONE, least};
use super::uniform::VIEWS;
use crate::depth_maps::{EdgeDraw, EdgePass};
use crate::gpu::Gpu;
use crate::shader::HostConstant;

/// What `edge_skins.wgsl` and its modules call them.
pub(super) const CONSTANTS: &[HostConstant] = &[("VIEWS", VIEWS as f64), ("NONE", NONE)];

/// What draws the edges that one point sees into the channel of another.
pub(super) fn edge_skins(gpu: &Gpu, into: &wgpu::BindGroupLayout, threshold: f64) -> EdgePass {
    let draw = EdgeDraw {
        vertex: "edge_skin",
        fragment: Some("exact_share"),
        targets: vec![Some(least())],
        depth_stencil: None,
    };
    EdgePass::new(gpu, &super::EDGE_SKINS, Some(into), &[("THRESHOLD", threshold)], vec![draw])
}
