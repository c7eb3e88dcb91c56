//! The full-screen pass that finds geometric normals.

use umbrage::core::CameraView;
use umbrage::core::glam::{DMat4, Vec4};
use umbrage::fullscreen::{Fullscreen, UNIFORM, attachment, bind, layout, target_texture, texture};
use umbrage::{Error, Gpu, Passes, wgsl};

/// As in `normals.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Eye {
    eye_from_ndc: [[f32; 4]; 4],
    to_eye: [f32; 4],
    ndc_from_pixel: [f32; 2],
    pad: [f32; 2],
}

/// The way to the eye where it is the same everywhere, with 1 after it; zeros otherwise.
pub fn to_eye(camera: &CameraView) -> [f32; 4] {
    let is_orthographic = camera.clip_from_view.w_axis.w == 1.0;
    let way = (-camera.forward()).as_vec3().extend(1.0);
    if is_orthographic { way } else { Vec4::ZERO }.to_array()
}

/// Normalised device coordinates to space relative to the eye.
pub fn eye_from_ndc(camera: &CameraView) -> [[f32; 4]; 4] {
    let rotation = DMat4::from_mat3(camera.view_from_world.matrix3);
    (camera.clip_from_view * rotation).inverse().as_mat4().to_cols_array_2d()
}

/// What a pixel is across and down.
pub fn ndc_from_pixel((width, height): (u32, u32)) -> [f32; 2] {
    [2.0 / width as f32, -2.0 / height as f32]
}

pub struct Normals {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    eye: wgpu::Buffer,
}

/// What they are found from, and where they go.
pub struct NormalTarget {
    group: wgpu::BindGroup,
    pub view: wgpu::TextureView,
    size: (u32, u32),
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

impl Normals {
    pub fn new(gpu: &Gpu) -> Self {
        let source = [include_str!("normals.wgsl"), include_str!("direction.wgsl"), wgsl::PACK_NORMAL].concat();
        let source = wgpu::ShaderSource::Wgsl(source.into());
        let label = Some("umbrage normals");
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let [depth, surface] = [wgpu::TextureSampleType::Depth, wgpu::TextureSampleType::Uint].map(texture);
        let layout = layout(gpu, "umbrage normals", wgpu::ShaderStages::FRAGMENT, &[depth, surface, UNIFORM]);
        let pass = Fullscreen {
            label: "umbrage normals",
            module: &module,
            entry: "normals",
            groups: &[&layout],
            target: FORMAT.into(),
            constants: &[],
        };
        let pipeline = pass.pipeline(gpu);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self { pipeline, layout, eye: gpu.buffer("umbrage eye", &[Eye::default()], usage) }
    }

    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits.
    pub fn target(
        &self,
        gpu: &Gpu,
        depth: &wgpu::TextureView,
        deferred: &wgpu::TextureView,
        size: (u32, u32),
    ) -> Result<NormalTarget, Error> {
        gpu.check_size("normals", size.0, size.1)?;
        let [a, b] = [depth, deferred].map(wgpu::BindingResource::TextureView);
        let group = bind(gpu, "umbrage normals", &self.layout, &[a, b, self.eye.as_entire_binding()]);
        let view = target_texture(gpu, "umbrage normals", size, 1, FORMAT).create_view(&Default::default());
        Ok(NormalTarget { group, view, size })
    }

    pub fn record(&self, passes: &mut Passes<'_>, camera: &CameraView, target: &NormalTarget) {
        let eye = Eye {
            eye_from_ndc: eye_from_ndc(camera),
            to_eye: to_eye(camera),
            ndc_from_pixel: ndc_from_pixel(target.size),
            pad: [0.0; 2],
        };
        passes.upload(&self.eye, bytemuck::bytes_of(&eye));
        let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let mut pass = passes.render("umbrage normals", &[attachment(&target.view, clear)], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &target.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
