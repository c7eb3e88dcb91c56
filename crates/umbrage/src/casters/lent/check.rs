//! Whether what a host lends can be drawn from.

use super::bounds::check_bounds;
use super::follow;
use super::instances::{LentInstances, LentMatrices};
use super::mesh::{LentIndices, LentMesh, LentShape, LentVertices};
use crate::casters::geometry;
use crate::fullscreen::{attachment, target_texture};
use crate::{error::Error, gpu::Gpu};
use umbrage_core::Mesh;
use wgpu::{BufferUsages, VertexFormat as Format};

const POSITIONS: &[Format] =
    &[Format::Float32x3, Format::Float32x4, Format::Unorm16x4, Format::Snorm16x4, Format::Float16x4];
const UVS: &[Format] = &[Format::Float32x2, Format::Unorm16x2, Format::Snorm16x2, Format::Float16x2];

/// # Errors
/// [`Error::Lent`] for buffers that are too small, were made without a usage, are of another
/// device, or can't be read in such steps or such a format; [`Error::Scene`] for a box that is not
/// finite; [`Error::Size`] beyond the device's limits.
pub(in crate::casters) fn check_mesh(gpu: &Gpu, mesh: &LentMesh<'_>) -> Result<(), Error> {
    let LentMesh { positions, uvs, indices, vertex_count, shape } = mesh;
    let is_moving = matches!(shape, LentShape::Moving(..));
    let needed = if is_moving { BufferUsages::VERTEX | BufferUsages::STORAGE } else { BufferUsages::VERTEX };
    check_vertices(gpu, "positions", positions, (*vertex_count, POSITIONS), needed)?;
    if let Some(uvs) = uvs {
        check_vertices(gpu, "texture coordinates", uvs, (*vertex_count, UVS), BufferUsages::VERTEX)?;
    }
    check_indices(indices)?;
    if *vertex_count == 0 && !indices.range.is_empty() {
        return refuse("indices are lent without vertices; lend both, or neither");
    }
    check_device(gpu, [Some(positions), uvs.as_ref()].into_iter().flatten().map(|v| &v.buffer), Some(&indices.buffer))?;
    if let Some(known) = shape.mesh() {
        check_shape(known, indices, *vertex_count)?;
        geometry::check(known)?;
    }
    if is_moving {
        follow::check(gpu, mesh)?;
    }
    if indices.range.is_empty() { Ok(()) } else { check_bounds(&shape.bounds()) }
}

/// # Errors
/// As [`check_mesh`].
pub(in crate::casters) fn check_instances(gpu: &Gpu, lent: &LentInstances) -> Result<(), Error> {
    let LentMatrices { buffer, offset, stride, form, count } = &lent.matrices;
    usages("matrices", buffer, BufferUsages::VERTEX)?;
    steps(gpu, "matrices", [*offset, *stride], form.size())?;
    room("matrices", buffer, [*offset, *stride, form.size()], *count)?;
    check_device(gpu, std::iter::once(buffer), None)?;
    if *count == 0 { Ok(()) } else { check_bounds(&lent.bounds) }
}

fn check_vertices(
    gpu: &Gpu,
    what: &str,
    vertices: &LentVertices,
    (count, formats): (u32, &[Format]),
    needed: BufferUsages,
) -> Result<(), Error> {
    let LentVertices { buffer, offset, stride, format } = vertices;
    if !formats.contains(format) {
        return refuse(format!("lent {what} are {format:?}; make them one of {formats:?}"));
    }
    usages(what, buffer, needed)?;
    steps(gpu, what, [*offset, *stride], format.size())?;
    room(what, buffer, [*offset, *stride, format.size()], count)
}

