//! Pictures of what happens inside: bodies, penumbras, overdraw, and what wedges add to the hard
//! shadow.

use super::pipelines::{Key, Resolve, clamps_depth};
use super::records::GROUP;
use super::shaders;
use super::stages::compare;
use super::targets::{BUNDLES, Buffers, SINGLES, lent_depth};
use crate::fullscreen::{
    FLOATS, Fullscreen, UNIFORM, additive, attachment, bind, front_face, layout, target_texture, texture,
};
use crate::receivers::Eye;
use crate::technique::DebugView;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, view::View, visibility::VisibilityTarget};

/// What can be asked for.
pub(super) const NAMES: &[&str] = &["wireframe", "wedges", "penumbra", "overdraw", "fragments", "correction", "pieces"];

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Of the six corners of a body the ends of its edges, and nothing thrice, so that arguments of the
/// draw of bodies hold for lines, too.
const LINES: [u16; 24] = [0, 1, 0, 2, 0, 3, 1, 4, 1, 5, 2, 3, 4, 5, 2, 4, 3, 5, 0, 0, 0, 0, 0, 0];

/// Vertex shaders of bodies and where the arguments of their draws are.
const ONE_BY_ONE: &[(&str, u64)] = &[("body", 0)];
const AS_DRAWN: &[(&str, u64)] = &[("single_body", SINGLES), ("bundle_body", BUNDLES)];

/// One of the pictures, drawn every frame after visibility.
pub(super) struct Views {
    gpu: Gpu,
    name: &'static str,
    layout: wgpu::BindGroupLayout,
    eye: wgpu::Buffer,
    lines: wgpu::Buffer,
    base: Option<(bool, wgpu::RenderPipeline)>,
    /// With where the arguments of their draws are.
    bodies: Option<(Key, Vec<(wgpu::RenderPipeline, u64)>)>,
    /// Shares of each piece of the light.
    mosaic: Option<(Resolve, wgpu::RenderPipeline)>,
    targets: Option<Targets>,
}

struct Targets {
    size: (u32, u32),
    color: wgpu::Texture,
    color_view: wgpu::TextureView,
    numbers: wgpu::TextureView,
}

/// The wedges of a frame.
pub(super) struct Drawn<'a> {
    /// Of every piece of the light.
    pub pieces: Vec<&'a Buffers>,
    pub indices: &'a wgpu::Buffer,
    /// Of bodies.
    pub key: Key,
    /// Wedges that lie close together are drawn as one.
    pub bundles: bool,
    pub tables: &'a wgpu::BindGroup,
    /// Of group 1.
    pub layout: &'a wgpu::BindGroupLayout,
    /// Shares of all pieces, as resolving reads them.
    pub shares: (Resolve, &'a wgpu::BindGroup, &'a wgpu::BindGroupLayout),
}

impl Views {
    /// `None` for names that there are not.
    pub fn new(gpu: &Gpu, name: &str) -> Option<Self> {
        let name = NAMES.iter().find(|n| **n == name)?;
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let lines: Vec<u16> = (0..GROUP as u16).flat_map(|i| LINES.map(|corner| i * 6 + corner)).collect();
        let bindings = [UNIFORM, texture(FLOATS), texture(FLOATS)];
        Some(Self {
            name,
            layout: layout(gpu, "view", wgpu::ShaderStages::FRAGMENT, &bindings),
            eye: gpu.buffer("eye", &[Eye::default()], usage),
            lines: gpu.buffer("lines of wedges", &lines, wgpu::BufferUsages::INDEX),
            base: None,
            bodies: None,
            mosaic: None,
            targets: None,
            gpu: gpu.clone(),
        })
    }

