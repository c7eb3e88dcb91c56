//! Pipelines and the stencil. The shadows of one plane are marked there with its number, and then
//! the plane's pixels among them lose their light.

use crate::casters::{ByForm, CasterDraw, Form, Surface};
use crate::fullscreen::target_texture;
use crate::planar::{Finder, Shadows};
use crate::receivers::Receivers;
use crate::shader::Shader;
use crate::{gpu::Gpu, visibility::VisibilityTarget};
use wgpu::{CompareFunction, StencilOperation};

pub(super) const CAST_SHADER: Shader = Shader::new("projected casters", include_str!("cast.wgsl"));

pub(super) const RESOLVE_SHADER: Shader = Shader::new("projected shadows", include_str!("resolve.wgsl"));

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Stencil8;

/// What a frame draws with.
pub(super) struct Draws {
    resolve_module: wgpu::ShaderModule,
    resolve_layout: wgpu::PipelineLayout,
    resolve: Option<(Normals, Resolve)>,
    cast: ByForm<[wgpu::RenderPipeline; 3]>,
    stencil: Option<(wgpu::TextureView, (u32, u32))>,
}

/// Which normals are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Normals {
    /// The receivers have them.
    pub are_there: bool,
    /// Places alone do not tell a plane from what touches it.
    pub are_needed: bool,
}

/// What writes visibility.
pub(super) struct Resolve {
    /// Where the stencil has the plane's number.
    pub marked: wgpu::RenderPipeline,
    /// On planes that the light shines on from behind.
    pub behind: wgpu::RenderPipeline,
}

impl Draws {
    pub fn new(gpu: &Gpu, finder: &Finder, shadows: &Shadows) -> Self {
        Self {
            resolve_module: RESOLVE_SHADER.module(gpu),
            resolve_layout: gpu.pipeline_layout(&[Some(&Receivers::layout(gpu)), Some(&finder.layout)]),
            resolve: None,
            cast: ByForm::new(cast(gpu, shadows, Form::OWN)),
            stencil: None,
        }
    }

    /// Makes what receivers of this kind and size need.
    pub fn prepare(&mut self, gpu: &Gpu, receivers: &Receivers, normals: Normals) {
        if self.resolve.as_ref().is_none_or(|(made_for, _)| *made_for != normals) {
            let of = |entries, compare, reads| {
                let how = [reads, normals.are_needed];
                self.resolving(gpu, entries, (compare, StencilOperation::Keep), how)
            };
            let marked = normals.are_there && normals.are_needed;
            let made = Resolve {
                marked: of(["around", "dark"], CompareFunction::Equal, marked),
                behind: of(["around_behind", "dark_behind"], CompareFunction::Always, normals.are_there),
            };
            self.resolve = Some((normals, made));
        }
        if self.stencil.as_ref().is_none_or(|(_, size)| *size != receivers.size) {
            let texture = target_texture(gpu, "projected shadows", receivers.size, 1, FORMAT);
            self.stencil = Some((texture.create_view(&Default::default()), receivers.size));
        }
    }

    /// What writes visibility, once prepared.
    pub fn resolve(&self) -> Option<&Resolve> {
        self.resolve.as_ref().map(|(_, resolve)| resolve)
    }

    /// What marks shadows.
    pub fn cast(&self, surface: Surface, form: &Form) -> Option<&wgpu::RenderPipeline> {
        Some(&self.cast.get(form)?[surface as usize])
    }

    /// Makes what draws casters in such buffers.
    pub fn follow(&mut self, gpu: &Gpu, shadows: &Shadows, forms: &[Form]) {
        self.cast.follow(forms, |form| cast(gpu, shadows, form));
    }

    /// The stencil, nothing of which is needed after the pass.
    pub fn attachment(&self) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Discard };
        let (view, _) = self.stencil.as_ref()?;
        Some(wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops: Some(ops) })
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.stencil.as_ref().map_or(0, |(_, (width, height))| u64::from(*width) * u64::from(*height))
    }

    fn resolving(
        &self,
        gpu: &Gpu,
        [vertex, fragment]: [&str; 2],
        stencil: (CompareFunction, StencilOperation),
        [has_normals, is_coarse]: [bool; 2],
    ) -> wgpu::RenderPipeline {
        let switch = |on: bool| f64::from(u8::from(on));
        let constants = [("HAS_NORMALS", switch(has_normals)), ("COARSE", switch(is_coarse))];
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: Some(&self.resolve_layout),
            vertex: wgpu::VertexState {
                module: &self.resolve_module,
                entry_point: Some(vertex),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: stencil_state(stencil),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.resolve_module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets: &[Some(VisibilityTarget::FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn stencil_state((compare, pass_op): (CompareFunction, StencilOperation)) -> Option<wgpu::DepthStencilState> {
    let face = wgpu::StencilFaceState { compare, pass_op, ..wgpu::StencilFaceState::IGNORE };
    // Where nothing is written, drivers test before they shade.
    let write_mask = if pass_op == StencilOperation::Keep { 0 } else { !0 };
    Some(wgpu::DepthStencilState {
        format: FORMAT,
        depth_write_enabled: None,
        depth_compare: None,
        stencil: wgpu::StencilState { front: face, back: face, read_mask: !0, write_mask },
        bias: Default::default(),
    })
}

/// In the order of [`Surface`]. Of solid casters that are wholly between plane and light the faces
/// towards the light have the whole shadow; seen from the light's side of the plane, they are wound
/// as they are seen from the light.
fn cast(gpu: &Gpu, shadows: &Shadows, form: Form) -> [wgpu::RenderPipeline; 3] {
    let module = CAST_SHADER.module(gpu);
    let target = wgpu::ColorTargetState { write_mask: wgpu::ColorWrites::empty(), ..VisibilityTarget::FORMAT.into() };
    let pipeline = |vertex: &str, fragment, cull_mode| {
        CasterDraw {
            label: "projected casters",
            form,
            view: &shadows.layout,
            textured: vertex == "masked",
            more: None,
            module: &module,
            vertex,
            fragment: Some(fragment),
            constants: &[],
            targets: &[Some(target.clone())],
            depth_stencil: stencil_state((CompareFunction::Always, StencilOperation::Replace)),
            cull_mode,
        }
        .pipeline(gpu)
    };
    [
        pipeline("opaque", "whole", Some(wgpu::Face::Back)),
        pipeline("opaque", "above", None),
        pipeline("masked", "cut_out", None),
    ]
}
