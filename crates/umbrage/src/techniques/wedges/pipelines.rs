//! Pipelines that build, count and draw wedges.

use super::draws::{Draw, shares_format};
use super::shaders;
use super::stages::{Stages, compare};
use super::tables::Term;
use crate::area_light::Face;
use crate::casters::Reads;
use crate::compute::compute_pipeline;
use crate::fullscreen::{FLOATS, Fullscreen, STORAGE, STORAGE_WRITE, UNIFORM, front_face, layout};
use crate::receivers::Receivers;
use crate::shader::Shader;
use crate::silhouettes::casters_layout;
use crate::{gpu::Gpu, visibility::VisibilityTarget};

/// Made once.
pub(super) struct Pipelines {
    pub make_layout: wgpu::BindGroupLayout,
    pub caps_layout: wgpu::BindGroupLayout,
    pub bundle_layout: wgpu::BindGroupLayout,
    pub draw_layout: wgpu::BindGroupLayout,
    pub resolve_layout: wgpu::BindGroupLayout,
    pub depth_layout: wgpu::BindGroupLayout,
    /// Of covered shares.
    pub format: wgpu::TextureFormat,
    pub clamps: bool,
    silhouettes: wgpu::BindGroupLayout,
    making: Made<Making, wgpu::ComputePipeline>,
    drawing: Made<Key, wgpu::RenderPipeline>,
    resolving: Made<Resolve, wgpu::RenderPipeline>,
    depths: Made<wgpu::TextureFormat, wgpu::RenderPipeline>,
}

/// What was made by what it was made for.
type Made<K, P> = Vec<(K, P)>;

fn find<'a, K: PartialEq, P>(made: &'a Made<K, P>, key: &K) -> Option<&'a P> {
    made.iter().find(|(k, _)| k == key).map(|(_, pipeline)| pipeline)
}

/// Compute pipelines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Making {
    /// Builds wedges.
    Wedges {
        /// Near is 1.
        reversed: bool,
    },
    /// Puts wedges together that are drawn as one.
    Bundles,
    /// Makes the caps of what is counted from infinity.
    Caps,
}

/// A drawing pipeline.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Key {
    pub draw: &'static Draw,
    /// Of what bodies are compared with, where there is something, and whether near is 1 in it.
    pub depth: Option<(wgpu::TextureFormat, bool)>,
    pub face: Face,
    pub term: Term,
    pub split: bool,
    /// The picture is mirrored.
    pub mirrored: bool,
}

/// A pipeline that turns shares into visibility.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Resolve {
    pub soft: bool,
    pub has_normals: bool,
    pub face: Face,
    pub term: Term,
    pub pieces: u32,
    pub scaled: bool,
}

fn on(switch: bool) -> f64 {
    if switch { 1.0 } else { 0.0 }
}

/// Whether bodies can be compared with depth: they end right behind what is seen, and a rasteriser
/// that shifts surfaces by more of a pixel would lose them there.
pub(super) fn is_exact(gpu: &Gpu) -> bool {
    gpu.snapping() <= 1.0 / 256.0
}

/// Whether bodies are compared with depth, and reach to infinity for that.
pub(super) fn clamps_depth(gpu: &Gpu) -> bool {
    gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL) && is_exact(gpu)
}

impl Pipelines {
    pub fn new(gpu: &Gpu, silhouettes: &wgpu::BindGroupLayout) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let layers = wgpu::BindingType::Texture {
            sample_type: FLOATS,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        Self {
            make_layout: layout(gpu, "make wedges", compute, &[UNIFORM, STORAGE_WRITE, STORAGE_WRITE]),
            caps_layout: layout(gpu, "make caps", compute, &[UNIFORM, STORAGE, STORAGE_WRITE]),
            bundle_layout: layout(
                gpu,
                "bundle wedges",
                compute,
                &[UNIFORM, STORAGE, STORAGE_WRITE, STORAGE_WRITE, STORAGE_WRITE],
            ),
            draw_layout: layout(gpu, "wedges", both, &[UNIFORM, UNIFORM, STORAGE, STORAGE, STORAGE, STORAGE]),
            resolve_layout: layout(gpu, "covered shares", fragment, &[UNIFORM, UNIFORM, layers, UNIFORM]),
            depth_layout: layout(gpu, "depth of wedges", fragment, &[UNIFORM]),
            format: shares_format(gpu),
            clamps: clamps_depth(gpu),
            silhouettes: silhouettes.clone(),
            making: Vec::new(),
            drawing: Vec::new(),
            resolving: Vec::new(),
            depths: Vec::new(),
        }
    }

