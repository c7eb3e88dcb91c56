//! Skins from the edges of casters.

use super::channel::{NONE, least};
use super::pictures;
use super::uniform::VIEWS;
use crate::depth_maps::{EdgeDraw, EdgePass};
use crate::fullscreen::additive;
use crate::gpu::Gpu;
use crate::shader::HostConstant;

/// What `edge_skins.wgsl` and its modules call them.
pub(super) const CONSTANTS: &[HostConstant] = &[("VIEWS", VIEWS as f64), ("NONE", NONE)];

/// What draws the edges that one point sees into the channel of another, and as its second way into
/// a picture of that.
pub(super) fn edge_skins(gpu: &Gpu, into: &wgpu::BindGroupLayout, threshold: f64) -> EdgePass {
    let draw = |fragment, target| EdgeDraw {
        vertex: "edge_skin",
        fragment: Some(fragment),
        targets: vec![Some(target)],
        depth_stencil: None,
    };
    let draws = vec![draw("exact_share", least()), draw("shown_skin", additive(pictures::FORMAT))];
    EdgePass::new(gpu, &super::EDGE_SKINS, Some(into), &[("THRESHOLD", threshold)], draws)
}
