//! A baked scene on the GPU.

use super::fits::Fits;
use super::pipelines::{Pipelines, PrtMesh, PrtPart, SENT_BYTES};
use super::upload::{Upload, blocks, is_turned, points_per_part};
use crate::fullscreen::bind;
use crate::{Error, Gpu};
use std::ops::Range;
use umbrage_core::Scene;
use umbrage_core::glam::DAffine3;
use umbrage_core::transfer::{Transfer, Wanted};

/// What is drawn of a transfer, and what it is summed of.
pub(super) struct Baked {
    pub meshes: Vec<Mesh>,
    pub fits: Fits,
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    /// What vertices send out: a colour for the front and one for the back of each.
    pub radiance: wgpu::Buffer,
    /// [`PrtMesh`] for each.
    pub table: wgpu::Buffer,
    pub lights: wgpu::Buffer,
    pub parts: Vec<Part>,
    pub channels: usize,
    pub point_count: usize,
    pub bytes: u64,
}

/// A mesh of the bake.
pub(super) struct Mesh {
    /// Number of the instance, in the scene and among the casters.
    pub instance: usize,
    /// Where it stood.
    pub world_from_mesh: DAffine3,
    pub indices: Range<u32>,
    /// Its normals are on the back of its triangles.
    pub is_turned: bool,
}

/// Points whose vectors are in one buffer.
pub(super) struct Part {
    pub count: u32,
    pub bind_group: wgpu::BindGroup,
}

impl Baked {
    /// # Errors
    /// A transfer that is not of `scene` or not as `wanted`; [`Error::Size`] beyond the limits.
    pub fn new(
        gpu: &Gpu,
        pipelines: &Pipelines,
        wanted: &Wanted,
        transfer: &Transfer,
        scene: &Scene,
    ) -> Result<Self, Error> {
        if (transfer.order, transfer.kind) != (wanted.order, wanted.kind) {
            return Err(Error::Scene(format!(
                "`prt` is set to order {} and {:?}, but the transfer has order {} and {:?}; bake what `Technique::wants` tells",
                wanted.order.bands(),
                wanted.kind,
                transfer.order.bands(),
                transfer.kind
            )));
        }
        if let Some(mesh) = transfer.meshes.iter().find(|mesh| mesh.instance >= scene.instances.len()) {
            let (instance, count) = (mesh.instance, scene.instances.len());
            return Err(Error::Scene(format!(
                "the transfer is of instance {instance}, and the scene has {count}, counted from 0; bake this scene"
            )));
        }
        let upload = Upload::new(transfer)?;
        let functions = transfer.order.functions() as u64;
        let sizes = [
            ("the transfer's vertices", 28 * upload.vertices.len() as u64),
            ("the transfer's triangles", 4 * upload.indices.len() as u64),
            ("what the transfer's vertices send out", SENT_BYTES * upload.vertices.len() as u64),
            ("the light of the transfer's meshes", 16 * functions * transfer.meshes.len() as u64),
        ];
        sizes.into_iter().try_for_each(|(what, size)| check(gpu, what, size))?;
        Ok(Self::made(gpu, pipelines, transfer, scene, upload))
    }

    fn made(gpu: &Gpu, pipelines: &Pipelines, transfer: &Transfer, scene: &Scene, upload: Upload) -> Self {
        use wgpu::BufferUsages as Usage;
        let (functions, channels) = (transfer.order.functions(), transfer.kind.channels());
        let room = |label: &str, usage, bytes: usize| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes.max(16) as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        let changing = Usage::STORAGE | Usage::COPY_DST;
        let radiance =
            room("sent radiance", Usage::STORAGE | Usage::VERTEX, SENT_BYTES as usize * upload.vertices.len());
        let table = room("baked meshes", changing, size_of::<PrtMesh>() * transfer.meshes.len());
        let lights = room("light of meshes", changing, 16 * functions * transfer.meshes.len());
        let per_part = points_per_part(gpu, functions * channels);
        let part = |(number, points): (usize, &[_])| {
            let first = number * per_part;
            let part = PrtPart { count: points.len() as u32, functions: functions as u32, ..PrtPart::default() };
            let vectors = blocks(transfer, first..first + points.len());
            let buffers = [
                &gpu.buffer("part of a transfer", &[part], Usage::UNIFORM),
                &gpu.buffer("transfer", &vectors, Usage::STORAGE),
                &gpu.buffer("points", points, Usage::STORAGE),
                &table,
                &lights,
                &radiance,
            ];
            let entries = buffers.map(|buffer| buffer.as_entire_binding());
            Part { count: part.count, bind_group: bind(gpu, "part of a transfer", &pipelines.sum_layout, &entries) }
        };
        let parts = upload.points.chunks(per_part).enumerate().map(part).collect();
        let vertices = gpu.buffer("baked vertices", &upload.vertices, Usage::VERTEX);
        let indices = gpu.buffer("baked triangles", &upload.indices, Usage::INDEX);
        let own = [&vertices, &indices, &radiance, &table, &lights].map(wgpu::Buffer::size).iter().sum::<u64>();
        let mesh = |(mesh, indices): (&umbrage_core::transfer::BakedMesh, Range<u32>)| Mesh {
            instance: mesh.instance,
            world_from_mesh: scene.instances[mesh.instance].world_from_mesh,
            indices,
            is_turned: is_turned(mesh),
        };
        Self {
            meshes: transfer.meshes.iter().zip(upload.ranges).map(mesh).collect(),
            fits: Fits::new(transfer, scene.instances.len()),
            bytes: own + upload.points.len() as u64 * (8 + 4 * (functions * channels) as u64),
            point_count: upload.points.len(),
            vertices,
            indices,
            radiance,
            table,
            lights,
            parts,
            channels,
        }
    }
}

/// That a buffer of so many bytes can be made and bound.
fn check(gpu: &Gpu, what: &str, size: u64) -> Result<(), Error> {
    let limits = gpu.device.limits();
    let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
    if size > limit { Err(Error::Size { what: what.into(), size, limit }) } else { Ok(()) }
}
