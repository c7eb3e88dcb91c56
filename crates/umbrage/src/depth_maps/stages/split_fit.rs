//! Splits fitted to the depths that are visible, by compute: nothing is read back, and the CPU
//! never knows.
//!
//! Sources: Lauritzen, Salvi and Lefohn, "Sample Distribution Shadow Maps", 2011 (the range; parts
//! are cropped by their corners).

use crate::compute::compute_pipeline;
use crate::depth_maps::frame::MapFrame;
use crate::depth_maps::layers::MOST_LAYERS;
use crate::depth_maps::lookup::{LookupInput, MapLayer};
use crate::depth_maps::texels::{matrix, texels_from_clip, texels_in_plane, view_distance};
use crate::fullscreen::{STORAGE_WRITE, UNIFORM, bind, layout};
use crate::shader::{Shader, shader_struct};
use crate::{
    gpu::Gpu,
    passes::Passes,
    receivers::{Eye, Receivers},
    view::View,
};
use umbrage_core::glam::{DMat4, DVec4};
use umbrage_core::light_view::{Cascades, LightView};

/// Finds the range of visible depths and crops views to parts of it.
pub(crate) const SPLIT_FIT_SHADER: Shader = Shader::new("split fit", include_str!("split_fit.wgsl"))
    .with_layouts(&[SplitFit::LAYOUT])
    .with_constants(&[("PIXELS", PIXELS as f64)]);

shader_struct! {
    /// See `split_fit.wgsl`.
    pub(crate) struct SplitFit {
        eye: Eye,
        base: MapLayer,
        clip_from_world: [[f32; 4]; 4],
        corners: [[f32; 4]; 4],
        ways: [[f32; 4]; 4],
        view_distance: [f32; 4],
        size: f32,
        border: f32,
        margin: f32,
        count: u32,
        lambda: f32,
        overlap: f32,
        distance: f32,
        pad: f32,
    }
}

/// Pixels across and down a workgroup of `find_range`.
const PIXELS: u32 = 32;

/// Pipelines and buffers.
pub(in crate::depth_maps) struct SplitFitter {
    find_range: wgpu::ComputePipeline,
    /// For views that are parallel, and for those from a point.
    fit_splits: [wgpu::ComputePipeline; 2],
    perspective: bool,
    targets: [Target; 2],
    range: wgpu::Buffer,
    /// A matrix for each layer, from the casters' space to clip space.
    matrices: wgpu::Buffer,
}

