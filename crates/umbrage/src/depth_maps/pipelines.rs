//! The passes that render a layer of a map.

use super::{FORMAT, MapView, Textures};
use crate::casters::{CASTERS_WGSL, Casters, DrawList, MATERIALS_WGSL, texture_layout, vertex_layouts};
use crate::fullscreen::{self, UNIFORM, bind, layout};
use crate::shader::{FULLSCREEN, Shader};
use crate::{gpu::Gpu, passes::Passes};

/// Nearest surface, opaque and alpha-masked.
pub(crate) const DEPTH_SHADER: Shader = Shader {
    name: "shadow map",
    parts: &[CASTERS_WGSL, MATERIALS_WGSL, include_str!("../wgsl/map_depth.wgsl")],
    layouts: &[MapView::LAYOUT, crate::casters::Instance::LAYOUT, crate::casters::MATERIAL_LAYOUT],
};

/// Second surface.
pub(crate) const SECOND_SHADER: Shader = Shader {
    name: "second surface",
    parts: &[
        CASTERS_WGSL,
        MATERIALS_WGSL,
        include_str!("../wgsl/map_depth.wgsl"),
        include_str!("../wgsl/map_second.wgsl"),
    ],
    layouts: DEPTH_SHADER.layouts,
};

/// Mean of the two.
pub(crate) const MIDPOINT_SHADER: Shader =
    Shader { name: "midpoint", parts: &[FULLSCREEN, include_str!("../wgsl/map_midpoint.wgsl")], layouts: &[] };

/// Pipelines and layouts, made once.
pub(super) struct Pipelines {
    nearest: [wgpu::RenderPipeline; 2],
    second: Option<SecondPipelines>,
    view_layout: wgpu::BindGroupLayout,
    one_map: wgpu::BindGroupLayout,
    two_maps: wgpu::BindGroupLayout,
}

/// For `faces = midpoint`.
struct SecondPipelines {
    surface: [wgpu::RenderPipeline; 2],
    /// For parallel and for perspective views.
    midpoint: [wgpu::RenderPipeline; 2],
}

impl Pipelines {
    pub(super) fn new(gpu: &Gpu, back_faces: bool, midpoint: bool) -> Self {
        let view_layout = layout(gpu, "map view", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM]);
        let one_map = depth_layout(gpu, 1);
        let two_maps = depth_layout(gpu, 2);
        let casters = Casters::layout(gpu);
        let textures = texture_layout(gpu);
        let pipeline_layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                bind_group_layouts: groups,
                ..Default::default()
            })
        };
        let cull_mode = back_faces.then_some(wgpu::Face::Front);
        let draw = |module: &wgpu::ShaderModule, layout: &wgpu::PipelineLayout, vertex, fragment| {
            let compare = wgpu::CompareFunction::Greater;
            pipeline(gpu, &Recipe { layout, module, vertex, fragment, cull_mode, compare, constants: &[] })
        };
        let module = DEPTH_SHADER.module(gpu);
        let plain = pipeline_layout(&[Some(&view_layout), Some(&casters)]);
        let textured = pipeline_layout(&[Some(&view_layout), Some(&casters), Some(&textures)]);
        let nearest = [draw(&module, &plain, "opaque", None), draw(&module, &textured, "masked", Some("cut_out"))];
        let second = midpoint.then(|| {
            let module = SECOND_SHADER.module(gpu);
            let all = pipeline_layout(&[Some(&view_layout), Some(&casters), Some(&textures), Some(&one_map)]);
            SecondPipelines {
                surface: [
                    draw(&module, &all, "opaque", Some("second")),
                    draw(&module, &all, "masked", Some("second_cut_out")),
                ],
                midpoint: midpoint_pipelines(gpu, &pipeline_layout(&[Some(&two_maps)])),
            }
        });
        Self { nearest, second, view_layout, one_map, two_maps }
    }

    /// Renders one layer; returns how often the casters were drawn.
    pub(super) fn record(
        &self,
        passes: &mut Passes<'_>,
        casters: &Casters,
        list: &DrawList,
        textures: &Textures,
        layer: usize,
        perspective: bool,
    ) -> u32 {
        let views = &textures.layers[layer];
        let view_uniform = &textures.uniforms[layer].1;
        {
            let mut pass = passes.render("map", &[], clear(&views.first));
            pass.set_bind_group(0, view_uniform, &[]);
            list.draw(&mut pass, casters, false, |masked| &self.nearest[usize::from(masked)]);
        }
        let (Some(second), Some(pipelines)) = (&views.second, &self.second) else { return 1 };
        {
            let mut pass = passes.render("second surface", &[], clear(&second.second));
            pass.set_bind_group(0, view_uniform, &[]);
            pass.set_bind_group(3, &second.read_first, &[]);
            list.draw(&mut pass, casters, true, |masked| &pipelines.surface[usize::from(masked)]);
        }
        let mut pass = passes.render("midpoint", &[], clear(&second.midpoint));
        pass.set_pipeline(&pipelines.midpoint[usize::from(perspective)]);
        pass.set_bind_group(0, &second.read_both, &[]);
        pass.draw(0..3, 0..1);
        2
    }

    pub(super) fn view_uniform(&self, gpu: &Gpu) -> (wgpu::Buffer, wgpu::BindGroup) {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let buffer = gpu.buffer("map view", &[MapView::default()], usage);
        let bind_group = bind(gpu, "map view", &self.view_layout, &[buffer.as_entire_binding()]);
        (buffer, bind_group)
    }

    pub(super) fn read_first(&self, gpu: &Gpu, first: &wgpu::TextureView) -> wgpu::BindGroup {
        read(gpu, &self.one_map, &[first])
    }

    pub(super) fn read_both(
        &self,
        gpu: &Gpu,
        first: &wgpu::TextureView,
        second: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        read(gpu, &self.two_maps, &[first, second])
    }
}

