//! Pictures of what happens inside: volumes, counts, overdraw, silhouettes, and which casters were
//! kept.

use super::plan::Plan;
use super::select::Selection;
use crate::casters::Edges;
use crate::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, additive, attachment, bind, layout, target_texture};
use crate::receivers::Eye;
use crate::shader::{Shader, shader_struct};
use crate::silhouettes::{Part, Silhouettes};
use crate::technique::DebugView;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, view::View};

pub(super) const VIEWS_SHADER: Shader = Shader::new("views of volumes", include_str!("views.wgsl"));

pub(super) const VIEW_BASE_SHADER: Shader =
    Shader::new("views of volumes, base", include_str!("view_base.wgsl")).with_layouts(&[ViewBase::LAYOUT]);

/// What can be asked for.
pub(super) const NAMES: &[&str] = &["volumes", "count", "overdraw", "silhouettes", "culling"];

shader_struct! {
    /// See `view_base.wgsl`.
    pub(crate) struct ViewBase {
        eye: Eye,
        scale: f32,
        pad_a: f32,
        pad_b: f32,
        pad_c: f32,
    }
}

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Whole numbers up to 2048: more layers than anybody can tell apart.
const NUMBERS: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// The number that is white in a picture of overdraw.
const MOST_OVERDRAW: f32 = 256.0;

/// One of the pictures, drawn every frame after the volumes were counted.
pub(super) struct Views {
    pub name: &'static str,
    base_layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    pipelines: Vec<(Draw, wgpu::RenderPipeline)>,
    plan: Plan,
    targets: Option<Targets>,
}

struct Targets {
    size: (u32, u32),
    color: wgpu::Texture,
    color_view: wgpu::TextureView,
    numbers_view: wgpu::TextureView,
    base: wgpu::BindGroup,
    /// The base with counts that the technique keeps.
    counts: Option<(wgpu::TextureView, wgpu::BindGroup)>,
}

/// The pipelines.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Draw {
    Base(&'static str),
    /// Sides or caps of volumes with this fragment shader.
    Volumes {
        entry: &'static str,
        caps: bool,
    },
}

