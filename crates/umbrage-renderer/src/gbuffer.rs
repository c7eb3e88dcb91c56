//! Depth, normals and materials of the visible surfaces; ambient and emitted light at once.

use umbrage::fullscreen::{UNIFORM, attachment, bind, layout, target_texture};
use umbrage::{Casters, Gpu, Passes, SeenCasters, Shader, shader_struct};
use umbrage_core::{CameraView, glam::DMat4};

/// The shader.
pub const SHADER: Shader = Shader::new("G-buffer", include_str!("gbuffer.wgsl")).with_layouts(&[GBufferView::LAYOUT]);

shader_struct! {
    /// The camera as the vertex shader needs it.
    struct GBufferView {
        clip_from_world: [[f32; 4]; 4],
        eye: [f32; 3],
        spare: f32,
        ambient: [f32; 3],
        more_spare: f32,
    }
}

const PACKED: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
const WIDE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The targets and what draws them.
pub(super) struct GBuffer {
    pub(super) depth: wgpu::Texture,
    /// Of the depth alone.
    pub(super) depth_view: wgpu::TextureView,
    /// Of depth and stencil, for techniques that count in it; `None` where the adapter has no such format.
    pub(super) stencil_view: Option<wgpu::TextureView>,
    /// Geometric normal turned to the eye, packed.
    pub(super) normal: wgpu::Texture,
    pub(super) normal_view: wgpu::TextureView,
    /// Shading normal, and shininess: negative where no shadow falls.
    pub(super) shading_view: wgpu::TextureView,
    /// Base colour and specular strength.
    pub(super) color_view: wgpu::TextureView,
    /// Light that leaves the surface; every light adds to it.
    pub(super) radiance_view: wgpu::TextureView,
    pipelines: [wgpu::RenderPipeline; 2],
    seen: SeenCasters,
    uniforms: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl GBuffer {
    pub(super) fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        let texture = |label, format| target_texture(gpu, label, (width, height), 1, format);
        let depth = texture("depth", depth_format(gpu));
        let depth_view = depth
            .create_view(&wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() });
        let normal = texture("geometric normal", PACKED);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let view_layout = layout(gpu, "camera", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM]);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniforms = gpu.buffer("camera", &[GBufferView::default()], usage);
        let bind_group = bind(gpu, "camera", &view_layout, &[uniforms.as_entire_binding()]);
        Self {
            stencil_view: depth.format().has_stencil_aspect().then(|| view(&depth)),
            depth_view,
            depth,
            normal_view: view(&normal),
            normal,
            shading_view: view(&texture("shading normal", WIDE)),
            color_view: view(&texture("base colour", WIDE)),
            radiance_view: view(&texture("radiance", WIDE)),
            pipelines: ["opaque", "masked"].map(|entry| pipeline(gpu, &view_layout, entry)),
            seen: SeenCasters::default(),
            uniforms,
            bind_group,
        }
    }

    pub(super) fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        casters: &Casters,
        camera: &CameraView,
        ambient: [f32; 3],
    ) {
        let clip_from_world = camera.clip_from_world() * DMat4::from_translation(casters.origin());
        self.seen.find(gpu, passes, casters, camera);
        let data = GBufferView {
            clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
            eye: (camera.eye - casters.origin()).as_vec3().to_array(),
            ambient,
            ..GBufferView::default()
        };
        passes.upload(&self.uniforms, bytemuck::bytes_of(&data));
        let clear = |view| attachment(view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: self.stencil_view.as_ref().unwrap_or(&self.depth_view),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let targets = [&self.normal_view, &self.shading_view, &self.color_view, &self.radiance_view].map(clear);
        let mut pass = passes.render("gbuffer", &targets, Some(depth));
        pass.set_bind_group(0, &self.bind_group, &[]);
        let [opaque, masked] = &self.pipelines;
        self.seen.draw(&mut pass, casters, opaque, masked);
    }
}

/// Floats, with a stencil where there can be one.
fn depth_format(gpu: &Gpu) -> wgpu::TextureFormat {
    if gpu.has(wgpu::Features::DEPTH32FLOAT_STENCIL8) {
        wgpu::TextureFormat::Depth32FloatStencil8
    } else {
        wgpu::TextureFormat::Depth32Float
    }
}

fn pipeline(gpu: &Gpu, view_layout: &wgpu::BindGroupLayout, entry: &str) -> wgpu::RenderPipeline {
    let module = SHADER.module(gpu);
    let [casters, texture] = &SeenCasters::layouts(gpu);
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(view_layout), Some(casters), Some(texture)],
        ..Default::default()
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("G-buffer"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &SeenCasters::vertex_layouts(),
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: depth_format(gpu),
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[PACKED, WIDE, WIDE, WIDE].map(|format| Some(format.into())),
        }),
        multiview_mask: None,
        cache: None,
    })
}
