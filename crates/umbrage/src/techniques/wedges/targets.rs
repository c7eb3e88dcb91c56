//! Buffers and textures of a light's wedges.

use super::pipelines::Pipelines;
use super::records::{BUNDLE, BUNDLE_RECORD, CAPS, GROUP, Needs, RECORD};
use crate::area_light::{AreaLight, scaled};
use crate::fullscreen::{bind, target_texture};
use crate::receivers::Eye;
use crate::{error::Error, gpu::Gpu, passes::Passes, receivers::Receivers, view::View};

/// Where in [`Buffers::bodies`] the arguments of the draws of single wedges and of bundles are.
pub(super) const SINGLES: u64 = 20;
pub(super) const BUNDLES: u64 = 40;
/// And those of the sides of hard shadows.
pub(super) const SIDES: u64 = 60;

/// Bytes that tell which triangles a chunk of caps has, see `caps.wgsl`.
const CHUNK_BYTES: u64 = 8;

/// What grows with casters, of one piece of a light.
pub(super) struct Buffers {
    pub light: wgpu::Buffer,
    pub eye: wgpu::Buffer,
    pub wedges: wgpu::Buffer,
    /// Arguments of the draws of all bodies, of single ones, of bundles and of sides.
    pub bodies: wgpu::Buffer,
    bundles: wgpu::Buffer,
    pub singles: wgpu::Buffer,
    pub cap_chunks: wgpu::Buffer,
    pub caps: wgpu::Buffer,
    pub make: wgpu::BindGroup,
    pub bundle: wgpu::BindGroup,
    pub make_caps: wgpu::BindGroup,
    pub draw: wgpu::BindGroup,
    pub depth: wgpu::BindGroup,
}

impl Buffers {
    pub fn new(gpu: &Gpu, pipelines: &Pipelines, needs: &Needs) -> Result<Self, Error> {
        use wgpu::BufferUsages as Usage;
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let size = u64::from(needs.wedges.next_multiple_of(GROUP)) * RECORD;
        if size > limit {
            let what = "the wedges of a light, all at once (the default settings draw them in rounds)";
            return Err(Error::Size { what: what.into(), size, limit });
        }
        let caps_size = u64::from(needs.caps) * CAPS;
        if caps_size > limit {
            let what = "the casters around the eye, all at once (the default settings draw them in rounds)";
            return Err(Error::Size { what: what.into(), size: caps_size, limit });
        }
        let buffer = |label, size: u64, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: usage | Usage::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let light = buffer("wedge light", size_of::<AreaLight>() as u64, Usage::UNIFORM);
        let eye = buffer("eye", size_of::<Eye>() as u64, Usage::UNIFORM);
        // Half as much again, so that a moving camera does not make it grow all the time.
        let wedges = buffer("wedges", (size + size / 2).clamp(RECORD * 64, limit).next_multiple_of(16), Usage::STORAGE);
        let room = wedges.size() / RECORD;
        let bodies = buffer("draws of wedges", 80, Usage::STORAGE | Usage::INDIRECT);
        let bundles = buffer("bundles", (room / BUNDLE).max(1) * BUNDLE_RECORD, Usage::STORAGE);
        let singles = buffer("single wedges", 4 * (2 + room), Usage::STORAGE);
        let some = |label, bytes: u64| {
            let size = u64::from(needs.caps.max(1).next_power_of_two()) * bytes;
            buffer(label, size.min(limit / bytes * bytes), Usage::STORAGE)
        };
        let (cap_chunks, caps) = (some("chunks of caps", CHUNK_BYTES), some("caps", CAPS));
        let all = |buffers: &[&wgpu::Buffer], layout| {
            let entries: Vec<_> = buffers.iter().map(|b| b.as_entire_binding()).collect();
            bind(gpu, "wedges", layout, &entries)
        };
        Ok(Self {
            make: all(&[&light, &wedges, &bodies], &pipelines.make_layout),
            make_caps: all(&[&light, &cap_chunks, &caps], &pipelines.caps_layout),
            bundle: all(&[&light, &wedges, &bodies, &bundles, &singles], &pipelines.bundle_layout),
            draw: all(&[&light, &eye, &wedges, &caps, &bundles, &singles], &pipelines.draw_layout),
            depth: all(&[&light], &pipelines.depth_layout),
            light,
            eye,
            wedges,
            bodies,
            bundles,
            singles,
            cap_chunks,
            caps,
        })
    }

    pub fn hold(&self, needs: &Needs) -> bool {
        self.wedges.size() >= u64::from(needs.wedges.next_multiple_of(GROUP)) * RECORD
            && self.cap_chunks.size() >= u64::from(needs.caps) * CHUNK_BYTES
            && self.caps.size() >= u64::from(needs.caps) * CAPS
    }

