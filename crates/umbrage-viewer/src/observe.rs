//! The scene as an observer sees it, with what a technique found for the camera that stands still.

use crate::show::FORMAT;
use umbrage::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, attachment, bind};
use umbrage::{Gpu, Shader};
use umbrage_core::{Camera, Image};
use umbrage_renderer::{LightPass, Lights, Renderer};
use umbrage_report::Given;

/// The shader.
pub const OBSERVE: Shader = Shader::new("observe", include_str!("observe.wgsl"));

/// The pipeline for all panes.
pub(crate) struct Observe {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

/// What a picture is to show.
pub(crate) struct View<'a> {
    pub observer: &'a Camera,
    pub frozen: &'a Camera,
    /// 0 for the shaded scene, 1 for visibility, 2 for its error.
    pub picture: f32,
    pub gain: f32,
    pub truth: &'a wgpu::TextureView,
    pub pane: &'a wgpu::TextureView,
}

/// What a pane keeps from the frame of the camera that stands still.
pub(crate) struct Frozen {
    numbers: Vec<usize>,
    size: (u32, u32),
    /// All of them shine everywhere.
    lights: Lights,
    visibility: wgpu::Texture,
    depth: wgpu::Texture,
}

impl Frozen {
    /// For lights of these numbers; `like` has the form of visibility.
    pub fn new(gpu: &Gpu, renderer: &Renderer, numbers: &[usize], like: &wgpu::Texture) -> Result<Self, String> {
        let size = renderer.size();
        let lit = Image::filled(size.0, size.1, 1.0);
        let pass = |number: &usize| {
            let technique = Box::new(Given::new(gpu, &lit).map_err(|e| e.to_string())?);
            Ok::<_, String>(LightPass { light: *number, technique })
        };
        let passes = numbers.iter().map(pass).collect::<Result<_, _>>()?;
        let lights = renderer.make_lights(passes).map_err(|e| e.to_string())?;
        let copy = |texture: &wgpu::Texture| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("frozen"),
                size: texture.size(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: texture.format(),
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            })
        };
        let (visibility, depth) = (copy(like), copy(renderer.depth_texture()));
        Ok(Self { numbers: numbers.into(), size, lights, visibility, depth })
    }

    pub fn fits(&self, numbers: &[usize], size: (u32, u32)) -> bool {
        self.numbers == numbers && self.size == size
    }
}

impl Observe {
    pub fn new(gpu: &Gpu) -> Self {
        let floats = fullscreen::texture(FLOATS);
        let bindings = [floats, floats, floats, floats, floats, UNIFORM];
        let layout = fullscreen::layout(gpu, "observe", wgpu::ShaderStages::FRAGMENT, &bindings);
        let module = OBSERVE.module(gpu);
        let (groups, target) = (&[&layout][..], FORMAT.into());
        let pipeline =
            Fullscreen { label: "observe", module: &module, entry: "observe", groups, target, constants: &[] }
                .pipeline(gpu);
        Self { layout, pipeline }
    }

    /// Draws what the technique in the renderer, which has just drawn pass `main` of a frame for
    /// the frozen camera, found there, as the observer sees it.
    pub fn draw(
        &self,
        gpu: &Gpu,
        renderer: &mut Renderer,
        main: usize,
        frozen: &mut Frozen,
        view: &View<'_>,
    ) -> Result<(), String> {
        let text = |e: umbrage::Error| e.to_string();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let visibility = renderer.visibility_texture(main).map_err(text)?;
        for (from, to) in [(visibility, &frozen.visibility), (renderer.depth_texture(), &frozen.depth)] {
            encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), to.size());
        }
        gpu.queue.submit([encoder.finish()]);
        let lights: Vec<_> = (0..frozen.numbers.len()).map(|pass| renderer.light_mut(pass).cloned()).collect();
        renderer.exchange_lights(&mut frozen.lights).map_err(text)?;
        for (pass, light) in lights.into_iter().enumerate() {
            if let (Some(of_pass), Some(light)) = (renderer.light_mut(pass), light) {
                *of_pass = light;
            }
        }
        let drawn = renderer.frame(view.observer).map_err(text);
        renderer.exchange_lights(&mut frozen.lights).map_err(text)?;
        drawn?;
        self.project(gpu, renderer, frozen, view);
        Ok(())
    }

    fn project(&self, gpu: &Gpu, renderer: &Renderer, frozen: &Frozen, view: &View<'_>) {
        let (width, height) = frozen.size;
        let [observer, still] = [view.observer, view.frozen].map(|camera| camera.view(width, height));
        // In double precision, so that places far away stay apart.
        let matrix = (still.clip_from_world() * observer.clip_from_world().inverse()).as_mat4();
        let mut params = matrix.to_cols_array().to_vec();
        params.extend([view.picture, view.gain, 0.0, 0.0]);
        let params = gpu.buffer("observe", &params, wgpu::BufferUsages::UNIFORM);
        let of = |texture: &wgpu::Texture| {
            let has_depth = texture.format().has_depth_aspect();
            let aspect = if has_depth { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
            texture.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() })
        };
        let [depth, frozen_depth, visibility] = [renderer.depth_texture(), &frozen.depth, &frozen.visibility].map(of);
        let textures = [renderer.picture_view(), &depth, &frozen_depth, &visibility, view.truth];
        let mut resources: Vec<_> = textures.map(wgpu::BindingResource::TextureView).into();
        resources.push(params.as_entire_binding());
        let group = bind(gpu, "observe", &self.layout, &resources);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("observe"),
            color_attachments: &[attachment(view.pane, wgpu::LoadOp::Clear(wgpu::Color::BLACK))],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }
}
