//! Pipelines that count volumes and turn counts into visibility, one for each combination that came
//! up.

use super::options::CounterKind;
use crate::fullscreen::{FLOATS, additive, front_face, layout, texture};
use crate::shader::Shader;
use crate::silhouettes::{Part, Silhouettes};
use crate::{gpu::Gpu, visibility::VisibilityTarget};
use wgpu::{CompareFunction, StencilFaceState, StencilOperation};

pub(super) const COUNT_SHADER: Shader = Shader::new("volumes", include_str!("count.wgsl"));

pub(super) const RESOLVE_SHADER: Shader = Shader::new("volume visibility", include_str!("resolve.wgsl"));

/// How surfaces of volumes are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Test {
    /// Those in front of what is seen.
    Pass,
    /// Those behind it.
    Fail,
    /// Those in front of it, odd or even.
    Parity,
}

/// What a counting pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub target: TargetKey,
    /// See [`crate::silhouettes::Shape::weighted`].
    pub weighted: bool,
    pub test: Test,
    pub part: Part,
    /// Of two passes, the sides left out.
    pub cull: Option<wgpu::Face>,
}

/// What all pipelines of a pass have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TargetKey {
    pub kind: CounterKind,
    pub depth_format: wgpu::TextureFormat,
    /// Of floats.
    pub count_format: wgpu::TextureFormat,
    /// Near is 1.
    pub reversed: bool,
    /// The picture is mirrored.
    pub mirrored: bool,
}

/// Made once each.
pub(super) struct Pipelines {
    count_module: wgpu::ShaderModule,
    /// Of sides and of caps.
    count_layouts: [wgpu::PipelineLayout; 2],
    entries: [&'static str; 2],
    resolve_module: wgpu::ShaderModule,
    pub read_counts: wgpu::BindGroupLayout,
    counting: Vec<(Key, wgpu::RenderPipeline)>,
    resolving: Vec<((TargetKey, bool), wgpu::RenderPipeline)>,
    clamps: bool,
}

impl Pipelines {
    pub fn new(gpu: &Gpu, silhouettes: &Silhouettes) -> Self {
        Self {
            count_module: COUNT_SHADER.module(gpu),
            count_layouts: [Part::PassSides, Part::Caps].map(|part| silhouettes.pipeline_layout(gpu, part)),
            entries: silhouettes.entries(),
            resolve_module: RESOLVE_SHADER.module(gpu),
            read_counts: layout(gpu, "counts", wgpu::ShaderStages::FRAGMENT, &[texture(FLOATS)]),
            counting: Vec::new(),
            resolving: Vec::new(),
            clamps: gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL),
        }
    }

    /// Makes a counting pipeline where it is missing.
    pub fn prepare(&mut self, gpu: &Gpu, key: Key) {
        if !self.counting.iter().any(|(k, _)| *k == key) {
            self.counting.push((key, self.count(gpu, key)));
        }
    }

    /// One that was prepared.
    pub fn counting(&self, key: Key) -> Option<&wgpu::RenderPipeline> {
        self.counting.iter().find(|(k, _)| *k == key).map(|(_, pipeline)| pipeline)
    }

    /// Makes the pipeline that resolves counts where it is missing.
    pub fn prepare_resolve(&mut self, gpu: &Gpu, target: TargetKey, parity: bool) {
        if !self.resolving.iter().any(|(k, _)| *k == (target, parity)) {
            self.resolving.push(((target, parity), self.resolve(gpu, target, parity)));
        }
    }

    /// One that was prepared.
    pub fn resolving(&self, target: TargetKey, parity: bool) -> Option<&wgpu::RenderPipeline> {
        self.resolving.iter().find(|(k, _)| *k == (target, parity)).map(|(_, pipeline)| pipeline)
    }

