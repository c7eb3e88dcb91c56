//! What shaders know of planes.

use super::MOST;
use super::chosen::Chosen;
use super::lit::LitPlane;
use super::screen::quad_of;
use crate::fullscreen::{UNIFORM, bind, layout, texture};
use crate::receivers::{Eye, Receivers};
use crate::shader::{Shared, shader_struct};
use crate::snapping::GROUND;
use crate::{gpu::Gpu, passes::Passes, view::View};
use umbrage_core::glam::{DMat4, DVec2, DVec3, DVec4};

/// What the host has to agree on with `plane_finder.wgsl`.
pub(super) const FINDER: Shared = Shared {
    module: "plane_finder",
    layouts: &[PlaneFinder::LAYOUT, FoundPlane::LAYOUT],
    constants: &[("MOST_PLANES", MOST as f64)],
};

/// The same for `plane_shadow.wgsl`.
pub(super) const SHADOW: Shared = Shared { module: "plane_shadow", layouts: &[PlaneShadow::LAYOUT], constants: &[] };

shader_struct! {
    /// Planes that pixels may belong to, see `plane_finder.wgsl`.
    pub(crate) struct PlaneFinder {
        eye: Eye,
        light: [f32; 4],
        slack: f32,
        rounding: f32,
        count: u32,
        pad: u32,
        planes: [FoundPlane; MOST],
        behind: [FoundPlane; MOST],
    }
}

shader_struct! {
    /// One of them.
    pub(crate) struct FoundPlane {
        across: [f32; 4],
        normal: [f32; 3],
        snapped: f32,
        corners: [[f32; 4]; 2],
    }
}

shader_struct! {
    /// Projects casters on a plane, see `plane_shadow.wgsl`.
    pub(crate) struct PlaneShadow {
        clip_from_eye: [[f32; 4]; 4],
        plane: [f32; 4],
        light: [f32; 3],
        inverse_height: f32,
        eye: [f32; 3],
        nearest: f32,
        least: f32,
        highest: f32,
        rounding: f32,
        snapped: f32,
        off_plane: [f32; 4],
        eye_w: [f32; 4],
    }
}

/// A rasteriser shifts surfaces by so many times as much as is measured at most. Where it finds
/// depth from corners behind the eye, that grows with how far these are: it is this much at least,
/// and no more is allowed for.
const SPREAD: f64 = 2.0;
const LONG_SPREAD: std::ops::RangeInclusive<f64> = 16.0..=256.0;

/// A step of single precision, as `position_rounding` in `receivers.wgsl` has it.
const ROUNDING: f32 = 1.2e-7;

/// Dynamic offsets are multiples of this on every device.
const STRIDE: u64 = 256;

const SHADOW_SIZE: Option<wgpu::BufferSize> = wgpu::BufferSize::new(size_of::<PlaneShadow>() as u64);

impl PlaneFinder {
    /// For planes of one light.
    fn new(view: &View<'_>, chosen: &Chosen) -> Self {
        let (planes, behind) = (chosen.planes(), chosen.behind());
        let center = view.light.shape.center();
        let light = center.truncate() - view.camera.eye * center.w;
        let eye = view.camera.eye - view.casters.origin();
        let of_eye = Eye::new(view);
        let mut finder = Self {
            rounding: rounding(view, &of_eye),
            eye: of_eye,
            light: light.extend(center.w).as_vec4().to_array(),
            slack: planes
                .iter()
                .chain(behind)
                .next()
                .map_or(0.0, |plane| plane.least.max(1e-6 * eye.abs().max_element()) as f32),
            count: planes.len() as u32,
            ..Self::default()
        };
        let rects = chosen.rects().iter().map(|rect| quad_of(*rect, view.receivers.size));
        let lit = finder.planes.iter_mut().zip(planes.iter().zip(rects));
        let unlit = finder.behind.iter_mut().zip(behind.iter().zip(chosen.quads().iter().copied()));
        lit.chain(unlit).for_each(|(data, (plane, quad))| *data = FoundPlane::new(view, plane, quad));
        finder
    }
}

/// What the depth buffer rounds, see `position_rounding` in `receivers.wgsl`.
fn rounding(view: &View<'_>, eye: &Eye) -> f32 {
    eye.rounding * if view.receivers.has_normals { ROUNDING } else { 8.0 * ROUNDING }
}

/// What rasterisers shift surfaces in a plane, as its equation in normalised device coordinates
/// counts.
fn snapped(view: &View<'_>, plane: &LitPlane, eye_from_ndc: &DMat4) -> f32 {
    let equation = plane.relative_to(view);
    let size = DVec2::new(view.receivers.size.0.into(), view.receivers.size.1.into());
    let shifted = [0, 1].map(|i| equation.truncate().dot(eye_from_ndc.col(i).truncate()).abs());
    let long = (plane.reach / GROUND).clamp(*LONG_SPREAD.start(), *LONG_SPREAD.end());
    let spread = if plane.reach > 0.0 { long } else { SPREAD };
    let snapped = DVec2::from(shifted) * 2.0 * spread * f64::from(view.receivers.snapping) / size;
    snapped.element_sum() as f32
}

