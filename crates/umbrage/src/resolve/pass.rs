//! The pass that reads a host's buffers.

use super::host::{HostDepth, Part};
use crate::fullscreen::{UNIFORM, attachment, bind, layout, texture};
use crate::shader::{Module, Shader, shader_struct};
use crate::{
    error::Error,
    gpu::Gpu,
    passes::Passes,
    receivers::{check, placeholder},
};
use umbrage_core::CameraView;

/// What receivers are made as.
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
pub(super) const NORMAL: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

macro_rules! module {
    ($name:literal) => {
        Module { name: $name, source: include_str!(concat!($name, ".wgsl")) }
    };
}

const MODULES: &[Module] = &[
    module!("resolve"),
    module!("host_single"),
    module!("host_multi"),
    module!("stored_depth"),
    module!("stored_distance"),
];

const fn shader(source: &'static str) -> Shader {
    Shader::new("resolve", source).with_modules(MODULES).with_layouts(&[Resolving::LAYOUT])
}

/// By whether buffers have several samples.
const PLAIN: [Shader; 2] =
    [shader("// needs: resolve, host_single, stored_depth"), shader("// needs: resolve, host_multi, stored_depth")];
/// The same for distances; the host's function is missing in these.
const DISTANCES: [Shader; 2] = [
    shader("// needs: resolve, host_single, stored_distance"),
    shader("// needs: resolve, host_multi, stored_distance"),
];

/// Those that are whole.
pub(crate) const SHADERS: [Shader; 2] = PLAIN;

shader_struct! {
    /// See `resolve.wgsl`.
    pub(super) struct Resolving {
        corner: [i32; 2],
        size: [i32; 2],
        scale: [f32; 2],
        sample: [f32; 2],
        z_and_w: [f32; 2],
        z_and_w_at_eye: [f32; 2],
        background: f32,
        pad_a: f32,
        pad_b: f32,
        pad_c: f32,
    }
}

impl Resolving {
    pub fn of(part: &Part, camera: &CameraView, samples: u32) -> Self {
        let m = camera.clip_from_view;
        let (width, height) = part.receivers_size();
        Self {
            corner: [part.corner.0 as i32, part.corner.1 as i32],
            size: [part.size.0 as i32, part.size.1 as i32],
            scale: [part.size.0 as f32 / width as f32, part.size.1 as f32 / height as f32],
            sample: first_sample(samples),
            z_and_w: [-m.z_axis.z as f32, -m.z_axis.w as f32],
            z_and_w_at_eye: [m.w_axis.z as f32, m.w_axis.w as f32],
            background: camera.background_depth(),
            ..Self::default()
        }
    }

    /// That depth under this projection is that of a distance along the view alone.
    pub fn knows_distances(camera: &CameraView) -> bool {
        let [z, w] = [2, 3].map(|i| camera.clip_from_view.row(i));
        [z.x, z.y, w.x, w.y] == [0.0; 4]
    }

    /// Pixels are read elsewhere than in their middle.
    fn is_off_center(&self) -> bool {
        self.scale != [1.0; 2] || self.sample != [0.0; 2]
    }
}

/// Where the first of so many samples lies, from the middle of its pixel: the standard places of
/// Vulkan and Direct3D.
fn first_sample(samples: u32) -> [f32; 2] {
    match samples {
        2 => [0.25, 0.25],
        4 => [-0.125, -0.375],
        8 => [0.0625, -0.1875],
        16 => [0.0625, 0.0625],
        _ => [0.0, 0.0],
    }
}

pub(super) struct ResolvePass {
    /// By whether pixels are read elsewhere than in their middle.
    pipelines: [wgpu::RenderPipeline; 2],
    uniform: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl ResolvePass {
    pub fn new(gpu: &Gpu, host: &HostDepth<'_>) -> Result<Self, Error> {
        let is_multi = host.depth.texture().sample_count() > 1;
        let own = layout(gpu, "resolve", wgpu::ShaderStages::FRAGMENT, &bindings(is_multi));
        let uniform =
            gpu.buffer("resolve", &[Resolving::default()], wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        let none;
        let normal = match host.normal {
            Some(view) => view,
            None => {
                none = placeholder(gpu);
                &none
            }
        };
        let views = [host.depth, normal].map(wgpu::BindingResource::TextureView);
        let resources = [[uniform.as_entire_binding()].as_slice(), &views].concat();
        let bind_group = gpu.validated(|| bind(gpu, "resolve", &own, &resources)).map_err(check::rejected)?;
        let module = gpu.validated(|| module(gpu, host, is_multi)).map_err(check::not_compiled)?;
        let make = |is_off| pipeline(gpu, &own, &module, host.normal.is_some(), is_off);
        let pipelines = gpu.validated(|| [make(false), make(true)]).map_err(check::not_compiled)?;
        Ok(Self { pipelines, uniform, bind_group })
    }

    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        resolving: &Resolving,
        depth: &wgpu::TextureView,
        normal: Option<&wgpu::TextureView>,
    ) {
        passes.upload(&self.uniform, bytemuck::bytes_of(resolving));
        let color = normal.map(|view| attachment(view, wgpu::LoadOp::Clear(wgpu::Color::BLACK)));
        let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store });
        let depth = wgpu::RenderPassDepthStencilAttachment { view: depth, depth_ops, stencil_ops: None };
        let mut pass = passes.render("resolve receivers", color.as_slice(), Some(depth));
        pass.set_pipeline(&self.pipelines[usize::from(resolving.is_off_center())]);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn bindings(multisampled: bool) -> [wgpu::BindingType; 3] {
    let depth = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled,
    };
    [UNIFORM, depth, texture(wgpu::TextureSampleType::Uint)]
}

/// With the host's function at its end where there is one.
fn module(gpu: &Gpu, host: &HostDepth<'_>, is_multi: bool) -> wgpu::ShaderModule {
    let Some(stored) = host.stored else { return PLAIN[usize::from(is_multi)].module(gpu) };
    let text = DISTANCES[usize::from(is_multi)].text().unwrap_or_default();
    gpu.module_of_host("resolve distances", [text.as_str(), stored.wgsl].join("\n"))
}

fn pipeline(
    gpu: &Gpu,
    own: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    has_normals: bool,
    is_off_center: bool,
) -> wgpu::RenderPipeline {
    let layout = gpu.pipeline_layout(&[Some(own)]);
    let constants = [("IS_OFF_CENTER", f64::from(u8::from(is_off_center)))];
    let targets = has_normals.then(|| Some(NORMAL.into()));
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("resolve receivers"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("fullscreen"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(if has_normals { "resolve_depth_and_normal" } else { "resolve_depth" }),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: targets.as_slice(),
        }),
        multiview_mask: None,
        cache: None,
    })
}