    fn count(&self, gpu: &Gpu, key: Key) -> wgpu::RenderPipeline {
        let is_cap = usize::from(key.part == Part::Caps);
        let on = |switch: bool| if switch { 1.0 } else { 0.0 };
        let vertex_constants = [("WEIGHTED", on(key.weighted))];
        let fragment_constants =
            [("FROM_INFINITY", on(key.test == Test::Fail)), ("PARITY", on(key.test == Test::Parity))];
        let target = [Some(additive(key.target.count_format))];
        let counts = wgpu::FragmentState {
            module: &self.count_module,
            entry_point: Some("count"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &fragment_constants,
                ..Default::default()
            },
            targets: &target,
        };
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("volumes"),
            layout: Some(&self.count_layouts[is_cap]),
            vertex: wgpu::VertexState {
                module: &self.count_module,
                entry_point: Some(self.entries[is_cap]),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &vertex_constants,
                    ..Default::default()
                },
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                front_face: front_face(key.target.mirrored),
                cull_mode: key.cull,
                unclipped_depth: self.clamps,
                ..Default::default()
            },
            depth_stencil: Some(depth_stencil(key)),
            multisample: Default::default(),
            fragment: (key.target.kind == CounterKind::Float).then_some(counts),
            multiview_mask: None,
            cache: None,
        })
    }

    fn resolve(&self, gpu: &Gpu, target: TargetKey, parity: bool) -> wgpu::RenderPipeline {
        let is_stencil = target.kind == CounterKind::Stencil;
        let groups = [Some(&self.read_counts)];
        let layout = gpu.pipeline_layout(&groups[..usize::from(!is_stencil)]);
        let dark = StencilFaceState { compare: CompareFunction::NotEqual, ..StencilFaceState::IGNORE };
        let depth_stencil = is_stencil.then(|| wgpu::DepthStencilState {
            format: target.depth_format,
            depth_write_enabled: Some(false),
            depth_compare: Some(CompareFunction::Always),
            stencil: wgpu::StencilState { front: dark, back: dark, read_mask: 0xff, write_mask: 0 },
            bias: Default::default(),
        });
        let (entry, constants) = if is_stencil {
            ("dark", &[][..])
        } else {
            ("from_floats", &[("PARITY", f64::from(u8::from(parity)))][..])
        };
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("volume visibility"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &self.resolve_module,
                entry_point: Some("fullscreen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.resolve_module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                targets: &[Some(VisibilityTarget::FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Depth and stencil tests. A surface exactly at what is seen counts as behind it.
fn depth_stencil(key: Key) -> wgpu::DepthStencilState {
    let reversed = key.target.reversed;
    let nearer = if reversed { CompareFunction::Greater } else { CompareFunction::Less };
    let not_nearer = if reversed { CompareFunction::LessEqual } else { CompareFunction::GreaterEqual };
    let is_stencil = key.target.kind == CounterKind::Stencil;
    let stencil = if is_stencil { stencil_state(key.test) } else { Default::default() };
    let depth_compare = if key.test == Test::Fail && !is_stencil { not_nearer } else { nearer };
    wgpu::DepthStencilState {
        format: key.target.depth_format,
        depth_write_enabled: Some(false),
        depth_compare: Some(depth_compare),
        stencil,
        bias: if key.part == Part::Caps { cap_bias(reversed) } else { Default::default() },
    }
}

/// A light cap coincides with the surface that casts it. A host's vertex shader may round positions
/// otherwise, which moves depth by a part of its slope over a pixel.
fn cap_bias(reversed: bool) -> wgpu::DepthBiasState {
    wgpu::DepthBiasState { constant: 0, slope_scale: if reversed { -0.25 } else { 0.25 }, clamp: 0.0 }
}

fn stencil_state(test: Test) -> wgpu::StencilState {
    let count = |pass_op, depth_fail_op| StencilFaceState {
        compare: CompareFunction::Always,
        fail_op: StencilOperation::Keep,
        depth_fail_op,
        pass_op,
    };
    let (up, down, keep) = (StencilOperation::IncrementWrap, StencilOperation::DecrementWrap, StencilOperation::Keep);
    let (front, back) = match test {
        Test::Pass => (count(up, keep), count(down, keep)),
        Test::Fail => (count(keep, down), count(keep, up)),
        Test::Parity => (count(StencilOperation::Invert, keep), count(StencilOperation::Invert, keep)),
    };
    wgpu::StencilState { front, back, read_mask: 0xff, write_mask: 0xff }
}
