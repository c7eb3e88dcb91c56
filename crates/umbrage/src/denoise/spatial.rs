//! The filter over the pixels of one frame.

use crate::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, bind};
use crate::receivers::{Eye, Receivers};
use crate::shader::{Shader, shader_struct};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View, visibility::VisibilityTarget};

pub(super) const SHADER: Shader = Shader::new("spatial denoiser", include_str!("spatial.wgsl"))
    .with_layouts(&[Spatial::LAYOUT])
    .with_constants(&[("PAIRS", PAIRS as f64)]);

/// Name of the pass.
pub(super) const PASS: &str = "smooth penumbras";

const PAIRS: usize = 12;

/// The half of the 5×5 pixels around one that the other half lies across from.
const OFFSETS: [[i32; 2]; PAIRS] =
    [[1, 0], [0, 1], [1, 1], [-1, 1], [2, 0], [0, 2], [2, 1], [1, 2], [-1, 2], [-2, 1], [2, 2], [-2, 2]];

/// Bytes that a pixel reads: 25 of visibility and of depth.
pub(super) const BYTES: u64 = 25 * (2 + 4);

shader_struct! {
    /// See `spatial.wgsl`.
    pub(crate) struct Spatial {
        eye: Eye,
        size: [i32; 2],
        grain: f32,
        pad: f32,
        pairs: [[f32; 4]; PAIRS],
    }
}

/// The grainy visibility of a light, and the pass that smooths it.
pub(super) struct SpatialFilter {
    gpu: Gpu,
    /// Standard deviation of the mean of two pixels that see half of the light.
    grain: f32,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    data: Spatial,
    /// The pixels that the light can light: the first, and how many.
    pixels: [u32; 4],
    grainy: Option<(VisibilityTarget, wgpu::BindGroup)>,
    /// By whether receivers have normals, of which it reads none.
    pipelines: [Option<wgpu::RenderPipeline>; 2],
}

impl SpatialFilter {
    pub fn new(gpu: &Gpu, grain: f32) -> Self {
        let stages = wgpu::ShaderStages::FRAGMENT;
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            gpu: gpu.clone(),
            grain,
            module: SHADER.module(gpu),
            layout: fullscreen::layout(gpu, "spatial denoiser", stages, &[UNIFORM, fullscreen::texture(FLOATS)]),
            uniform: gpu.buffer("spatial denoiser", &[Spatial::default()], usage),
            data: Spatial::default(),
            pixels: [0; 4],
            grainy: None,
            pipelines: [None, None],
        }
    }

    pub fn prepare(&mut self, view: &View<'_>) -> Result<(), Error> {
        let size = view.receivers.size;
        if self.grainy.as_ref().is_none_or(|(target, _)| target.size != size) {
            let target = VisibilityTarget::new(&self.gpu, size.0, size.1)?;
            let resources = [self.uniform.as_entire_binding(), wgpu::BindingResource::TextureView(&target.view)];
            let bind_group = bind(&self.gpu, "spatial denoiser", &self.layout, &resources);
            self.grainy = Some((target, bind_group));
        }
        let pairs = OFFSETS.map(|[x, y]| [x as f32, y as f32, (x as f32).hypot(y as f32), 0.0]);
        let size = [size.0 as i32, size.1 as i32];
        self.data = Spatial { eye: Eye::new(view), size, grain: self.grain, pad: 0.0, pairs };
        self.pixels = view.lit_pixels();
        let known = &mut self.pipelines[usize::from(view.receivers.has_normals)];
        if known.is_none() {
            let receivers = Receivers::layout(&self.gpu);
            let constants = [("HAS_NORMALS", f64::from(u8::from(view.receivers.has_normals)))];
            let filter = Fullscreen {
                label: PASS,
                module: &self.module,
                entry: "smooth_penumbras",
                groups: &[&receivers, &self.layout],
                target: VisibilityTarget::FORMAT.into(),
                constants: &constants,
            };
            *known = Some(filter.pipeline(&self.gpu));
        }
        Ok(())
    }

    /// What to smooth is to be drawn here; there once a frame was prepared.
    pub fn grainy(&self) -> Option<&VisibilityTarget> {
        self.grainy.as_ref().map(|(target, _)| target)
    }

    pub fn record(&self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) {
        passes.upload(&self.uniform, bytemuck::bytes_of(&self.data));
        let pipeline = &self.pipelines[usize::from(view.receivers.has_normals)];
        let [x, y, width, height] = self.pixels;
        let mut pass = passes.render(PASS, &[visibility.overwrite()], None);
        if let (Some((_, bind_group)), Some(pipeline), true) = (&self.grainy, pipeline, width > 0 && height > 0) {
            pass.set_scissor_rect(x, y, width, height);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &view.receivers.bind_group, &[]);
            pass.set_bind_group(1, bind_group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    pub fn bytes(&self) -> u64 {
        self.uniform.size() + self.grainy().map_or(0, VisibilityTarget::bytes)
    }
}
