//! The mean over frames.

use super::movers::{MOVERS, MovedCasters};
use crate::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, attachment, bind, target_texture};
use crate::receivers::{Eye, Receivers};
use crate::shader::{Shader, shader_struct};
use crate::view::clip_from_eye;
use crate::{
    error::Error,
    gpu::Gpu,
    passes::{Kept, Passes},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::glam::{DMat4, DVec3};
use umbrage_core::{CameraView, LightShape};

pub(super) const SHADER: Shader = Shader::new("history", include_str!("history.wgsl"))
    .with_layouts(&[History::LAYOUT])
    .with_constants(&[("MOVERS", MOVERS as f64)]);

/// Name of the pass.
pub(crate) const PASS: &str = "mean over frames";

/// Bytes that a pixel reads: its visibility, depth, normal and four texels of the last frame.
pub(crate) const BYTES: u64 = 2 + 4 + 4 + 4 * 4;

/// Frames that a mean is of, at most: the 6 bits that count them.
pub const MOST_FRAMES: u32 = 64;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

shader_struct! {
    /// See `history.wgsl`.
    pub(crate) struct History {
        eye: Eye,
        last_clip_from_eye: [[f32; 4]; 4],
        last_eye: [f32; 4],
        light: [f32; 4],
        size: [f32; 2],
        frames: f32,
        is_known: u32,
        is_parallel: u32,
        movers: u32,
        pad: [f32; 2],
        spheres: [[f32; 4]; MOVERS],
    }
}

/// The mean of a light's visibility over frames, 8 bytes a pixel: see the module's page. A point
/// keeps it for as long as the camera shows it and neither the light nor a caster that may hide the
/// light from it, nor the point's own surface, has moved; else it starts anew, so that nothing of
/// an old shadow is left in the next frame.
pub(crate) struct MeanOverFrames {
    gpu: Gpu,
    frames: u32,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    data: History,
    pixels: [u32; 4],
    targets: Option<Targets>,
    /// By whether receivers have normals.
    pipelines: [Option<wgpu::RenderPipeline>; 2],
    last: Option<(CameraView, LightShape)>,
    movers: MovedCasters,
    /// What was prepared last was recorded, too.
    is_recorded: bool,
    kept: Kept,
}

/// What is new, and the means of this frame and the last, which change places.
struct Targets {
    fresh: VisibilityTarget,
    kept: [wgpu::TextureView; 2],
    /// That reads the one while the other is written.
    reads: [wgpu::BindGroup; 2],
    /// Number of the mean that is written.
    current: usize,
}

impl MeanOverFrames {
    /// Over up to so many frames, 64 at most: later ones weigh as the last of as many.
    pub fn new(gpu: &Gpu, frames: u32) -> Self {
        let uint = wgpu::TextureSampleType::Uint;
        let bindings = [UNIFORM, fullscreen::texture(FLOATS), fullscreen::texture(uint)];
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            gpu: gpu.clone(),
            frames: frames.clamp(1, MOST_FRAMES),
            module: SHADER.module(gpu),
            layout: fullscreen::layout(gpu, "history", wgpu::ShaderStages::FRAGMENT, &bindings),
            uniform: gpu.buffer("history", &[History::default()], usage),
            data: History::default(),
            pixels: [0; 4],
            targets: None,
            pipelines: [None, None],
            last: None,
            movers: MovedCasters::default(),
            is_recorded: false,
            kept: Kept::default(),
        }
    }

    /// For the view of the next frame.
    ///
    /// # Errors
    /// [`Error::Size`] for a picture beyond the limits.
    pub fn prepare(&mut self, view: &View<'_>) -> Result<(), Error> {
        let size = view.receivers.size;
        if self.targets.as_ref().is_none_or(|targets| targets.fresh.size != size) {
            self.targets = Some(self.make(size)?);
            self.forget();
        }
        if !self.is_recorded || !self.kept.holds() {
            self.forget();
        }
        self.is_recorded = false;
        let spheres = self.movers.update(view.casters);
        let now = (view.camera, view.light.shape.clone());
        let last = self.last.replace(now).filter(|(_, light)| *light == view.light.shape);
        let known = last.zip(spheres);
        let is_known = known.is_some();
        let (last, spheres) = known.map_or((view.camera, Vec::new()), |((camera, _), spheres)| (camera, spheres));
        self.data = History { is_known: u32::from(is_known), ..self.data_of(view, &last, &spheres) };
        self.pixels = view.lit_pixels();
        self.pipeline_for(view.receivers.has_normals);
        Ok(())
    }

    fn data_of(&self, view: &View<'_>, last: &CameraView, spheres: &[(DVec3, f64)]) -> History {
        let (eye, size) = (view.camera.eye, view.receivers.size);
        let from_last_eye = DMat4::from_translation(eye - last.eye);
        let pixel = view.camera.clip_from_view.inverse() * DVec3::new(0.0, 2.0 / f64::from(size.1), 0.5).extend(1.0);
        let pixel = pixel.truncate() / pixel.w;
        let center = view.light.shape.center();
        let is_parallel = center.w == 0.0;
        let light = if is_parallel { center.truncate().normalize_or(DVec3::Y) } else { center.truncate() - eye };
        let radius = view.light.shape.radius();
        // Parallel light has the sine of its half angle there, and the shader needs the tangent.
        let extent = if is_parallel { radius.asin().tan() } else { radius };
        let mut data = History {
            eye: Eye::new(view),
            last_clip_from_eye: (clip_from_eye(last) * from_last_eye).as_mat4().to_cols_array_2d(),
            last_eye: (last.eye - eye).as_vec3().extend((pixel.y / pixel.z.abs().max(1e-30)) as f32).to_array(),
            light: light.as_vec3().extend(extent as f32).to_array(),
            size: [size.0 as f32, size.1 as f32],
            frames: self.frames as f32,
            is_parallel: u32::from(is_parallel),
            movers: spheres.len() as u32,
            ..History::default()
        };
        for (place, (middle, radius)) in data.spheres.iter_mut().zip(spheres) {
            *place = (*middle - eye).as_vec3().extend(*radius as f32).to_array();
        }
        data
    }

    /// What is to enter the mean is to be drawn here; there once a frame was prepared.
    pub fn fresh(&self) -> Option<&VisibilityTarget> {
        self.targets.as_ref().map(|targets| &targets.fresh)
    }

    /// Leaves the mean in `visibility`.
    pub fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) {
        let pipeline = &self.pipelines[usize::from(view.receivers.has_normals)];
        let (Some(targets), Some(pipeline)) = (&mut self.targets, pipeline) else { return };
        passes.upload(&self.uniform, bytemuck::bytes_of(&self.data));
        let current = targets.current;
        let kept = attachment(&targets.kept[current], wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = passes.render(PASS, &[visibility.overwrite(), kept], None);
        let [x, y, width, height] = self.pixels;
        if width > 0 && height > 0 {
            pass.set_scissor_rect(x, y, width, height);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &view.receivers.bind_group, &[]);
            pass.set_bind_group(1, &targets.reads[current], &[]);
            pass.draw(0..3, 0..1);
        }
        drop(pass);
        targets.current = 1 - current;
        self.is_recorded = true;
        self.kept.note(passes);
    }

    /// The next frame starts anew, as after a cut.
    pub fn forget(&mut self) {
        self.last = None;
        self.movers.forget();
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.uniform.size() + self.fresh().map_or(0, |fresh| fresh.bytes() * 5)
    }

    fn make(&self, size: (u32, u32)) -> Result<Targets, Error> {
        let fresh = VisibilityTarget::new(&self.gpu, size.0, size.1)?;
        let kept =
            [0, 1].map(|_| target_texture(&self.gpu, "history", size, 1, FORMAT).create_view(&Default::default()));
        let reads = [1, 0].map(|other: usize| {
            let views = [&fresh.view, &kept[other]].map(wgpu::BindingResource::TextureView);
            let resources = [[self.uniform.as_entire_binding()].as_slice(), &views].concat();
            bind(&self.gpu, "history", &self.layout, &resources)
        });
        Ok(Targets { fresh, kept, reads, current: 0 })
    }

    fn pipeline_for(&mut self, has_normals: bool) {
        let known = &mut self.pipelines[usize::from(has_normals)];
        if known.is_none() {
            let receivers = Receivers::layout(&self.gpu);
            let pipeline = Fullscreen {
                label: PASS,
                module: &self.module,
                entry: "accumulate",
                groups: &[&receivers, &self.layout],
                target: VisibilityTarget::FORMAT.into(),
                constants: &[("HAS_NORMALS", f64::from(u8::from(has_normals)))],
            };
            *known = Some(pipeline.beside(&self.gpu, &[FORMAT.into()]));
        }
    }
}
