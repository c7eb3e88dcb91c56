//! Pipelines that build, count and draw wedges.

use super::EYE_SHADER;
use super::MAKE_SHADER;
use super::light::Face;
use super::tables::Term;
use crate::casters::Edges;
use crate::fullscreen::{FLOATS, Fullscreen, STORAGE, STORAGE_WRITE, UNIFORM, additive, layout, texture};
use crate::receivers::Receivers;
use crate::{gpu::Gpu, visibility::VisibilityTarget};

/// Made once.
pub(super) struct Pipelines {
    pub make_layout: wgpu::BindGroupLayout,
    pub count_layout: wgpu::BindGroupLayout,
    pub draw_layout: wgpu::BindGroupLayout,
    pub resolve_layout: wgpu::BindGroupLayout,
    /// Of covered shares.
    pub format: wgpu::TextureFormat,
    pub clamps: bool,
    pub count: wgpu::ComputePipeline,
    make: Vec<(bool, wgpu::ComputePipeline)>,
    silhouettes: wgpu::BindGroupLayout,
    drawing: Vec<(Key, wgpu::RenderPipeline)>,
    resolving: Vec<(Resolve, wgpu::RenderPipeline)>,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Draw {
    /// Sides of hard shadow volumes.
    Sides,
    /// Bodies of wedges.
    Bodies,
}

/// A drawing pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub draw: Draw,
    /// Of the receivers' depth where it can be attached, and whether near is 1 in it.
    pub depth: Option<(wgpu::TextureFormat, bool)>,
    pub has_normals: bool,
    pub face: Face,
    pub term: Term,
}

/// A pipeline that turns shares into visibility.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Resolve {
    pub soft: bool,
    pub has_normals: bool,
    pub face: Face,
    pub term: Term,
}

impl Pipelines {
    pub fn new(gpu: &Gpu, silhouettes: &wgpu::BindGroupLayout) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let make_layout = layout(gpu, "make wedges", compute, &[UNIFORM, STORAGE_WRITE, STORAGE_WRITE]);
        let count_layout = layout(gpu, "shadows of the eye", compute, &[UNIFORM, STORAGE, STORAGE_WRITE]);
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let draw_layout = layout(gpu, "wedges", both, &[UNIFORM, UNIFORM, STORAGE]);
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let resolve_layout = layout(gpu, "covered shares", fragment, &[UNIFORM, UNIFORM, texture(FLOATS), STORAGE]);
        // Sums of many small terms.
        let blends = gpu.has(wgpu::Features::FLOAT32_BLENDABLE);
        let count = compute_pipeline(gpu, &EYE_SHADER.module(gpu), "count", [silhouettes, &count_layout], &[]);
        Self {
            format: if blends { wgpu::TextureFormat::Rg32Float } else { wgpu::TextureFormat::Rg16Float },
            clamps: gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL),
            count,
            make: Vec::new(),
            silhouettes: silhouettes.clone(),
            drawing: Vec::new(),
            resolving: Vec::new(),
            make_layout,
            count_layout,
            draw_layout,
            resolve_layout,
        }
    }

    /// Makes the pipeline that builds wedges where it is missing. `reversed`: near is 1.
    pub fn prepare_make(&mut self, gpu: &Gpu, reversed: bool) {
        if !self.make.iter().any(|(r, _)| *r == reversed) {
            let far = [("FAR", if reversed { 0.0 } else { 1.0 })];
            let groups = [&self.silhouettes, &self.make_layout];
            let made = compute_pipeline(gpu, &MAKE_SHADER.module(gpu), "make", groups, &far);
            self.make.push((reversed, made));
        }
    }

    pub fn making(&self, reversed: bool) -> Option<&wgpu::ComputePipeline> {
        self.make.iter().find(|(r, _)| *r == reversed).map(|(_, made)| made)
    }

    /// Makes a drawing pipeline where it is missing.
    pub fn prepare(&mut self, gpu: &Gpu, key: Key) {
        if !self.drawing.iter().any(|(k, _)| *k == key) {
            self.drawing.push((key, self.draw(gpu, key)));
        }
    }

    /// One that was prepared.
    pub fn drawing(&self, key: Key) -> Option<&wgpu::RenderPipeline> {
        self.drawing.iter().find(|(k, _)| *k == key).map(|(_, made)| made)
    }

    /// Makes the pipeline that turns shares into visibility where it is missing.
    pub fn prepare_resolve(&mut self, gpu: &Gpu, key: Resolve) {
        if self.resolving(key).is_none() {
            let on = |switch: bool| if switch { 1.0 } else { 0.0 };
            let face = f64::from(key.face as u32);
            let constants = [("SOFT", on(key.soft)), ("HAS_NORMALS", on(key.has_normals)), ("FACE", face)];
            let made = Fullscreen {
                label: "wedge visibility",
                module: &key.term.resolve_shader().module(gpu),
                entry: "resolve",
                groups: &[&Receivers::layout(gpu), &self.resolve_layout, &key.term.layout(gpu)],
                target: VisibilityTarget::FORMAT.into(),
                constants: &constants,
            };
            self.resolving.push((key, made.pipeline(gpu)));
        }
    }

    /// One that was prepared.
    pub fn resolving(&self, key: Resolve) -> Option<&wgpu::RenderPipeline> {
        self.resolving.iter().find(|(k, _)| *k == key).map(|(_, made)| made)
    }

    fn draw(&self, gpu: &Gpu, key: Key) -> wgpu::RenderPipeline {
        let bodies = key.draw == Draw::Bodies;
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&Receivers::layout(gpu)), Some(&self.draw_layout), Some(&key.term.layout(gpu))],
            ..Default::default()
        });
        let module = &key.term.draw_shader().module(gpu);
        let on = |switch: bool| if switch { 1.0 } else { 0.0 };
        let vertex_constants = [("CLAMPS", on(self.clamps))];
        let fragment_constants = [("FACE", f64::from(key.face as u32))];
        let constants = |constants, uses: bool| wgpu::PipelineCompilationOptions {
            constants: if uses { constants } else { &[] },
            ..Default::default()
        };
        let target = [Some(additive(self.format))];
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(if bodies { "wedges" } else { "sides" }),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(if bodies { "body" } else { "side" }),
                compilation_options: constants(&vertex_constants, bodies),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: bodies.then_some(wgpu::Face::Front),
                unclipped_depth: self.clamps && bodies,
                ..Default::default()
            },
            depth_stencil: key.depth.map(|(format, reversed)| wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(false),
                depth_compare: Some(compare(bodies && self.clamps, reversed)),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(if bodies { "add_wedge" } else { "add_side" }),
                compilation_options: constants(&fragment_constants, bodies),
                targets: &target,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// What is behind all of a body is in no wedge.
pub(super) fn compare(tests: bool, reversed: bool) -> wgpu::CompareFunction {
    match (tests, reversed) {
        (false, _) => wgpu::CompareFunction::Always,
        (true, true) => wgpu::CompareFunction::LessEqual,
        (true, false) => wgpu::CompareFunction::GreaterEqual,
    }
}

fn compute_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    entry: &str,
    [silhouettes, own]: [&wgpu::BindGroupLayout; 2],
    constants: &[(&str, f64)],
) -> wgpu::ComputePipeline {
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(silhouettes), Some(&Edges::draw_layout(gpu)), Some(own)],
        ..Default::default()
    });
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
        cache: None,
    })
}
