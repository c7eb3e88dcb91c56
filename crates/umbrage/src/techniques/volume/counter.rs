//! Where shadows are counted: a stencil buffer or a float texture, and the depth that volumes are compared with.

use super::DEPTH_SHADER;
use super::options::CounterKind;
use super::pipelines::TargetKey;
use crate::depth_maps::Eye;
use crate::fullscreen::{UNIFORM, bind, layout, target_texture};
use crate::shader::shader_struct;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, view::View};

shader_struct! {
    /// See `depth.wgsl`.
    pub(crate) struct DepthBounds {
        eye: Eye,
        light: [f32; 3],
        range_squared: f32,
        nearest: f32,
        pad_a: f32,
        pad_b: f32,
        pad_c: f32,
    }
}

/// Targets of one size, and the pass that copies depth where it has to be copied.
pub(super) struct Counter {
    targets: Option<Targets>,
    copy: Option<Copy>,
    pub key: TargetKey,
    bounds: Option<DepthBounds>,
}

struct Targets {
    key: TargetKey,
    size: (u32, u32),
    /// The receivers' own, with what it was made of; `None` where depth is copied.
    lent: Option<wgpu::TextureView>,
    copied: Option<wgpu::TextureView>,
    counts: Option<wgpu::TextureView>,
    read_counts: Option<wgpu::BindGroup>,
    bytes: u64,
}

/// What copying depth takes.
struct Copy {
    module: wgpu::ShaderModule,
    pipeline_layout: wgpu::PipelineLayout,
    uniform: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
    pipelines: Vec<((wgpu::TextureFormat, bool), wgpu::RenderPipeline)>,
}

/// Formats for depth of our own.
const OWN_DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const OWN_DEPTH_STENCIL: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

impl Counter {
    pub fn new() -> Self {
        let key = TargetKey {
            kind: CounterKind::Float,
            depth_format: OWN_DEPTH,
            count_format: wgpu::TextureFormat::R32Float,
            reversed: true,
        };
        Self { targets: None, copy: None, key, bounds: None }
    }

    /// Makes targets where they do not fit any more. `range` asks for bounds: points beyond it count nothing.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        kind: CounterKind,
        range: Option<f64>,
        read_counts: &wgpu::BindGroupLayout,
    ) {
        let receivers = view.receivers;
        let lent = if range.is_none() { lent(receivers, kind) } else { None };
        let own = if kind == CounterKind::Stencil { OWN_DEPTH_STENCIL } else { OWN_DEPTH };
        // Whole numbers up to 2²⁴ or to 2048.
        let blends = gpu.has(wgpu::Features::FLOAT32_BLENDABLE);
        self.key = TargetKey {
            kind,
            depth_format: lent.map_or(own, |view| view.texture().format()),
            count_format: if blends { wgpu::TextureFormat::R32Float } else { wgpu::TextureFormat::R16Float },
            reversed: view.camera.background_depth() == 0.0,
        };
        let fits = |t: &Targets| t.key == self.key && t.size == receivers.size && t.lent.as_ref() == lent;
        if !self.targets.as_ref().is_some_and(fits) {
            self.targets = Some(Targets::new(gpu, self.key, receivers.size, lent, read_counts));
        }
        self.bounds = range.map(|range| bounds(view, range, self.key.reversed));
        if lent.is_none() {
            let copy = self.copy.get_or_insert_with(|| Copy::new(gpu));
            copy.prepare(gpu, self.key.depth_format, self.bounds.is_some());
        }
    }

    /// Begins counting: from `start`, with a copy of the depth where that is needed, or from what was counted before.
    pub fn begin<'p>(
        &self,
        passes: &'p mut Passes<'_>,
        receivers: &Receivers,
        start: Option<i32>,
    ) -> Option<wgpu::RenderPass<'p>> {
        let targets = self.targets.as_ref()?;
        if let (Some(copied), Some(copy), Some(_)) = (&targets.copied, &self.copy, start) {
            copy.record(passes, receivers, copied, self.key.depth_format, self.bounds.as_ref());
        }
        let (color, stencil) = match start {
            Some(start) => (
                wgpu::LoadOp::Clear(wgpu::Color { r: f64::from(start), ..wgpu::Color::TRANSPARENT }),
                wgpu::LoadOp::Clear(start.rem_euclid(256) as u32),
            ),
            None => (wgpu::LoadOp::Load, wgpu::LoadOp::Load),
        };
        let color = targets.counts.as_ref().map(|view| crate::fullscreen::attachment(view, color));
        let depth_stencil = self.attachment(Some(stencil))?;
        Some(passes.render("volumes", color.as_slice(), Some(depth_stencil)))
    }

    /// For reading what was counted.
    pub fn read_only(&self) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
        if self.key.kind == CounterKind::Stencil { self.attachment(None) } else { None }
    }

    /// The counts as a texture, where they are floats.
    pub fn read_counts(&self) -> Option<&wgpu::BindGroup> {
        self.targets.as_ref()?.read_counts.as_ref()
    }

    /// The texture of float counts.
    pub fn counts(&self) -> Option<&wgpu::TextureView> {
        self.targets.as_ref()?.counts.as_ref()
    }

    fn attachment(&self, stencil: Option<wgpu::LoadOp<u32>>) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
        let targets = self.targets.as_ref()?;
        let counts = stencil.filter(|_| self.key.kind == CounterKind::Stencil);
        Some(wgpu::RenderPassDepthStencilAttachment {
            view: targets.lent.as_ref().or(targets.copied.as_ref())?,
            depth_ops: None,
            stencil_ops: counts.map(|load| wgpu::Operations { load, store: wgpu::StoreOp::Store }),
        })
    }

    pub fn bytes(&self) -> u64 {
        self.targets.as_ref().map_or(0, |t| t.bytes)
    }
}

