//! Draws of the old ways, beside those of the one draw.

use super::super::draws::{Draw, HARD, SOFT, shares_format};
use super::super::shaders::shader;
use super::super::tables::Term;
use crate::fullscreen::{STORAGE, additive, layout};
use crate::gpu::Gpu;
use crate::shader::Shader;

/// Draws, as those of the one draw by the way in which shares are found.
const DRAWS: [Shader; 3] = [
    shader("wedges, old ways", concat!("// needs: draw, term_analytic\n", include_str!("old_ways.wgsl"))),
    shader("wedges by table, old ways", concat!("// needs: draw, term_table\n", include_str!("old_ways.wgsl"))),
    shader("wedges of a picture, old ways", concat!("// needs: draw, term_picture\n", include_str!("old_ways.wgsl"))),
];

/// Cuts bodies in two.
pub(super) const HALVES: Shader =
    shader("halves of wedges", include_str!("halves.wgsl")).with_constants(&[("Half", HALF_RECORD as f64)]);

/// What a loop or a caster that was drawn apart counted.
pub(super) const APART: Shader = shader("a loop's shares", include_str!("apart.wgsl"));

/// All of them.
pub(in super::super) const SHADERS: [Shader; 5] = [DRAWS[0], DRAWS[1], DRAWS[2], HALVES, APART];

/// The stencil mask of what is seen inside of bodies, and bodies within it.
pub(super) static MASK: Draw = Draw { fragment: "mark", shares: false, stencil: MARKS, target: nothing, ..OLD_SOFT };
pub(super) static MASKED_BODIES: Draw = Draw { stencil: IS_MARKED, ..SOFT };

/// Of one wedge what lies behind a half's near faces, which its far faces leave out (PX 4.1.3 the
/// other way round, so that the eye may be in it).
pub(super) static FRONT_MASK: Draw = Draw {
    fragment: "mark_all",
    shares: false,
    cull_mode: Some(wgpu::Face::Back),
    stencil: MARKS,
    target: nothing,
    ..HALF
};
pub(super) static MASKED_FRONT: Draw = Draw { stencil: IS_NOT_MARKED, ..HALF };
pub(super) static MASKED_BACK: Draw = Draw { fragment: "add_back_half", stencil: IS_NOT_MARKED, ..HALF };

/// The same without a mask.
pub(super) static FRONT: Draw = HALF;
pub(super) static BACK: Draw = Draw { fragment: "add_back_half", ..HALF };

/// Sides and bodies of one loop.
pub(super) static LOOP_SIDES: Draw =
    Draw { fragment: "add_side_of_loop", shader: draw_shader, target: loop_sums, ..HARD };
pub(super) static LOOP_BODIES: Draw = Draw { fragment: "add_wedge_of_loop", target: loop_sums, ..OLD_SOFT };

const OLD_SOFT: Draw = Draw { shader: draw_shader, ..SOFT };
const HALF: Draw = Draw { vertex: "half_body", fragment: "add_front_half", more: Some(halves_layout), ..OLD_SOFT };

fn draw_shader(term: Term) -> Shader {
    DRAWS[term as usize]
}

/// Bytes of a wedge's halves, see `halves.wgsl`.
pub(super) const HALF_RECORD: u64 = 48;

/// Group 3 of what draws halves.
pub(super) fn halves_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "halves of wedges", wgpu::ShaderStages::VERTEX_FRAGMENT, &[STORAGE])
}

fn nothing(gpu: &Gpu) -> wgpu::ColorTargetState {
    wgpu::ColorTargetState { write_mask: wgpu::ColorWrites::empty(), ..shares_format(gpu).into() }
}

fn loop_sums(gpu: &Gpu) -> wgpu::ColorTargetState {
    additive(loop_format(gpu))
}

/// Of the sums of a loop, see `old_ways.wgsl`.
pub(super) fn loop_format(gpu: &Gpu) -> wgpu::TextureFormat {
    let blends = gpu.has(wgpu::Features::FLOAT32_BLENDABLE);
    if blends { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba16Float }
}

const MARKS: wgpu::StencilState =
    stencil(wgpu::CompareFunction::Always, wgpu::StencilOperation::Keep, wgpu::StencilOperation::IncrementClamp);
const IS_MARKED: wgpu::StencilState =
    stencil(wgpu::CompareFunction::NotEqual, wgpu::StencilOperation::Keep, wgpu::StencilOperation::Keep);

/// Takes marks away where it meets them, for the next wedge.
const IS_NOT_MARKED: wgpu::StencilState =
    stencil(wgpu::CompareFunction::Equal, wgpu::StencilOperation::Zero, wgpu::StencilOperation::Keep);

/// The stencil is 0 where nothing was marked.
const fn stencil(
    compare: wgpu::CompareFunction,
    fail_op: wgpu::StencilOperation,
    pass_op: wgpu::StencilOperation,
) -> wgpu::StencilState {
    let face = wgpu::StencilFaceState { compare, fail_op, depth_fail_op: wgpu::StencilOperation::Keep, pass_op };
    wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff }
}
