//! The sky behind the scene, where it shines.

use crate::targets::WIDE;
use umbrage::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, additive, attachment, bind, layout};
use umbrage::{Eye, Gpu, Passes, Receivers, Shader, View, shader_struct};
use umbrage_core::{Environment, Image, Sky};

/// The shader.
pub const SHADER: Shader = Shader::new("sky", include_str!("backdrop.wgsl")).with_layouts(&[SkyBehind::LAYOUT]);

shader_struct! {
    /// Camera and sky as the shader needs them.
    struct SkyBehind {
        eye: Eye,
        sky_from_world: [[f32; 4]; 3],
        intensity: f32,
        /// Rows of the picture from pole to pole, and what is added to their number.
        rows: f32,
        first_row: f32,
        spare: f32,
    }
}

/// Draws a sky where nothing was drawn.
pub(crate) struct Backdrop {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    uniforms: wgpu::Buffer,
    picture: Option<Picture>,
}

/// A sky on the GPU.
struct Picture {
    sky: Sky,
    rows: [f32; 2],
    bind_group: wgpu::BindGroup,
}

impl Backdrop {
    pub fn new(gpu: &Gpu) -> Self {
        let layout = layout(gpu, "sky", wgpu::ShaderStages::FRAGMENT, &[UNIFORM, fullscreen::texture(FLOATS)]);
        let pipeline = Fullscreen {
            label: "sky",
            module: &SHADER.module(gpu),
            entry: "backdrop",
            groups: &[&Receivers::layout(gpu), &layout],
            target: additive(WIDE),
            constants: &[],
        }
        .pipeline(gpu);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniforms = gpu.buffer("sky", &[SkyBehind::default()], usage);
        Self { pipeline, layout, uniforms, picture: None }
    }

    /// Adds what the camera of `view` sees of the sky to a picture that is empty there.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        environment: &Environment,
        picture: &wgpu::TextureView,
    ) {
        let known = self.picture.take().filter(|known| known.sky.is_copy_of(&environment.sky));
        let sky = known.unwrap_or_else(|| self.upload(gpu, &environment.sky));
        let turn = environment.sky_from_world();
        let uniforms = SkyBehind {
            eye: Eye::new(view),
            sky_from_world: [0, 1, 2].map(|i| turn.row(i).as_vec3().extend(0.0).to_array()),
            intensity: environment.intensity,
            rows: sky.rows[0],
            first_row: sky.rows[1],
            spare: 0.0,
        };
        passes.upload(&self.uniforms, bytemuck::bytes_of(&uniforms));
        let mut pass = passes.render("sky", &[attachment(picture, wgpu::LoadOp::Load)], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view.receivers.bind_group(), &[]);
        pass.set_bind_group(1, &sky.bind_group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.picture = Some(sky);
    }

    fn upload(&self, gpu: &Gpu, sky: &Sky) -> Picture {
        let (image, rows) = pixels(sky, gpu.device.limits().max_texture_dimension_2d);
        let size = wgpu::Extent3d { width: image.width, height: image.height, depth_or_array_layers: 1 };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("sky"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let texels: Vec<[f32; 4]> = image.data.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let lines =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * image.width), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), lines, size);
        let view = texture.create_view(&Default::default());
        let entries = [self.uniforms.as_entire_binding(), wgpu::BindingResource::TextureView(&view)];
        Picture { sky: sky.clone(), rows, bind_group: bind(gpu, "sky", &self.layout, &entries) }
    }
}

/// A sky as a picture with sides of at most `most`, and how its rows go from pole to pole.
fn pixels(sky: &Sky, most: u32) -> (Image<[f32; 3]>, [f32; 2]) {
    match sky {
        Sky::Picture(picture) if picture.image().width.max(picture.image().height) <= most => {
            let image = picture.image().clone();
            let rows = image.height as f32 - 1.0;
            (image, [rows, 0.0])
        }
        _ => {
            let (width, height) = match sky {
                Sky::Constant(_) => (1, 1),
                Sky::Gradient(_) => (1, 512),
                Sky::Picture(_) | Sky::Daylight(_) => (1024, 512),
            };
            let (width, height) = (width.min(most), height.min(most));
            (sky.picture(width, height), [height as f32, -0.5])
        }
    }
}