impl FoundPlane {
    fn new(view: &View<'_>, plane: &LitPlane, quad: [DVec2; 4]) -> Self {
        let eye_from_ndc = view.clip_from_eye().inverse();
        let equation = plane.relative_to(view);
        let [a, b, c, d] = quad.map(|p| p.as_vec2());
        Self {
            across: (eye_from_ndc.transpose() * equation).as_vec4().to_array(),
            normal: equation.truncate().as_vec3().to_array(),
            snapped: snapped(view, plane, &eye_from_ndc),
            corners: [[a.x, a.y, b.x, b.y], [c.x, c.y, d.x, d.y]],
        }
    }
}

/// The finder's uniform.
pub(crate) struct Finder {
    pub layout: wgpu::BindGroupLayout,
    pub bind_group: wgpu::BindGroup,
    buffer: wgpu::Buffer,
}

impl Finder {
    pub fn new(gpu: &Gpu) -> Self {
        let layout = layout(gpu, "planes", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM]);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let buffer = gpu.buffer("planes", &[PlaneFinder::default()], usage);
        let bind_group = bind(gpu, "planes", &layout, &[buffer.as_entire_binding()]);
        Self { layout, bind_group, buffer }
    }

    /// For the planes of a light.
    pub fn upload(&self, passes: &mut Passes<'_>, view: &View<'_>, chosen: &Chosen) {
        let finder = PlaneFinder::new(view, chosen);
        passes.upload(&self.buffer, bytemuck::bytes_of(&finder));
    }
}

/// The uniforms of projections, one a plane in one buffer, and the depth of receivers.
pub(crate) struct Shadows {
    pub layout: wgpu::BindGroupLayout,
    bind_group: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    buffer: wgpu::Buffer,
    data: Vec<u8>,
}

impl Shadows {
    pub fn new(gpu: &Gpu) -> Self {
        let binding = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: SHADOW_SIZE,
        };
        let bindings = [binding, texture(wgpu::TextureSampleType::Depth)];
        let layout = layout(gpu, "shadow on a plane", wgpu::ShaderStages::VERTEX_FRAGMENT, &bindings);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("shadows on planes"),
            size: STRIDE * MOST as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { layout, bind_group: None, buffer, data: Vec::new() }
    }

    /// For these receivers.
    pub fn prepare(&mut self, gpu: &Gpu, receivers: &Receivers) {
        if self.bind_group.as_ref().is_none_or(|(depth, _)| *depth != receivers.depth) {
            let one = wgpu::BufferBinding { buffer: &self.buffer, offset: 0, size: SHADOW_SIZE };
            let depth = wgpu::BindingResource::TextureView(&receivers.depth);
            let resources = [wgpu::BindingResource::Buffer(one), depth];
            let bind_group = bind(gpu, "shadow on a plane", &self.layout, &resources);
            self.bind_group = Some((receivers.depth.clone(), bind_group));
        }
    }

    /// For each plane, with the matrix that takes points relative to the eye to clip space, and
    /// half the least w of what is seen there.
    pub fn upload(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        planes: impl Iterator<Item = (LitPlane, DMat4, f64)>,
    ) {
        self.data.clear();
        for (plane, clip_from_eye, nearest) in planes.take(MOST) {
            let data = PlaneShadow::new(view, &plane, &clip_from_eye, nearest);
            self.data.extend_from_slice(bytemuck::bytes_of(&data));
            self.data.resize(self.data.len().next_multiple_of(STRIDE as usize), 0);
        }
        passes.upload(&self.buffer, &self.data);
    }

    /// Binds those of a plane as group 0, once prepared.
    pub fn bind(&self, pass: &mut wgpu::RenderPass<'_>, plane: usize) {
        let bind_group = self.bind_group.as_ref().map(|(_, bind_group)| bind_group);
        pass.set_bind_group(0, bind_group, &[(plane as u64 * STRIDE) as u32]);
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}

impl PlaneShadow {
    fn new(view: &View<'_>, plane: &LitPlane, clip_from_eye: &DMat4, nearest: f64) -> Self {
        let eye = view.camera.eye - plane.origin;
        let eye_from_ndc = view.clip_from_eye().inverse();
        let equation = plane.relative_to(view);
        let by_pixel = |by_ndc: DVec4| (ndc_from_pixel(view).transpose() * by_ndc).as_vec4().to_array();
        Self {
            clip_from_eye: clip_from_eye.as_mat4().to_cols_array_2d(),
            plane: equation.as_vec4().to_array(),
            light: (plane.light - eye * plane.inverse_height).as_vec3().to_array(),
            inverse_height: plane.inverse_height as f32,
            eye: eye.as_vec3().to_array(),
            nearest: nearest as f32,
            least: plane.least.max(1e-6 * eye.abs().max_element()) as f32,
            highest: plane.highest.min(f32::MAX.into()) as f32,
            rounding: rounding(view, &Eye::new(view)),
            snapped: snapped(view, plane, &eye_from_ndc),
            off_plane: by_pixel(eye_from_ndc.transpose() * equation),
            eye_w: by_pixel(eye_from_ndc.row(3)),
        }
    }
}

/// From pixels and depth to normalised device coordinates.
fn ndc_from_pixel(view: &View<'_>) -> DMat4 {
    let scale = DVec3::new(2.0 / f64::from(view.receivers.size.0), -2.0 / f64::from(view.receivers.size.1), 1.0);
    DMat4::from_translation(DVec3::new(-1.0, 1.0, 0.0)) * DMat4::from_scale(scale)
}