impl Targets {
    fn new(
        gpu: &Gpu,
        key: TargetKey,
        size: (u32, u32),
        lent: Option<&wgpu::TextureView>,
        read_counts: &wgpu::BindGroupLayout,
    ) -> Self {
        let pixels = u64::from(size.0) * u64::from(size.1);
        let view = |label, format| target_texture(gpu, label, size, 1, format).create_view(&Default::default());
        let copied = lent.is_none().then(|| view("depth for volumes", key.depth_format));
        let counts = (key.kind == CounterKind::Float).then(|| view("counts", key.count_format));
        let of = |there: bool, format: wgpu::TextureFormat| {
            // A stencil aspect has no copy size of its own with the depth: 8 bytes a pixel are what drivers take.
            if there { pixels * u64::from(format.block_copy_size(None).unwrap_or(8)) } else { 0 }
        };
        let bytes = of(copied.is_some(), key.depth_format) + of(counts.is_some(), key.count_format);
        let read = |view| bind(gpu, "counts", read_counts, &[wgpu::BindingResource::TextureView(view)]);
        let read_counts = counts.as_ref().map(read);
        Self { key, size, lent: lent.cloned(), copied, counts, read_counts, bytes }
    }
}

/// The receivers' own depth buffer where volumes can be compared with it.
fn lent(receivers: &Receivers, kind: CounterKind) -> Option<&wgpu::TextureView> {
    if let Some(both) = &receivers.stencil {
        return Some(both);
    }
    let texture = receivers.depth.texture();
    let can_attach = texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
    let is_depth_alone = texture.format().is_depth_stencil_format() && !texture.format().has_stencil_aspect();
    (kind == CounterKind::Float && can_attach && is_depth_alone).then_some(&receivers.depth)
}

fn bounds(view: &View<'_>, range: f64, reversed: bool) -> DepthBounds {
    let light = view.light.shape.center().truncate() - view.camera.eye;
    DepthBounds {
        eye: Eye::new(view),
        light: light.as_vec3().to_array(),
        // A little more, so that rounding loses no lit point.
        range_squared: (range * range * 1.0001) as f32,
        nearest: if reversed { 1.0 } else { 0.0 },
        ..DepthBounds::default()
    }
}

impl Copy {
    fn new(gpu: &Gpu) -> Self {
        let own = layout(gpu, "depth bounds", wgpu::ShaderStages::FRAGMENT, &[UNIFORM]);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = gpu.buffer("depth bounds", &[DepthBounds::default()], usage);
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&Receivers::layout(gpu)), Some(&own)],
            ..Default::default()
        });
        let bind_group = bind(gpu, "depth bounds", &own, &[uniform.as_entire_binding()]);
        Self { module: DEPTH_SHADER.module(gpu), pipeline_layout, uniform, bind_group, pipelines: Vec::new() }
    }

    fn prepare(&mut self, gpu: &Gpu, format: wgpu::TextureFormat, bounded: bool) {
        if self.pipelines.iter().any(|(key, _)| *key == (format, bounded)) {
            return;
        }
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("copy depth"),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some("fullscreen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(if bounded { "bounded_depth" } else { "copy_depth" }),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
        self.pipelines.push(((format, bounded), pipeline));
    }

    fn record(
        &self,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
        bounds: Option<&DepthBounds>,
    ) {
        let key = (format, bounds.is_some());
        let Some((_, pipeline)) = self.pipelines.iter().find(|(k, _)| *k == key) else { return };
        if let Some(bounds) = bounds {
            passes.upload(&self.uniform, bytemuck::bytes_of(bounds));
        }
        let depth_stencil = wgpu::RenderPassDepthStencilAttachment {
            view: target,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let mut pass = passes.render("depth for volumes", &[], Some(depth_stencil));
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, &self.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}