fn check_indices(indices: &LentIndices) -> Result<(), Error> {
    let LentIndices { buffer, format, range, base_vertex } = indices;
    usages("indices", buffer, BufferUsages::INDEX)?;
    if range.end < range.start || !(range.end - range.start).is_multiple_of(3) {
        return refuse(format!("lent indices {range:?} make no whole triangles; give three for each"));
    }
    if *base_vertex > i32::MAX as u32 {
        return refuse(format!("the base vertex {base_vertex} of lent indices is beyond 31 bits; lend from an offset"));
    }
    let size = format.byte_size() as u64;
    room("indices", buffer, [0, size, size], range.end)
}

/// The CPU's copy of a mesh is that of what is lent, as far as that can be told.
fn check_shape(known: &Mesh, indices: &LentIndices, vertices: u32) -> Result<(), Error> {
    let (of, lent) = (known.indices.len(), indices.range.len());
    if of != lent {
        return refuse(format!("the shape of a lent mesh has {of} indices where {lent} are lent; give the same ones"));
    }
    let end = u64::from(indices.base_vertex) + known.positions.len() as u64;
    if end > u64::from(vertices) {
        return refuse(format!(
            "the shape of a lent mesh ends at vertex {end} where {vertices} are lent; give as many as indices lead to"
        ));
    }
    Ok(())
}

fn usages(what: &str, buffer: &wgpu::Buffer, needed: BufferUsages) -> Result<(), Error> {
    let lacking = needed - buffer.usage();
    if lacking.is_empty() {
        return Ok(());
    }
    refuse(format!("the buffer of lent {what} was made without {lacking:?}; add that to its usages"))
}

fn steps(gpu: &Gpu, what: &str, [offset, stride]: [u64; 2], size: u64) -> Result<(), Error> {
    let most = u64::from(gpu.device.limits().max_vertex_buffer_array_stride);
    if !offset.is_multiple_of(4) || !stride.is_multiple_of(4) || stride < size || stride > most {
        return refuse(format!(
            "lent {what} start at byte {offset} and come every {stride} bytes; both have to be multiples of 4, and \
             the latter from {size} to {most}"
        ));
    }
    Ok(())
}

/// Room for so many elements.
fn room(what: &str, buffer: &wgpu::Buffer, [offset, stride, size]: [u64; 3], count: u32) -> Result<(), Error> {
    let last = u64::from(count).checked_sub(1);
    let end = last.map_or(Some(0), |last| stride.checked_mul(last)?.checked_add(size)?.checked_add(offset));
    let has = buffer.size();
    match end {
        Some(end) if end <= has => Ok(()),
        _ => refuse(format!("the buffer of lent {what} has {has} bytes, too few for {count} of them; lend fewer")),
    }
}

/// Only the driver knows whether a buffer is of this device.
fn check_device<'a>(
    gpu: &Gpu,
    vertices: impl Iterator<Item = &'a wgpu::Buffer>,
    indices: Option<&wgpu::Buffer>,
) -> Result<(), Error> {
    gpu.check_loss()?;
    let bind = || {
        let format = wgpu::TextureFormat::R8Unorm;
        let target = target_texture(gpu, "lent buffers", (1, 1), 1, format).create_view(&Default::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("lent buffers"),
            color_attachments: &[attachment(&target, wgpu::LoadOp::Load)],
            ..Default::default()
        });
        // Nothing is drawn from what is empty.
        let is_there = |buffer: &&wgpu::Buffer| buffer.size() > 0;
        for (slot, buffer) in (0..).zip(vertices.filter(is_there)) {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        if let Some(indices) = indices.filter(is_there) {
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        }
        drop(pass);
        // Never submitted: the driver has looked at it.
        encoder.finish()
    };
    match gpu.validated(bind) {
        Ok(_) => Ok(()),
        Err(reason) => refuse(format!(
            "a buffer that is lent can't be bound; it has to be of the same device ({})",
            reason.split_whitespace().collect::<Vec<_>>().join(" ")
        )),
    }
}

fn refuse<T>(what: impl Into<String>) -> Result<T, Error> {
    Err(Error::Lent(what.into()))
}
