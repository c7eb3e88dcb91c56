//! Transfer out of a binary glTF's attributes.

use super::glb::{BACK, FRONT};
use super::{kind_of, order_of};
use bytemuck::Pod;
use glam::{Vec2, Vec3};
use gltf::accessor::{Accessor, DataType, Dimensions};
use gltf::{Document, Semantic};
use serde_json::Value;
use umbrage_core::Mesh;
use umbrage_core::transfer::{BakedMesh, Points, Sides, Stored, Transfer};

const NONE: &str = "has no transfer in it that this program has written";

/// Of a file that was looked over.
pub(super) fn read(file: &Document, blob: &[u8]) -> Result<Transfer, String> {
    let about = about(file.as_json().asset.extras.as_deref())?;
    let order = order_of(number(&about, "order")?)?;
    let kind = kind_of([number(&about, "kind")?, number(&about, "bounces")?]).ok_or(NONE)?;
    let meshes = file.meshes().map(|mesh| read_mesh(&mesh, blob, order.functions()));
    Ok(Transfer { order, kind, meshes: meshes.collect::<Result<_, _>>()? })
}

fn about(extras: Option<&gltf::json::extras::RawValue>) -> Result<Value, String> {
    let extras = extras.ok_or(NONE)?;
    let value: Value = serde_json::from_str(extras.get()).map_err(|_| NONE)?;
    value.get("umbrageTransfer").cloned().ok_or_else(|| NONE.into())
}

fn number(about: &Value, name: &str) -> Result<u32, String> {
    let number = about.get(name).and_then(Value::as_u64).and_then(|n| u32::try_from(n).ok());
    number.ok_or_else(|| format!("does not say its `{name}`"))
}

fn read_mesh(mesh: &gltf::Mesh<'_>, blob: &[u8], n: usize) -> Result<BakedMesh, String> {
    let about = about(mesh.extras().as_deref())?;
    let (channels, instance) = (number(&about, "channels")? as usize, number(&about, "instance")? as usize);
    let primitive = mesh.primitives().next().ok_or(NONE)?;
    let floats = |semantic: &Semantic, count: Dimensions| match primitive.get(semantic) {
        Some(accessor) => floats(&accessor, count, blob).map(Some),
        None => Ok(None),
    };
    let triples = |numbers: Vec<f32>| numbers.as_chunks::<3>().0.iter().map(|v| Vec3::from_array(*v)).collect();
    let pairs = |numbers: Vec<f32>| numbers.as_chunks::<2>().0.iter().map(|v| Vec2::from_array(*v)).collect();
    let positions: Vec<Vec3> = floats(&Semantic::Positions, Dimensions::Vec3)?.map(triples).ok_or(NONE)?;
    let indices = primitive.indices().ok_or(NONE)?;
    let whole = Mesh {
        normals: floats(&Semantic::Normals, Dimensions::Vec3)?.map(triples).unwrap_or_default(),
        uvs: floats(&Semantic::TexCoords(0), Dimensions::Vec2)?.map(pairs).unwrap_or_default(),
        indices: numbers(&indices, DataType::U32, Dimensions::Scalar, blob)?,
        positions,
        ..Mesh::default()
    };
    let (vertices, len) = (whole.positions.len(), channels.saturating_mul(n));
    let mut values = Vec::new();
    let mut sides = 0;
    for name in [FRONT, BACK] {
        let group = |k: usize| floats(&Semantic::Extras(format!("{name}{k}")[1..].into()), Dimensions::Vec4);
        if group(0)?.is_none() {
            break;
        }
        let groups = (0..len.div_ceil(4)).map(|k| group(k)?.ok_or_else(|| format!("lacks the attribute {name}{k}")));
        let groups = groups.collect::<Result<Vec<_>, String>>()?;
        if groups.iter().any(|group| group.len() != 4 * vertices) {
            return Err("has attributes of different lengths".into());
        }
        values.extend(
            (0..vertices).flat_map(|v| (0..len).map(move |i| (v, i))).map(|(v, i)| groups[i / 4][4 * v + i % 4]),
        );
        sides += 1;
    }
    let sides = if sides == 2 { Sides::Both } else { Sides::Front };
    Ok(BakedMesh { instance, mesh: whole, points: Points::Vertices, sides, channels, stored: Stored::Full(values) })
}

fn floats(accessor: &Accessor<'_>, dimensions: Dimensions, blob: &[u8]) -> Result<Vec<f32>, String> {
    numbers(accessor, DataType::F32, dimensions, blob)
}

/// All numbers of an accessor that is as this program writes them, one after the other.
fn numbers<T: Pod>(accessor: &Accessor<'_>, of: DataType, as_: Dimensions, blob: &[u8]) -> Result<Vec<T>, String> {
    let wrong = || format!("has an accessor {} that is not as this program writes them", accessor.index());
    let view =
        accessor.view().filter(|view| view.stride().is_none() && accessor.sparse().is_none()).ok_or_else(wrong)?;
    if accessor.data_type() != of || accessor.dimensions() != as_ {
        return Err(wrong());
    }
    let from = view.offset().saturating_add(accessor.offset());
    let bytes = accessor.count().saturating_mul(as_.multiplicity()).saturating_mul(4);
    let bytes = blob.get(from..from.saturating_add(bytes)).ok_or_else(wrong)?;
    Ok(bytemuck::pod_collect_to_vec(bytes))
}