impl Views {
    pub fn new(gpu: &Gpu, name: &'static str) -> Self {
        let stage = wgpu::ShaderStages::FRAGMENT;
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            name,
            base_layout: layout(gpu, "view", stage, &[UNIFORM, fullscreen::texture(FLOATS)]),
            uniform: gpu.buffer("view", &[ViewBase::default()], usage),
            pipelines: Vec::new(),
            plan: Plan::new(gpu, COLOR),
            targets: None,
        }
    }

    /// True where the picture needs counts as floats.
    pub fn needs_counts(&self) -> bool {
        self.name == "count"
    }

    /// True where the picture needs every side to have six corners.
    pub fn needs_quads(&self) -> bool {
        self.name == "silhouettes"
    }

    pub fn picture(&self) -> Option<DebugView<'_>> {
        self.targets.as_ref().map(|t| DebugView { name: self.name, texture: &t.color, layer: 0 })
    }

    /// Makes targets and pipelines.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        silhouettes: &Silhouettes,
        counts: Option<&wgpu::TextureView>,
    ) {
        let size = view.receivers.size;
        if self.targets.as_ref().is_none_or(|t| t.size != size) {
            self.targets = Some(self.targets(gpu, size));
            // Lines are as wide as pixels.
            self.pipelines.clear();
        }
        if let (Some(targets), Some(counts)) = (&mut self.targets, counts)
            && targets.counts.as_ref().is_none_or(|(view, _)| view != counts)
        {
            let bound = bind_numbers(gpu, &self.base_layout, &self.uniform, counts);
            targets.counts = Some((counts.clone(), bound));
        }
        for draw in self.draws() {
            if !self.pipelines.iter().any(|(d, _)| *d == draw) {
                let pipeline = self.pipeline(gpu, draw, silhouettes, size);
                self.pipelines.push((draw, pipeline));
            }
        }
    }

    /// Draws the picture.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        silhouettes: &Silhouettes,
        edges: Option<&Edges>,
        selection: &Selection,
    ) {
        let Some(targets) = &self.targets else { return };
        if self.name == "culling" {
            self.plan.record(gpu, passes, view, selection, &targets.color_view);
            return;
        }
        let data = ViewBase { eye: Eye::new(view), scale: MOST_OVERDRAW, ..ViewBase::default() };
        passes.upload(&self.uniform, bytemuck::bytes_of(&data));
        let edges = edges.filter(|_| !selection.throws.is_empty());
        match self.name {
            "count" => {
                let bound = targets.counts.as_ref().filter(|_| edges.is_some());
                let entry = if bound.is_some() { "numbered" } else { "scene" };
                let pass = &mut passes.render("view", &[clear(&targets.color_view)], None);
                self.fill(pass, view.receivers, entry, bound.map_or(&targets.base, |(_, b)| b));
            }
            "silhouettes" => {
                let pass = &mut passes.render("view", &[clear(&targets.color_view)], None);
                self.fill(pass, view.receivers, "scene", &targets.base);
                self.volumes(pass, silhouettes, edges, "line");
            }
            name => {
                let (count, base) = if name == "volumes" { ("tint", "volumes") } else { ("one", "heated") };
                {
                    let pass = &mut passes.render("view numbers", &[clear(&targets.numbers_view)], None);
                    self.volumes(pass, silhouettes, edges, count);
                }
                let pass = &mut passes.render("view", &[clear(&targets.color_view)], None);
                self.fill(pass, view.receivers, base, &targets.base);
            }
        }
    }

    fn fill(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        receivers: &Receivers,
        entry: &'static str,
        base: &wgpu::BindGroup,
    ) {
        let Some(pipeline) = self.find(Draw::Base(entry)) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, base, &[]);
        pass.draw(0..3, 0..1);
    }

    fn volumes(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        silhouettes: &Silhouettes,
        edges: Option<&Edges>,
        entry: &'static str,
    ) {
        let Some(edges) = edges else { return };
        let is_drawn = |part: &Part| !(silhouettes.is_empty(*part) || (entry == "line" && *part == Part::Caps));
        for part in Part::ALL.into_iter().filter(is_drawn) {
            if let Some(pipeline) = self.find(Draw::Volumes { entry, caps: part == Part::Caps }) {
                pass.set_pipeline(pipeline);
                silhouettes.draw(pass, edges, part);
            }
        }
    }

    fn find(&self, draw: Draw) -> Option<&wgpu::RenderPipeline> {
        self.pipelines.iter().find(|(d, _)| *d == draw).map(|(_, pipeline)| pipeline)
    }

    fn draws(&self) -> Vec<Draw> {
        let volumes = |entry| [false, true].map(|caps| Draw::Volumes { entry, caps });
        match self.name {
            "volumes" => [&[Draw::Base("volumes")][..], &volumes("tint")].concat(),
            "silhouettes" => vec![Draw::Base("scene"), Draw::Volumes { entry: "line", caps: false }],
            "overdraw" => [&[Draw::Base("heated")][..], &volumes("one")].concat(),
            "count" => vec![Draw::Base("scene"), Draw::Base("numbered")],
            _ => Vec::new(),
        }
    }

    fn targets(&self, gpu: &Gpu, size: (u32, u32)) -> Targets {
        let color = target_texture(gpu, "view", size, 1, COLOR);
        let numbers = target_texture(gpu, "view numbers", size, 1, NUMBERS);
        let numbers_view = numbers.create_view(&Default::default());
        let base = bind_numbers(gpu, &self.base_layout, &self.uniform, &numbers_view);
        Targets { size, color_view: color.create_view(&Default::default()), color, numbers_view, base, counts: None }
    }

    fn pipeline(&self, gpu: &Gpu, draw: Draw, silhouettes: &Silhouettes, size: (u32, u32)) -> wgpu::RenderPipeline {
        match draw {
            Draw::Base(entry) => Fullscreen {
                label: entry,
                module: &VIEW_BASE_SHADER.module(gpu),
                entry,
                groups: &[&Receivers::layout(gpu), &self.base_layout],
                target: COLOR.into(),
                constants: &[],
            }
            .pipeline(gpu),
            Draw::Volumes { entry, caps } => {
                let [side, cap] = silhouettes.entries();
                let edge = if side == "any_side" { "any_edge" } else { "listed_edge" };
                let vertex = if entry == "line" { edge } else { [side, cap][usize::from(caps)] };
                let (width, height) = size;
                let line = [("LINE_X", 1.4 / f64::from(width)), ("LINE_Y", 1.4 / f64::from(height))];
                let layout = silhouettes.pipeline_layout(gpu, if caps { Part::Caps } else { Part::PassSides });
                volume_pipeline(gpu, &layout, vertex, entry, &line)
            }
        }
    }
}

fn volume_pipeline(
    gpu: &Gpu,
    layout: &wgpu::PipelineLayout,
    vertex: &str,
    fragment: &str,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    let module = VIEWS_SHADER.module(gpu);
    let options = || wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    let target = match fragment {
        "one" => additive(NUMBERS),
        "tint" => additive(NUMBERS),
        _ => COLOR.into(),
    };
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("view of volumes"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: options(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState {
            unclipped_depth: gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL),
            ..Default::default()
        },
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn clear(view: &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    attachment(view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))
}

fn bind_numbers(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    uniform: &wgpu::Buffer,
    numbers: &wgpu::TextureView,
) -> wgpu::BindGroup {
    bind(gpu, "view", layout, &[uniform.as_entire_binding(), wgpu::BindingResource::TextureView(numbers)])
}
