//! The passes that render a layer of a map.

use super::cache::Work;
use super::layer::Layer;
use super::layouts::Layouts;
use super::textures::{FORMAT, Textures};
use crate::casters::{ByForm, CasterDraw, CasterView, Casters, Form, InstanceNumbers, Surface};
use crate::shader::Shader;
use crate::{gpu::Gpu, passes::Passes};

/// Nearest surface, opaque and alpha-masked.
const DEPTH_SHADER: Shader = Shader::new("shadow map", "// needs: map_depth, map_paraboloid");

/// Second surface.
const SECOND_SHADER: Shader = Shader::new("second surface", include_str!("map_second.wgsl"));

/// Mean of the two.
const MIDPOINT_SHADER: Shader = Shader::new("midpoint", include_str!("map_midpoint.wgsl"));

/// All of them.
pub(in crate::depth_maps) const SHADERS: [Shader; 3] = [DEPTH_SHADER, SECOND_SHADER, MIDPOINT_SHADER];

/// What pipelines are made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub perspective: bool,
    pub paraboloid: bool,
    /// Of a perspective view: depth falls linearly with the distance.
    pub linear: bool,
}

/// Pipelines of all kinds that came up, and layouts.
pub(super) struct Pipelines {
    cull_mode: Option<wgpu::Face>,
    nearest: wgpu::ShaderModule,
    /// For `faces = midpoint`: second surface and mean.
    second: Option<[wgpu::ShaderModule; 2]>,
    layouts: Layouts,
    made: Vec<(Kind, Set)>,
}

/// Pipelines of one kind.
struct Set {
    /// For solid, open and alpha-masked casters.
    nearest: ByForm<[wgpu::RenderPipeline; 3]>,
    second: Option<SecondPipelines>,
}

/// For `faces = midpoint`.
struct SecondPipelines {
    /// For opaque and alpha-masked casters.
    surface: ByForm<[wgpu::RenderPipeline; 2]>,
    midpoint: wgpu::RenderPipeline,
}

