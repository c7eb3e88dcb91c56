//! Where shadows are counted: a stencil buffer or a float texture, and the depth that volumes are
//! compared with.

use super::depth::{DepthBounds, DepthCopy, Projection};
use super::options::CounterKind;
use super::pipelines::TargetKey;
use crate::fullscreen::{bind, target_texture};
use crate::{
    gpu::Gpu,
    passes::{Pass, Passes},
    receivers::Receivers,
    view::View,
};

/// Targets of one size, and the pass that copies depth where it has to be copied.
pub(super) struct Counter {
    targets: Option<Targets>,
    copy: Option<DepthCopy>,
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
            mirrored: false,
        };
        Self { targets: None, copy: None, key, bounds: None }
    }

    /// Makes targets where they do not fit any more. `range` asks for bounds: points beyond it
    /// count nothing. `own`: volumes are not drawn with the camera's projection but with this one.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        kind: CounterKind,
        range: Option<f64>,
        own: Option<&Projection>,
        read_counts: &wgpu::BindGroupLayout,
    ) {
        let receivers = view.receivers;
        let is_kept = range.is_none() && own.is_none();
        let lent = if is_kept { lent(receivers, kind) } else { None };
        let reversed = own.is_some() || view.camera.background_depth() == 0.0;
        self.bounds = (!is_kept).then(|| DepthBounds::new(view, range, own, reversed));
        let own_format = if kind == CounterKind::Stencil { OWN_DEPTH_STENCIL } else { OWN_DEPTH };
        // Whole numbers up to 2²⁴ or to 2048.
        let blends = gpu.has(wgpu::Features::FLOAT32_BLENDABLE);
        self.key = TargetKey {
            kind,
            depth_format: lent.map_or(own_format, |view| view.texture().format()),
            count_format: if blends { wgpu::TextureFormat::R32Float } else { wgpu::TextureFormat::R16Float },
            reversed,
            mirrored: view.camera.is_mirrored(),
        };
        let fits = |t: &Targets| t.key == self.key && t.size == receivers.size && t.lent.as_ref() == lent;
        if !self.targets.as_ref().is_some_and(fits) {
            self.targets = Some(Targets::new(gpu, self.key, receivers.size, lent, read_counts));
        }
        if lent.is_none() {
            let copy = self.copy.get_or_insert_with(|| DepthCopy::new(gpu));
            copy.prepare(gpu, self.key.depth_format, self.bounds.is_some());
        }
    }

    /// Begins counting: from `start`, with a copy of the depth where that is needed, or from what
    /// was counted before.
    pub fn begin<'p>(&self, passes: &'p mut Passes<'_>, receivers: &Receivers, start: Option<i32>) -> Option<Pass<'p>> {
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

    /// Bytes of a count in floats; 0 where the stencil counts.
    pub fn blended_bytes(&self) -> u64 {
        let counts = self.counts().map(|view| view.texture().format());
        counts.and_then(|format| format.block_copy_size(None)).map_or(0, u64::from)
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
            // A stencil aspect has no copy size of its own with the depth: 8 bytes a pixel are what
            // drivers take.
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
