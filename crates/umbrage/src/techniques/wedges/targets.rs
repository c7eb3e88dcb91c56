//! Buffers and textures of a light's wedges.

use super::light::WedgeLight;
use super::pipelines::Pipelines;
use crate::depth_maps::Eye;
use crate::fullscreen::{bind, target_texture};
use crate::{error::Error, gpu::Gpu, receivers::Receivers};

/// Bytes of a record, see `record.wgsl`.
const RECORD: u64 = 288;

/// Wedges that an instance draws, see `draw.wgsl`.
pub(super) const GROUP: u32 = 64;

/// What grows with casters.
pub(super) struct Buffers {
    pub light: wgpu::Buffer,
    pub eye: wgpu::Buffer,
    pub wedges: wgpu::Buffer,
    /// Arguments of the draw of all bodies.
    pub bodies: wgpu::Buffer,
    pub eye_chunks: wgpu::Buffer,
    pub eye_count: wgpu::Buffer,
    pub make: wgpu::BindGroup,
    pub count: wgpu::BindGroup,
    pub draw: wgpu::BindGroup,
}

impl Buffers {
    pub fn new(gpu: &Gpu, pipelines: &Pipelines, wedges: u32, eye_chunks: u32) -> Result<Self, Error> {
        use wgpu::BufferUsages as Usage;
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let size = u64::from(wedges.next_multiple_of(GROUP)) * RECORD;
        if size > limit {
            return Err(Error::Size { what: "the wedges of a light".into(), size, limit });
        }
        let buffer = |label, size: u64, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: usage | Usage::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let light = buffer("wedge light", size_of::<WedgeLight>() as u64, Usage::UNIFORM);
        let eye = buffer("eye", size_of::<Eye>() as u64, Usage::UNIFORM);
        // Half as much again, so that a moving camera does not make it grow all the time.
        let wedges = buffer("wedges", (size + size / 2).clamp(RECORD * 64, limit).next_multiple_of(16), Usage::STORAGE);
        let bodies = buffer("draw of wedges", 20, Usage::STORAGE | Usage::INDIRECT);
        let eye_chunks =
            buffer("chunks before the eye", u64::from(eye_chunks.next_power_of_two()).max(32) * 8, Usage::STORAGE);
        let eye_count = buffer("shadows of the eye", 8, Usage::STORAGE);
        let all = |buffers: &[&wgpu::Buffer], layout| {
            let entries: Vec<_> = buffers.iter().map(|b| b.as_entire_binding()).collect();
            bind(gpu, "wedges", layout, &entries)
        };
        Ok(Self {
            make: all(&[&light, &wedges, &bodies], &pipelines.make_layout),
            count: all(&[&light, &eye_chunks, &eye_count], &pipelines.count_layout),
            draw: all(&[&light, &eye, &wedges], &pipelines.draw_layout),
            light,
            eye,
            wedges,
            bodies,
            eye_chunks,
            eye_count,
        })
    }

    pub fn hold(&self, wedges: u32, eye_chunks: u32) -> bool {
        self.wedges.size() >= u64::from(wedges.next_multiple_of(GROUP)) * RECORD
            && self.eye_chunks.size() >= u64::from(eye_chunks) * 8
    }

    pub fn bytes(&self) -> u64 {
        [&self.light, &self.eye, &self.wedges, &self.bodies, &self.eye_chunks, &self.eye_count]
            .map(|b| b.size())
            .iter()
            .sum()
    }
}

/// Where covered shares add up.
pub(super) struct Target {
    pub size: (u32, u32),
    pub view: wgpu::TextureView,
    pub resolve: wgpu::BindGroup,
    bytes: u64,
}

impl Target {
    /// Of `format`, read together with `buffers`.
    pub fn new(gpu: &Gpu, pipelines: &Pipelines, size: (u32, u32), buffers: &Buffers) -> Self {
        let format = pipelines.format;
        let view = target_texture(gpu, "covered shares", size, 1, format).create_view(&Default::default());
        let resolve = bind(
            gpu,
            "covered shares",
            &pipelines.resolve_layout,
            &[
                buffers.light.as_entire_binding(),
                buffers.eye.as_entire_binding(),
                wgpu::BindingResource::TextureView(&view),
                buffers.eye_count.as_entire_binding(),
            ],
        );
        let pixel = u64::from(format.block_copy_size(None).unwrap_or(4));
        Self { size, view, resolve, bytes: u64::from(size.0) * u64::from(size.1) * pixel }
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