    pub fn bytes(&self) -> u64 {
        let small = [&self.light, &self.eye, &self.bodies, &self.cap_chunks];
        small.into_iter().chain([&self.wedges, &self.caps, &self.bundles, &self.singles]).map(|b| b.size()).sum()
    }
}

/// What resolving reads of a light as a whole.
pub(super) struct Whole {
    pub light: wgpu::Buffer,
    pub eye: wgpu::Buffer,
    /// Of each piece, see `Piece::record`.
    pub pieces: wgpu::Buffer,
}

impl Whole {
    pub fn new(gpu: &Gpu) -> Self {
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            light: gpu.buffer("light", &[AreaLight::default()], uniform),
            eye: gpu.buffer("eye", &[Eye::default()], uniform),
            pieces: gpu.buffer("pieces of the light", &[[0_f32; 4]; MOST_PIECES], uniform),
        }
    }
}

/// Pieces of a light at most.
pub(super) const MOST_PIECES: usize = 9;

/// What a [`Target`] is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TargetKey {
    /// Of the picture.
    pub size: (u32, u32),
    pub scale: u32,
    pub pieces: u32,
    /// Of a copy of the receivers' depth, where theirs can't be drawn against.
    pub own_depth: Option<wgpu::TextureFormat>,
}

/// Where covered shares add up.
pub(super) struct Target {
    pub key: TargetKey,
    /// Of each piece.
    pub layers: Vec<wgpu::TextureView>,
    pub resolve: wgpu::BindGroup,
    /// The receivers' depth at this scale.
    pub own_depth: Option<wgpu::TextureView>,
    bytes: u64,
}

impl Target {
    /// Read together with `whole`.
    pub fn new(gpu: &Gpu, pipelines: &Pipelines, key: TargetKey, whole: &Whole) -> Self {
        let size = scaled(key.size, key.scale);
        let texture = target_texture(gpu, "covered shares", size, key.pieces, pipelines.format);
        let layer = |i| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: i,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let all = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let resolve = bind(
            gpu,
            "covered shares",
            &pipelines.resolve_layout,
            &[
                whole.light.as_entire_binding(),
                whole.eye.as_entire_binding(),
                wgpu::BindingResource::TextureView(&all),
                whole.pieces.as_entire_binding(),
            ],
        );
        let pixels = u64::from(size.0) * u64::from(size.1);
        // A stencil aspect has no copy size of its own with the depth: 8 bytes a pixel are what
        // drivers take.
        let bytes_of = |format: wgpu::TextureFormat| pixels * u64::from(format.block_copy_size(None).unwrap_or(8));
        let depth = |format| target_texture(gpu, "depth of wedges", size, 1, format).create_view(&Default::default());
        let shares = u64::from(key.pieces) * bytes_of(pipelines.format);
        Self {
            layers: (0..key.pieces).map(layer).collect(),
            resolve,
            own_depth: key.own_depth.map(depth),
            bytes: shares + key.own_depth.map_or(0, bytes_of),
            key,
        }
    }

    /// What bodies are compared with, where there is something.
    pub fn depth<'a>(&'a self, view: &View<'a>) -> Option<&'a wgpu::TextureView> {
        self.own_depth.as_ref().or_else(|| lent_depth(view.receivers))
    }

    /// Makes its own depth, if it has one; gives the number of draws.
    pub fn copy_depth(
        &self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        pipelines: &Pipelines,
        buffers: &Buffers,
    ) -> u32 {
        let Some(depth) = &self.own_depth else { return 0 };
        let Some(pipeline) = pipelines.depth(depth.texture().format()) else { return 0 };
        let has_stencil = depth.texture().format().has_stencil_aspect();
        let attachment = wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: has_stencil
                .then_some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Discard }),
        };
        let mut pass = passes.render("depth of wedges", &[], Some(attachment));
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, &buffers.depth, &[]);
        pass.draw(0..3, 0..1);
        1
    }

    pub fn size(&self) -> (u32, u32) {
        scaled(self.key.size, self.key.scale)
    }

    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// The receivers' own depth buffer where wedges can be compared with it.
pub(super) fn lent_depth(receivers: &Receivers) -> Option<&wgpu::TextureView> {
    if let Some(both) = &receivers.stencil {
        return Some(both);
    }
    let texture = receivers.depth.texture();
    let can_attach = texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
    let is_depth_alone = texture.format().is_depth_stencil_format() && !texture.format().has_stencil_aspect();
    (can_attach && is_depth_alone).then_some(&receivers.depth)
}
