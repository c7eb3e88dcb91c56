//! Pipelines and the stencil. The pixels of a plane lose their light where casters fall: at once,
//! or where the stencil has been marked with the plane's number.

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
    /// In the order of [`Way`].
    cast: ByForm<[[wgpu::RenderPipeline; 3]; 2]>,
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

/// How pixels lose their light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Each fragment of a caster's shadow asks whether its pixel is in the plane.
    AtOnce,
    /// Fragments mark the stencil, and each marked pixel is asked once.
    Marked,
}

impl Way {
    const ALL: [Self; 2] = [Self::AtOnce, Self::Marked];
}

/// What writes visibility where no caster is drawn.
pub(super) struct Resolve {
    /// Where the stencil has the plane's number.
    pub marked: wgpu::RenderPipeline,
    /// On planes that the light shines on from behind, in the order of [`Way`].
    behind: [wgpu::RenderPipeline; 2],
}

impl Resolve {
    /// Planes that the light shines on from behind.
    pub fn behind(&self, way: Way) -> &wgpu::RenderPipeline {
        &self.behind[way as usize]
    }
}

impl Draws {
    pub fn new(gpu: &Gpu, finder: &Finder, shadows: &Shadows) -> Self {
        Self {
            resolve_module: RESOLVE_SHADER.module(gpu),
            resolve_layout: gpu.pipeline_layout(&[Some(&Receivers::layout(gpu)), Some(&finder.layout)]),
            resolve: None,
            cast: ByForm::new(Way::ALL.map(|way| cast(gpu, shadows, way, Form::OWN))),
            stencil: None,
        }
    }

    /// Makes what receivers of this kind and size need, and the stencil where it is marked.
    pub fn prepare(&mut self, gpu: &Gpu, receivers: &Receivers, normals: Normals, way: Way) {
        if self.resolve.as_ref().is_none_or(|(made_for, _)| *made_for != normals) {
            let Normals { are_there, are_needed } = normals;
            let switches = [are_there && are_needed, are_needed, are_there];
            let keep = |compare| stencil_state(compare, StencilOperation::Keep);
            let of = |entries, depth_stencil| self.resolving(gpu, entries, depth_stencil, switches);
            let behind = ["around_behind", "dark_behind"];
            let made = Resolve {
                marked: of(["around", "dark"], keep(CompareFunction::Equal)),
                behind: [of(behind, None), of(behind, keep(CompareFunction::Always))],
            };
            self.resolve = Some((normals, made));
        }
        if way == Way::Marked && self.stencil.as_ref().is_none_or(|(_, size)| *size != receivers.size) {
            let texture = target_texture(gpu, "projected shadows", receivers.size, 1, FORMAT);
            self.stencil = Some((texture.create_view(&Default::default()), receivers.size));
        }
    }

    /// What writes visibility, once prepared.
    pub fn resolve(&self) -> Option<&Resolve> {
        self.resolve.as_ref().map(|(_, resolve)| resolve)
    }

    /// What draws casters.
    pub fn cast(&self, way: Way, surface: Surface, form: &Form) -> Option<&wgpu::RenderPipeline> {
        Some(&self.cast.get(form)?[way as usize][surface as usize])
    }

    /// Makes what draws casters in such buffers.
    pub fn follow(&mut self, gpu: &Gpu, shadows: &Shadows, forms: &[Form]) {
        self.cast.follow(forms, |form| Way::ALL.map(|way| cast(gpu, shadows, way, form)));
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
        depth_stencil: Option<wgpu::DepthStencilState>,
        switches: [bool; 3],
    ) -> wgpu::RenderPipeline {
        let names = ["HAS_NORMALS", "COARSE", "KNOWS_CASTERS"];
        let [a, b, c] = switches.map(|on| f64::from(u8::from(on)));
        let constants = [(names[0], a), (names[1], b), (names[2], c)];
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
            depth_stencil,
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

fn stencil_state(compare: CompareFunction, pass_op: StencilOperation) -> Option<wgpu::DepthStencilState> {
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
fn cast(gpu: &Gpu, shadows: &Shadows, way: Way, form: Form) -> [wgpu::RenderPipeline; 3] {
    let module = CAST_SHADER.module(gpu);
    let write_mask = if way == Way::Marked { wgpu::ColorWrites::empty() } else { wgpu::ColorWrites::ALL };
    let target = wgpu::ColorTargetState { write_mask, ..VisibilityTarget::FORMAT.into() };
    let depth_stencil = match way {
        Way::AtOnce => None,
        Way::Marked => stencil_state(CompareFunction::Always, StencilOperation::Replace),
    };
    let pipeline = |vertex: &str, [at_once, marked]: [_; 2], cull_mode| {
        CasterDraw {
            label: "projected casters",
            form,
            view: &shadows.layout,
            textured: vertex == "masked",
            more: None,
            module: &module,
            vertex,
            fragment: Some(if way == Way::Marked { marked } else { at_once }),
            constants: &[],
            targets: &[Some(target.clone())],
            depth_stencil: depth_stencil.clone(),
            cull_mode,
        }
        .pipeline(gpu)
    };
    [
        pipeline("opaque", ["whole_at_once", "whole"], Some(wgpu::Face::Back)),
        pipeline("opaque", ["above_at_once", "above"], None),
        pipeline("masked", ["cut_out_at_once", "cut_out"], None),
    ]
}
