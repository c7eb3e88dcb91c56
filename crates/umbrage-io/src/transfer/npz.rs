//! Transfer as arrays.

use super::{kind_of, numbers_of, order_of};
use crate::error::{Error, Place};
use crate::npz::{Arrays, NewArrays};
use glam::{Vec2, Vec3};
use std::io;
use std::path::Path;
use umbrage_core::Mesh;
use umbrage_core::transfer::{BakedMesh, Cluster, Codes, Points, Sides, Stored, Transfer};

/// Changes where arrays mean something else.
const VERSION: u32 = 1;

pub(super) fn bytes(transfer: &Transfer) -> io::Result<Vec<u8>> {
    let mut arrays = NewArrays::default();
    let [kind, bounces] = numbers_of(transfer.kind);
    let order = transfer.order.bands() as u32;
    let about = [VERSION, order, kind, bounces, transfer.meshes.len() as u32];
    arrays.add("about", &[about.len()], &about)?;
    for (number, mesh) in transfer.meshes.iter().enumerate() {
        add_mesh(&mut arrays, &format!("mesh{number}_"), mesh, transfer)?;
    }
    arrays.finished()
}

fn add_mesh(to: &mut NewArrays, name: &str, baked: &BakedMesh, transfer: &Transfer) -> io::Result<()> {
    let name = |array: &str| format!("{name}{array}");
    let mesh = &baked.mesh;
    let about = [baked.instance as u32, baked.sides.count() as u32, baked.channels as u32];
    to.add(&name("about"), &[about.len()], &about)?;
    to.add(&name("positions"), &[mesh.positions.len(), 3], flat3(&mesh.positions))?;
    to.add(&name("normals"), &[mesh.normals.len(), 3], flat3(&mesh.normals))?;
    to.add(&name("uvs"), &[mesh.uvs.len(), 2], flat2(&mesh.uvs))?;
    to.add(&name("indices"), &[mesh.indices.len() / 3, 3], &mesh.indices)?;
    if let Points::Texels { width, height, uvs } = &baked.points {
        to.add(&name("atlas_size"), &[2], &[*width, *height])?;
        to.add(&name("atlas_uvs"), &[uvs.len(), 2], flat2(uvs))?;
    }
    let (n, channels) = (transfer.order.functions(), baked.channels);
    let points = baked.point_count();
    match &baked.stored {
        Stored::Full(values) => to.add(&name("coefficients"), &[points, channels, n], values),
        Stored::Bytes { bias, scale, bytes } => {
            to.add(&name("bias"), &[channels, n], bias)?;
            to.add(&name("scale"), &[channels, n], scale)?;
            to.add(&name("bytes"), &[points, channels, n], bytes)
        }
        Stored::Clustered { clusters, codes } => {
            let means: Vec<f32> = clusters.iter().flat_map(|c| c.mean.iter().copied()).collect();
            let vectors: Vec<f32> = clusters.iter().flat_map(|c| c.vectors.iter().copied()).collect();
            to.add(&name("means"), &[clusters.len(), channels, n], &means)?;
            to.add(&name("vectors"), &[clusters.len(), codes.vectors, channels, n], &vectors)?;
            to.add(&name("cluster"), &[points], &codes.cluster)?;
            to.add(&name("weights"), &[points, codes.vectors], &codes.weights)
        }
    }
}

pub(super) fn read(path: &Path) -> Result<Transfer, Error> {
    let mut arrays = Arrays::open(path)?;
    let wrong = |what: String| Error::new(path, what).at(Place::Part("array `about`".into()));
    let [version, order, kind, bounces, count] = array(&mut arrays, "about")?;
    if version != VERSION {
        return Err(wrong(format!("is of version {version}; this program reads {VERSION}")));
    }
    let order = order_of(order).map_err(wrong)?;
    let kind =
        kind_of([kind, bounces]).ok_or_else(|| wrong(format!("has the kind {kind}, which is none of 0 to 2")))?;
    let n = order.functions();
    let meshes = (0..count).map(|number| read_mesh(&mut arrays, &format!("mesh{number}_"), n));
    Ok(Transfer { order, kind, meshes: meshes.collect::<Result<_, _>>()? })
}

fn read_mesh(from: &mut Arrays<'_>, name: &str, n: usize) -> Result<BakedMesh, Error> {
    let name = |array: &str| format!("{name}{array}");
    let [instance, sides, channels] = array(from, &name("about"))?;
    let mesh = Mesh {
        positions: triples(from, &name("positions"))?,
        normals: triples(from, &name("normals"))?,
        uvs: pairs(from, &name("uvs"))?,
        indices: from.shaped(&name("indices"))?.1,
        ..Mesh::default()
    };
    let points = if from.has(&name("atlas_size")) {
        let [width, height] = array(from, &name("atlas_size"))?;
        Points::Texels { width, height, uvs: pairs(from, &name("atlas_uvs"))? }
    } else {
        Points::Vertices
    };
    let sides = if sides == 2 { Sides::Both } else { Sides::Front };
    let (instance, channels) = (instance as usize, channels as usize);
    let stored = read_stored(from, &name, channels.saturating_mul(n))?;
    Ok(BakedMesh { instance, mesh, points, sides, channels, stored })
}

fn read_stored(from: &mut Arrays<'_>, name: &dyn Fn(&str) -> String, len: usize) -> Result<Stored, Error> {
    if from.has(&name("coefficients")) {
        return Ok(Stored::Full(from.shaped(&name("coefficients"))?.1));
    }
    if from.has(&name("bytes")) {
        let (bias, scale) = (from.shaped(&name("bias"))?.1, from.shaped(&name("scale"))?.1);
        return Ok(Stored::Bytes { bias, scale, bytes: from.shaped(&name("bytes"))?.1 });
    }
    let means: Vec<f32> = from.shaped(&name("means"))?.1;
    let (shape, vectors) = from.shaped::<f32>(&name("vectors"))?;
    let count = shape.get(1).map_or(0, |n| *n as usize);
    let each = count.saturating_mul(len);
    let clusters = means.chunks_exact(len.max(1)).enumerate().map(|(k, mean)| {
        let from = k.saturating_mul(each);
        Cluster {
            mean: mean.to_vec(),
            vectors: vectors.get(from..from.saturating_add(each)).unwrap_or_default().to_vec(),
        }
    });
    let clusters = clusters.collect();
    let codes =
        Codes { cluster: from.shaped(&name("cluster"))?.1, vectors: count, weights: from.shaped(&name("weights"))?.1 };
    Ok(Stored::Clustered { clusters, codes })
}

fn array<const N: usize>(from: &mut Arrays<'_>, name: &str) -> Result<[u32; N], Error> {
    let mut array = [0; N];
    array.copy_from_slice(&from.values::<u32>(name, &[N as u64])?);
    Ok(array)
}

fn triples(from: &mut Arrays<'_>, name: &str) -> Result<Vec<Vec3>, Error> {
    let numbers: Vec<f32> = from.shaped(name)?.1;
    Ok(numbers.as_chunks::<3>().0.iter().map(|v| Vec3::from_array(*v)).collect())
}

fn pairs(from: &mut Arrays<'_>, name: &str) -> Result<Vec<Vec2>, Error> {
    let numbers: Vec<f32> = from.shaped(name)?.1;
    Ok(numbers.as_chunks::<2>().0.iter().map(|v| Vec2::from_array(*v)).collect())
}

fn flat3(vectors: &[Vec3]) -> &[f32] {
    bytemuck::cast_slice(vectors)
}

fn flat2(vectors: &[Vec2]) -> &[f32] {
    bytemuck::cast_slice(vectors)
}