    pub fn picture(&self) -> Option<DebugView<'_>> {
        self.targets.as_ref().map(|t| DebugView { name: self.name, texture: &t.color, layer: 0 })
    }

    /// Draws the picture; without wedges that of none.
    pub fn record(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        drawn: Option<&Drawn<'_>>,
    ) {
        self.make_ready(view.receivers, drawn);
        if let (Some(targets), Some(drawn), Some((_, mosaic))) = (&self.targets, drawn, &self.mosaic) {
            let pass = &mut passes.render("view", &[clear(&targets.color_view)], None);
            pass.set_pipeline(mosaic);
            pass.set_bind_group(0, &view.receivers.bind_group, &[]);
            pass.set_bind_group(1, drawn.shares.1, &[]);
            pass.set_bind_group(2, drawn.tables, &[]);
            pass.draw(0..3, 0..1);
            return;
        }
        let (Some(targets), Some((_, base))) = (&self.targets, &self.base) else { return };
        passes.upload(&self.eye, bytemuck::bytes_of(&Eye::new(view)));
        let bodies = drawn.zip(self.bodies.as_ref().map(|(_, pipelines)| pipelines));
        {
            let depth = self.depth_compare(true).and_then(|_| lent_depth(view.receivers));
            let depth =
                depth.map(|view| wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops: None });
            let pass = &mut passes.render("view numbers", &[clear(&targets.numbers)], depth);
            if let Some((drawn, pipelines)) = bodies {
                let indices = if self.name == "wireframe" { &self.lines } else { drawn.indices };
                for (pipeline, arguments) in pipelines {
                    drawn.draw(pass, view.receivers, pipeline, *arguments, indices);
                }
            }
        }
        let resources = [
            self.eye.as_entire_binding(),
            wgpu::BindingResource::TextureView(&targets.numbers),
            wgpu::BindingResource::TextureView(&visibility.view),
        ];
        let numbers = bind(&self.gpu, "view", &self.layout, &resources);
        let pass = &mut passes.render("view", &[clear(&targets.color_view)], None);
        pass.set_pipeline(base);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, &numbers, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Lines are seen through everything, bodies where they are in front of what is seen, and all
    /// else is drawn as shadows are.
    fn depth_compare(&self, reversed: bool) -> Option<wgpu::CompareFunction> {
        let clamps = clamps_depth(&self.gpu);
        match self.name {
            "wireframe" => None,
            "wedges" => Some(compare(clamps, !reversed)),
            _ => Some(compare(clamps, reversed)),
        }
    }

    fn make_ready(&mut self, receivers: &Receivers, drawn: Option<&Drawn<'_>>) {
        if self.targets.as_ref().is_none_or(|t| t.size != receivers.size) {
            let color = target_texture(&self.gpu, "view", receivers.size, 1, COLOR);
            let numbers = target_texture(&self.gpu, "view numbers", receivers.size, 1, self.format());
            let [color_view, numbers] = [&color, &numbers].map(|t| t.create_view(&Default::default()));
            self.targets = Some(Targets { size: receivers.size, color_view, color, numbers });
        }
        let has_normals = receivers.has_normals;
        if self.base.as_ref().is_none_or(|(has, _)| *has != has_normals) {
            let made = Fullscreen {
                label: self.name,
                module: &shaders::VIEWS.module(&self.gpu),
                entry: self.name,
                groups: &[&Receivers::layout(&self.gpu), &self.layout],
                target: COLOR.into(),
                constants: &[("HAS_NORMALS", f64::from(u8::from(has_normals)))],
            };
            self.base = Some((has_normals, made.pipeline(&self.gpu)));
        }
        if let Some(drawn) = drawn.filter(|_| self.name == "pieces") {
            self.prepare_mosaic(drawn);
        } else if let Some(drawn) = drawn.filter(|d| self.bodies.as_ref().is_none_or(|(key, _)| *key != d.key)) {
            let draws = if drawn.bundles && self.name == "fragments" { AS_DRAWN } else { ONE_BY_ONE };
            let made = draws.iter().map(|(vertex, arguments)| (self.bodies(drawn, vertex), *arguments));
            self.bodies = Some((drawn.key, made.collect()));
        }
    }

    fn prepare_mosaic(&mut self, drawn: &Drawn<'_>) {
        let (key, _, layout) = drawn.shares;
        if self.mosaic.as_ref().is_none_or(|(of, _)| *of != key) {
            let made = Fullscreen {
                label: "pieces of the light",
                module: &key.term.resolve_shader().module(&self.gpu),
                entry: "mosaic",
                groups: &[&Receivers::layout(&self.gpu), layout, &key.term.layout(&self.gpu)],
                target: COLOR.into(),
                constants: &[("PIECES", f64::from(key.pieces))],
            };
            self.mosaic = Some((key, made.pipeline(&self.gpu)));
        }
    }

    /// Of numbers, which add up.
    fn format(&self) -> wgpu::TextureFormat {
        let blends = self.gpu.has(wgpu::Features::FLOAT32_BLENDABLE);
        if blends { wgpu::TextureFormat::Rg32Float } else { wgpu::TextureFormat::Rg16Float }
    }

    /// The fragment shader of bodies.
    fn entry(&self) -> &'static str {
        match self.name {
            "wireframe" => "line",
            "wedges" => "tint",
            "penumbra" => "crossing",
            "correction" => "add_wedge",
            "fragments" => "fragment",
            _ => "count",
        }
    }

    fn bodies(&self, drawn: &Drawn<'_>, vertex: &str) -> wgpu::RenderPipeline {
        let (gpu, key, entry) = (&self.gpu, drawn.key, self.entry());
        let shader = if entry == "add_wedge" { key.term.draw_shader() } else { shaders::VIEW_BODIES };
        let module = &shader.module(gpu);
        let (of_receivers, of_term) = (Receivers::layout(gpu), key.term.layout(gpu));
        let groups = [Some(&of_receivers), Some(drawn.layout), Some(&of_term)];
        let clamps = clamps_depth(gpu);
        let face = [("FACE", f64::from(key.face as u32)), ("SPLIT", f64::from(u8::from(key.split)))];
        let constants = match entry {
            "add_wedge" => &face[..],
            "crossing" => &face[..1],
            _ => &[],
        };
        let (is_lines, has_sides) = (entry == "line", matches!(entry, "line" | "tint"));
        let depth = key.depth.and_then(|(format, reversed)| Some((format, self.depth_compare(reversed)?)));
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("view of wedges"),
            layout: Some(&gpu.pipeline_layout(&groups)),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(vertex),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &[("CLAMPS", f64::from(u8::from(clamps)))],
                    ..Default::default()
                },
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: if is_lines { wgpu::PrimitiveTopology::LineList } else { Default::default() },
                front_face: front_face(key.mirrored),
                cull_mode: (!has_sides).then_some(wgpu::Face::Front),
                unclipped_depth: clamps,
                ..Default::default()
            },
            depth_stencil: depth.map(|(format, depth_compare)| wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(false),
                depth_compare: Some(depth_compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                targets: &[Some(additive(self.format()))],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

impl Drawn<'_> {
    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        receivers: &Receivers,
        pipeline: &wgpu::RenderPipeline,
        arguments: u64,
        indices: &wgpu::Buffer,
    ) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(2, self.tables, &[]);
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint16);
        for piece in &self.pieces {
            pass.set_bind_group(1, &piece.draw, &[]);
            pass.draw_indexed_indirect(&piece.bodies, arguments);
        }
    }
}

fn clear(view: &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    attachment(view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))
}
