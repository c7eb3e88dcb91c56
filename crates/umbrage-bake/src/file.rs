//! Transfers and unfinished bakes as bytes.

use crate::Key;
use crate::wire::{Reader, Writer};
use crate::work::State;
use umbrage_core::Mesh;
use umbrage_core::harmonics::Order;
use umbrage_core::transfer::{BakedMesh, Cluster, Codes, Kind, Points, Sides, Stored, Transfer};

const TRANSFER: &[u8; 16] = b"umbrage baked 1\n";
const UNFINISHED: &[u8; 16] = b"umbrage begun 1\n";

pub(crate) fn encoded(key: Key, transfer: &Transfer) -> Vec<u8> {
    let mut to = Writer::default();
    to.raw(TRANSFER);
    to.raw(&key.value().to_le_bytes());
    to.len(transfer.order.bands());
    let (kind, bounces) = match transfer.kind {
        Kind::Unshadowed => (0, 0),
        Kind::Shadowed => (1, 0),
        Kind::Interreflected { bounces } => (2, bounces),
    };
    to.u64(kind);
    to.u64(bounces.into());
    to.len(transfer.meshes.len());
    transfer.meshes.iter().for_each(|mesh| write_mesh(&mut to, mesh));
    to.finished()
}

/// The other way; `None` for bytes that are damaged, of another version or another key.
pub(crate) fn decoded(key: Key, bytes: &[u8]) -> Option<Transfer> {
    let mut from = begun(TRANSFER, key, bytes)?;
    let order = Order::new(u32::try_from(from.u64()?).ok()?).ok()?;
    let kind = match (from.u64()?, u32::try_from(from.u64()?).ok()?) {
        (0, _) => Kind::Unshadowed,
        (1, _) => Kind::Shadowed,
        (2, bounces) => Kind::Interreflected { bounces },
        _ => return None,
    };
    let count = from.len()?;
    let meshes = (0..count).map(|_| read_mesh(&mut from)).collect::<Option<Vec<_>>>()?;
    let transfer = Transfer { order, kind, meshes };
    (from.is_empty() && transfer.is_whole()).then_some(transfer)
}

pub(crate) fn encoded_state(key: Key, state: &State) -> Vec<u8> {
    let mut to = Writer::default();
    to.raw(UNFINISHED);
    to.raw(&key.value().to_le_bytes());
    to.u64(state.passes.into());
    to.len(state.points);
    to.words(&state.before);
    to.words(&state.present);
    to.words(&state.sum);
    to.finished()
}

pub(crate) fn decoded_state(key: Key, bytes: &[u8]) -> Option<State> {
    let mut from = begun(UNFINISHED, key, bytes)?;
    let (passes, points) = (u32::try_from(from.u64()?).ok()?, from.len()?);
    let state = State { passes, points, before: from.words()?, present: from.words()?, sum: from.words()? };
    from.is_empty().then_some(state)
}

fn begun<'a>(magic: &[u8; 16], key: Key, bytes: &'a [u8]) -> Option<Reader<'a>> {
    let mut from = Reader::new(bytes)?;
    let is_right = from.raw(16)? == magic && from.raw(16)? == key.value().to_le_bytes();
    is_right.then_some(from)
}

fn write_mesh(to: &mut Writer, baked: &BakedMesh) {
    to.len(baked.instance);
    to.bytes(baked.mesh.name.as_bytes());
    to.words(&baked.mesh.positions);
    to.words(&baked.mesh.normals);
    to.words(&baked.mesh.uvs);
    to.words(&baked.mesh.opacities);
    to.words(&baked.mesh.indices);
    to.len(baked.sides.count());
    to.len(baked.channels);
    match &baked.points {
        Points::Vertices => to.u64(0),
        Points::Texels { width, height, uvs } => {
            to.u64(1);
            to.words(&[*width, *height]);
            to.words(uvs);
        }
    }
    write_stored(to, &baked.stored);
}

fn read_mesh(from: &mut Reader<'_>) -> Option<BakedMesh> {
    let instance = from.len()?;
    let mesh = Mesh {
        name: String::from_utf8(from.bytes()?.to_vec()).ok()?,
        positions: from.words()?,
        normals: from.words()?,
        uvs: from.words()?,
        opacities: from.words()?,
        indices: from.words()?,
        ..Mesh::default()
    };
    let sides = match from.u64()? {
        1 => Sides::Front,
        2 => Sides::Both,
        _ => return None,
    };
    let channels = from.len()?;
    let points = match from.u64()? {
        0 => Points::Vertices,
        1 => {
            let size: Vec<u32> = from.words()?;
            let [width, height] = size[..] else { return None };
            Points::Texels { width, height, uvs: from.words()? }
        }
        _ => return None,
    };
    Some(BakedMesh { instance, mesh, points, sides, channels, stored: read_stored(from)? })
}

fn write_stored(to: &mut Writer, stored: &Stored) {
    match stored {
        Stored::Full(values) => {
            to.u64(0);
            to.words(values);
        }
        Stored::Bytes { bias, scale, bytes } => {
            to.u64(1);
            to.words(bias);
            to.words(scale);
            to.bytes(bytes);
        }
        Stored::Clustered { clusters, codes } => {
            to.u64(2);
            to.len(clusters.len());
            for cluster in clusters {
                to.words(&cluster.mean);
                to.words(&cluster.vectors);
            }
            to.words(&codes.cluster.iter().map(|&k| u32::from(k)).collect::<Vec<_>>());
            to.len(codes.vectors);
            to.words(&codes.weights);
        }
    }
}

fn read_stored(from: &mut Reader<'_>) -> Option<Stored> {
    Some(match from.u64()? {
        0 => Stored::Full(from.words()?),
        1 => Stored::Bytes { bias: from.words()?, scale: from.words()?, bytes: from.bytes()?.to_vec() },
        2 => {
            let count = from.len()?;
            let cluster = |from: &mut Reader<'_>| Some(Cluster { mean: from.words()?, vectors: from.words()? });
            let clusters = (0..count).map(|_| cluster(from)).collect::<Option<Vec<_>>>()?;
            let numbers: Vec<u32> = from.words()?;
            let cluster = numbers.into_iter().map(|k| u16::try_from(k).ok()).collect::<Option<Vec<_>>>()?;
            Stored::Clustered { clusters, codes: Codes { cluster, vectors: from.len()?, weights: from.words()? } }
        }
        _ => return None,
    })
}