/// An attachment cleared to "nothing there": depth 0, infinitely far.
fn clear(view: &wgpu::TextureView) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
    Some(wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    })
}

/// A layout of so many depth textures.
fn depth_layout(gpu: &Gpu, count: usize) -> wgpu::BindGroupLayout {
    let depth = fullscreen::texture(wgpu::TextureSampleType::Depth);
    layout(gpu, "depth maps", wgpu::ShaderStages::FRAGMENT, &vec![depth; count])
}

fn read(gpu: &Gpu, layout: &wgpu::BindGroupLayout, views: &[&wgpu::TextureView]) -> wgpu::BindGroup {
    let resources: Vec<_> = views.iter().map(|view| wgpu::BindingResource::TextureView(view)).collect();
    bind(gpu, "depth maps", layout, &resources)
}

fn midpoint_pipelines(gpu: &Gpu, layout: &wgpu::PipelineLayout) -> [wgpu::RenderPipeline; 2] {
    let module = MIDPOINT_SHADER.module(gpu);
    [0.0, 1.0].map(|perspective| {
        let recipe = Recipe {
            layout,
            module: &module,
            vertex: "fullscreen",
            fragment: Some("midpoint"),
            cull_mode: None,
            compare: wgpu::CompareFunction::Always,
            constants: &[("PERSPECTIVE", perspective)],
        };
        pipeline(gpu, &recipe)
    })
}

/// What the pipelines of a map differ in.
struct Recipe<'a> {
    layout: &'a wgpu::PipelineLayout,
    module: &'a wgpu::ShaderModule,
    vertex: &'a str,
    fragment: Option<&'a str>,
    cull_mode: Option<wgpu::Face>,
    compare: wgpu::CompareFunction,
    constants: &'a [(&'a str, f64)],
}

fn pipeline(gpu: &Gpu, recipe: &Recipe<'_>) -> wgpu::RenderPipeline {
    let buffers = match recipe.vertex {
        "fullscreen" => Vec::new(),
        name => vertex_layouts(name == "masked"),
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(recipe.fragment.unwrap_or(recipe.vertex)),
        layout: Some(recipe.layout),
        vertex: wgpu::VertexState {
            module: recipe.module,
            entry_point: Some(recipe.vertex),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState { cull_mode: recipe.cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(recipe.compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: recipe.fragment.map(|entry| wgpu::FragmentState {
            module: recipe.module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions { constants: recipe.constants, ..Default::default() },
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}