    /// Makes a compute pipeline where it is missing.
    pub fn prepare_making(&mut self, gpu: &Gpu, key: Making) {
        if self.making(key).is_some() {
            return;
        }
        let made = match key {
            Making::Wedges { reversed } => {
                let far = if reversed { 0.0 } else { 1.0 };
                let constants = [("FAR", far)];
                let groups = [&self.silhouettes, &Reads::Edges.layout(gpu), &self.make_layout];
                compute(gpu, &shaders::MAKE, &groups, &constants)
            }
            Making::Bundles => compute(gpu, &shaders::BUNDLE, &[&self.bundle_layout], &[]),
            Making::Caps => {
                let groups = [&casters_layout(gpu), &Reads::Triangles.layout(gpu), &self.caps_layout];
                compute(gpu, &shaders::CAPS, &groups, &[])
            }
        };
        self.making.push((key, made));
    }

    /// One that was prepared.
    pub fn making(&self, key: Making) -> Option<&wgpu::ComputePipeline> {
        find(&self.making, &key)
    }

    /// Makes a drawing pipeline where it is missing.
    pub fn prepare(&mut self, gpu: &Gpu, key: Key) {
        if self.drawing(key).is_none() {
            self.drawing.push((key, self.draw(gpu, key)));
        }
    }

    /// One that was prepared.
    pub fn drawing(&self, key: Key) -> Option<&wgpu::RenderPipeline> {
        find(&self.drawing, &key)
    }

    /// Makes the pipeline that turns shares into visibility where it is missing.
    pub fn prepare_resolve(&mut self, gpu: &Gpu, key: Resolve) {
        if self.resolving(key).is_none() {
            let constants = [
                ("SOFT", on(key.soft)),
                ("HAS_NORMALS", on(key.has_normals)),
                ("FACE", f64::from(key.face as u32)),
                ("PIECES", f64::from(key.pieces)),
                ("SCALED", on(key.scaled)),
            ];
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
        find(&self.resolving, &key)
    }

    /// Makes the pipeline that copies depth where it is missing.
    pub fn prepare_depth(&mut self, gpu: &Gpu, format: wgpu::TextureFormat) {
        if self.depth(format).is_none() {
            let module = shaders::DEPTH.module(gpu);
            let groups = [&Receivers::layout(gpu), &self.depth_layout];
            let depth = wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            };
            let stages = Stages::new(&module, "fullscreen", "copy_depth");
            self.depths.push((format, stages.pipeline(gpu, &groups, Some(depth), None)));
        }
    }

    /// One that was prepared.
    pub fn depth(&self, format: wgpu::TextureFormat) -> Option<&wgpu::RenderPipeline> {
        find(&self.depths, &format)
    }

    fn draw(&self, gpu: &Gpu, key: Key) -> wgpu::RenderPipeline {
        let how = key.draw;
        let module = (how.shader)(key.term).module(gpu);
        let (receivers, tables) = (Receivers::layout(gpu), key.term.layout(gpu));
        let vertex_constants = [("CLAMPS", on(self.clamps))];
        let fragment_constants = [("FACE", f64::from(key.face as u32)), ("SPLIT", on(key.split))];
        let stages = Stages {
            vertex_constants: if how.is_body { &vertex_constants } else { &[] },
            fragment_constants: if how.shares { &fragment_constants } else { &[] },
            front_face: front_face(key.mirrored),
            cull_mode: how.cull_mode,
            unclipped_depth: self.clamps && how.is_body,
            ..Stages::new(&module, how.vertex, how.fragment)
        };
        let depth = key.depth.map(|(format, reversed)| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(false),
            depth_compare: Some(compare(how.is_body && self.clamps, reversed)),
            stencil: how.stencil.clone(),
            bias: Default::default(),
        });
        let more = how.more.map(|layout| layout(gpu));
        let mut groups = vec![&receivers, &self.draw_layout, &tables];
        groups.extend(&more);
        stages.pipeline(gpu, &groups, depth, Some((how.target)(gpu)))
    }
}

pub(super) fn compute(
    gpu: &Gpu,
    shader: &Shader,
    groups: &[&wgpu::BindGroupLayout],
    constants: &[(&str, f64)],
) -> wgpu::ComputePipeline {
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    compute_pipeline(gpu, &shader.module(gpu), "make", &groups, constants)
}