/// Entry points: of vertices, of fragments that give the nearest surface, of those that give the
/// second.
type Entries = [(&'static str, Option<&'static str>, &'static str); 2];

impl Kind {
    /// For opaque and for alpha-masked casters. Fragment shaders that write depth forgo early depth
    /// tests, so a map that is what the rasteriser makes of a matrix does without.
    fn entries(self) -> Entries {
        match (self.paraboloid, self.linear) {
            (true, _) => [
                ("opaque_bent", Some("written_bent"), "second_bent"),
                ("masked_bent", Some("written_bent_cut_out"), "second_bent_cut_out"),
            ],
            (false, true) => {
                [("opaque", Some("written"), "second"), ("masked", Some("written_cut_out"), "second_cut_out")]
            }
            (false, false) => [("opaque", None, "second"), ("masked", Some("cut_out"), "second_cut_out")],
        }
    }
}

impl Pipelines {
    pub(super) fn new(gpu: &Gpu, back_faces: bool, midpoint: bool) -> Self {
        Self {
            cull_mode: back_faces.then_some(wgpu::Face::Front),
            nearest: DEPTH_SHADER.module(gpu),
            second: midpoint.then(|| [SECOND_SHADER.module(gpu), MIDPOINT_SHADER.module(gpu)]),
            layouts: Layouts::new(gpu),
            made: Vec::new(),
        }
    }

    /// Makes what views of this kind need for such buffers.
    pub(super) fn prepare(&mut self, gpu: &Gpu, kind: Kind, forms: &[Form]) {
        let mut made = std::mem::take(&mut self.made);
        let at = made.iter().position(|(k, _)| *k == kind).unwrap_or_else(|| {
            made.push((kind, self.make(gpu, kind)));
            made.len() - 1
        });
        let set = &mut made[at].1;
        set.nearest.follow(forms, |form| self.nearest(gpu, kind, form));
        if let Some(second) = &mut set.second {
            second.surface.follow(forms, |form| self.second(gpu, kind, form));
        }
        self.made = made;
    }

    fn set(&self, kind: Kind) -> Option<&Set> {
        self.made.iter().find(|(k, _)| *k == kind).map(|(_, set)| set)
    }

    fn make(&self, gpu: &Gpu, kind: Kind) -> Set {
        let second = self.second.as_ref().map(|[_, mean]| SecondPipelines {
            surface: ByForm::new(self.second(gpu, kind, Form::OWN)),
            midpoint: midpoint_pipeline(gpu, mean, &self.layouts.two_maps, kind),
        });
        Set { nearest: ByForm::new(self.nearest(gpu, kind, Form::OWN)), second }
    }

    /// What draws the nearest surface.
    fn nearest(&self, gpu: &Gpu, kind: Kind, form: Form) -> [wgpu::RenderPipeline; 3] {
        let [opaque, masked] = kind.entries().map(|(vertex, nearest, _)| (vertex, nearest));
        let (both, front) = (self.cull_mode, self.cull_mode.or(Some(wgpu::Face::Back)));
        [(opaque, front), (opaque, both), (masked, both)].map(|((vertex, fragment), cull_mode)| {
            self.draw(kind, form, (&self.nearest, vertex, fragment), (None, cull_mode)).pipeline(gpu)
        })
    }

    /// What draws the second one, for opaque and alpha-masked casters.
    fn second(&self, gpu: &Gpu, kind: Kind, form: Form) -> [wgpu::RenderPipeline; 2] {
        let module = self.second.as_ref().map_or(&self.nearest, |[second, _]| second);
        let more = (Some(&self.layouts.one_map), self.cull_mode);
        let of = |(vertex, _, fragment)| self.draw(kind, form, (module, vertex, Some(fragment)), more).pipeline(gpu);
        kind.entries().map(of)
    }

    fn draw<'a>(
        &'a self,
        kind: Kind,
        form: Form,
        (module, vertex, fragment): (&'a wgpu::ShaderModule, &'a str, Option<&'a str>),
        (more, cull_mode): (Option<&'a wgpu::BindGroupLayout>, Option<wgpu::Face>),
    ) -> CasterDraw<'a> {
        let linear: &[_] = if kind.linear { &[("LINEAR", 1.0)] } else { &[("LINEAR", 0.0)] };
        CasterDraw {
            label: fragment.unwrap_or(vertex),
            form,
            view: &self.layouts.view,
            textured: vertex.starts_with("masked"),
            more,
            module,
            vertex,
            fragment,
            // A constant that no entry point uses is none of the module's.
            constants: if fragment == Some("cut_out") { &[] } else { linear },
            targets: &[],
            depth_stencil: depth_state(wgpu::CompareFunction::Greater),
            cull_mode,
        }
    }

    /// Renders one layer; returns how often the casters of its list were drawn.
    pub(super) fn record(
        &self,
        passes: &mut Passes<'_>,
        casters: &Casters,
        (numbers, layer): (&InstanceNumbers, &Layer),
        textures: &Textures,
        view: &CasterView<'_>,
        kind: Kind,
    ) -> u32 {
        let Some(set) = self.set(kind).filter(|_| layer.work != Work::Keep) else { return 0 };
        let i = view.light_view.layer as usize;
        let views = &textures.layers[i];
        let view_uniform = &textures.uniforms[i].1;
        let draw = |passes: &mut Passes<'_>, label, list, attachment, is_all: bool| {
            let mut pass = passes.render(label, &[], attachment);
            pass.set_bind_group(0, view_uniform, &[]);
            numbers.draw(&mut pass, casters, list, false, |surface, _, form| {
                Some(&set.nearest.get(form)?[surface as usize])
            });
            if is_all && casters.has_host_casters() {
                pass.set_bind_group(0, view_uniform, &[]);
                casters.draw_host_casters(&mut pass, view);
            }
        };
        if let (Work::Over { rest }, Some(store)) = (layer.work, textures.stored(i)) {
            if rest {
                draw(passes, "casters at rest", &layer.rest, clear(store), true);
            }
            textures.take_stored(passes.encoder(), i);
            if layer.list.draws() > 0 {
                draw(passes, "map", &layer.list, over(&views.first), false);
            }
            return 1;
        }
        draw(passes, "map", &layer.list, clear(&views.first), true);
        let (Some(second), Some(pipelines)) = (&views.second, &set.second) else { return 1 };
        {
            let mut pass = passes.render("second surface", &[], clear(&second.second));
            pass.set_bind_group(0, view_uniform, &[]);
            pass.set_bind_group(3, &second.read_first, &[]);
            numbers.draw(&mut pass, casters, &layer.list, true, |surface, _, form| {
                Some(&pipelines.surface.get(form)?[usize::from(surface == Surface::Masked)])
            });
        }
        let mut pass = passes.render("midpoint", &[], clear(&second.midpoint));
        pass.set_pipeline(&pipelines.midpoint);
        pass.set_bind_group(0, &second.read_both, &[]);
        pass.draw(0..3, 0..1);
        2
    }

    pub(super) fn layouts(&self) -> &Layouts {
        &self.layouts
    }
}

/// An attachment cleared to "nothing there": depth 0, infinitely far.
fn clear(view: &wgpu::TextureView) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
    attachment(view, wgpu::LoadOp::Clear(0.0))
}

/// An attachment that keeps what is there.
fn over(view: &wgpu::TextureView) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
    attachment(view, wgpu::LoadOp::Load)
}

fn attachment(view: &wgpu::TextureView, load: wgpu::LoadOp<f32>) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
    let depth_ops = Some(wgpu::Operations { load, store: wgpu::StoreOp::Store });
    Some(wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None })
}

fn midpoint_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    maps: &wgpu::BindGroupLayout,
    kind: Kind,
) -> wgpu::RenderPipeline {
    let is_harmonic = kind.perspective && !kind.linear;
    let constants = [("HARMONIC", if is_harmonic { 1.0 } else { 0.0 })];
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("midpoint"),
        layout: Some(&gpu.pipeline_layout(&[Some(maps)])),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("fullscreen"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: depth_state(wgpu::CompareFunction::Always),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("midpoint"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn depth_state(compare: wgpu::CompareFunction) -> Option<wgpu::DepthStencilState> {
    Some(wgpu::DepthStencilState {
        format: FORMAT,
        depth_write_enabled: Some(true),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    })
}