/// Uniforms of a look-up that are patched: those of the full-screen pass, and those of shaders of
/// hosts, whose receivers are in another space.
struct Target {
    data: SplitFit,
    uniform: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl SplitFitter {
    /// `input` has the uniforms of the look-up, which it patches.
    pub fn new(gpu: &Gpu, input: &mut LookupInput) -> Self {
        let bindings = [UNIFORM, STORAGE_WRITE, STORAGE_WRITE, STORAGE_WRITE];
        let layout = layout(gpu, "split fit", wgpu::ShaderStages::COMPUTE, &bindings);
        let module = SPLIT_FIT_SHADER.module(gpu);
        let receivers = Receivers::layout(gpu);
        let groups = [Some(&receivers), None, Some(&layout)];
        let pipeline =
            |entry, perspective: f64| compute_pipeline(gpu, &module, entry, &groups, &[("PERSPECTIVE", perspective)]);
        use wgpu::BufferUsages as Usage;
        let range = gpu.buffer("visible range", &[0u32; 2], Usage::STORAGE | Usage::COPY_DST);
        let matrices = gpu.buffer("split views", &[[0f32; 16]; MOST_LAYERS], Usage::STORAGE | Usage::COPY_SRC);
        let target = |lookup: &wgpu::Buffer| {
            let uniform = gpu.buffer("split fit", &[SplitFit::default()], Usage::UNIFORM | Usage::COPY_DST);
            let buffers = [&uniform, &range, lookup, &matrices].map(wgpu::Buffer::as_entire_binding);
            let bind_group = bind(gpu, "split fit", &layout, &buffers);
            Target { data: SplitFit::default(), uniform, bind_group }
        };
        let targets = [target(input.uniforms()), target(input.keep_lent())];
        Self {
            find_range: pipeline("find_range", 0.0),
            fit_splits: [0.0, 1.0].map(|perspective| pipeline("fit_splits", perspective)),
            perspective: false,
            targets,
            range,
            matrices,
        }
    }

    /// For the views of this frame, which are all the same.
    pub fn prepare(&mut self, view: &View<'_>, maps: &MapFrame, cascades: &Cascades) {
        let Some(light_view) = maps.views.first() else { return };
        let eye_from_ndc = view.clip_from_eye().inverse();
        let [corners, ways] = corners(view, light_view, &eye_from_ndc);
        self.perspective = light_view.is_perspective();
        let world_from_eye = DMat4::from_translation(view.camera.eye);
        let base = |world_from_place: &DMat4| MapLayer::of(light_view, world_from_place, &maps.scene.casters);
        let in_ndc = SplitFit {
            eye: Eye::new(view),
            base: base(&(world_from_eye * eye_from_ndc)),
            clip_from_world: matrix(&(light_view.clip_from_world * DMat4::from_translation(view.casters.origin()))),
            corners,
            ways,
            view_distance: view_distance(view, &eye_from_ndc),
            size: maps.size as f32,
            border: maps.border_texels as f32,
            margin: (maps.soft_texels + maps.softness_m / texels_in_plane(light_view)[1].min_element()) as f32,
            count: cascades.count as u32,
            lambda: cascades.lambda as f32,
            overlap: cascades.overlap as f32,
            distance: if cascades.distance > 0.0 { cascades.distance as f32 } else { f32::MAX },
            pad: 0.0,
        };
        self.targets[0].data = in_ndc;
        self.targets[1].data = SplitFit { base: base(&world_from_eye), ..in_ndc };
    }

    /// Patches the look-up's uniforms, after these were uploaded.
    pub fn record(&self, passes: &mut Passes<'_>, receivers: &Receivers) {
        self.targets.iter().for_each(|t| passes.upload(&t.uniform, bytemuck::bytes_of(&t.data)));
        passes.upload(&self.range, bytemuck::bytes_of(&[u32::MAX, 0]));
        let mut pass = passes.compute("split fit");
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(2, &self.targets[0].bind_group, &[]);
        pass.set_pipeline(&self.find_range);
        pass.dispatch_workgroups(receivers.size.0.div_ceil(PIXELS), receivers.size.1.div_ceil(PIXELS), 1);
        pass.set_pipeline(&self.fit_splits[usize::from(self.perspective)]);
        for target in &self.targets {
            pass.set_bind_group(2, &target.bind_group, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
    }

    /// A matrix for each layer, from the casters' space to clip space.
    pub fn matrices(&self) -> &wgpu::Buffer {
        &self.matrices
    }

    pub fn bytes(&self) -> u64 {
        self.targets.iter().map(|t| t.uniform.size()).sum::<u64>() + self.range.size() + self.matrices.size()
    }
}

/// Homogeneous texels of the four corners of the camera's view at distance 0 along it, and their
/// change per metre.
fn corners(view: &View<'_>, light_view: &LightView, eye_from_ndc: &DMat4) -> [[[f32; 4]; 4]; 2] {
    let map_from_eye =
        texels_from_clip(light_view.size) * light_view.clip_from_world * DMat4::from_translation(view.camera.eye);
    let forward = view.camera.forward();
    let homogeneous = |p: DVec4| {
        let h = map_from_eye * p;
        DVec4::new(h.x, h.y, h.w, 0.0).as_vec4().to_array()
    };
    let ends = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| {
        // Two points on the line through the corner; any two depths will do.
        let [a, b] = [0.25, 0.75].map(|depth| {
            let p = eye_from_ndc * DVec4::new(x, y, depth, 1.0);
            p.truncate() / p.w
        });
        let way = (b - a) / forward.dot(b - a);
        let at_zero = a - way * forward.dot(a);
        [homogeneous(at_zero.extend(1.0)), homogeneous(way.extend(0.0))]
    });
    [ends.map(|e| e[0]), ends.map(|e| e[1])]
}
