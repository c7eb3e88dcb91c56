//! Transfer as attributes of vertices in a binary glTF.

use super::numbers_of;
use glam::{DAffine3, Vec3};
use serde_json::{Value, json};
use umbrage_core::Scene;
use umbrage_core::transfer::{BakedMesh, Points, Transfer};

/// The name of an attribute with four numbers of a point's vector, but for its number.
pub(super) const FRONT: &str = "_TRANSFER_";

/// The same of the back.
pub(super) const BACK: &str = "_TRANSFER_BACK_";

/// glTF's numbers for 32-bit floats and integers.
const FLOAT: u32 = 5126;
const UINT: u32 = 5125;

pub(super) fn bytes(transfer: &Transfer, scene: &Scene) -> Result<Vec<u8>, String> {
    if transfer.meshes.iter().any(|mesh| mesh.points != Points::Vertices) {
        return Err("can't hold the transfer of texels, since glTF has attributes at vertices".into());
    }
    let mut file = File::default();
    let (mut meshes, mut nodes) = (Vec::new(), Vec::new());
    for (number, baked) in transfer.meshes.iter().enumerate() {
        meshes.push(file.mesh(baked, transfer));
        let place = scene.instances.get(baked.instance).map_or(DAffine3::IDENTITY, |i| i.world_from_mesh);
        nodes.push(json!({ "mesh": number, "matrix": glam::DMat4::from(place).to_cols_array() }));
    }
    let [kind, bounces] = numbers_of(transfer.kind);
    let all: Vec<usize> = (0..nodes.len()).collect();
    let json = json!({
        "asset": {
            "version": "2.0",
            "generator": "umbrage",
            "extras": { "umbrageTransfer": { "order": transfer.order.bands(), "kind": kind, "bounces": bounces } },
        },
        "scene": 0,
        "scenes": [{ "nodes": all }],
        "nodes": nodes,
        "meshes": meshes,
        "accessors": file.accessors,
        "bufferViews": file.views,
        "buffers": [{ "byteLength": file.binary.len() }],
    });
    whole(&json.to_string(), &file.binary)
}

/// Header, JSON and numbers, each a multiple of four bytes long.
fn whole(json: &str, binary: &[u8]) -> Result<Vec<u8>, String> {
    let json_len = json.len().next_multiple_of(4);
    let all = 12 + 8 + json_len + 8 + binary.len();
    let length = |n: usize| u32::try_from(n).map(u32::to_le_bytes).map_err(|_| "would be over 4 GiB long".to_string());
    let mut bytes = Vec::with_capacity(all);
    bytes.extend(b"glTF\x02\0\0\0");
    bytes.extend(length(all)?);
    bytes.extend(length(json_len)?);
    bytes.extend(b"JSON");
    bytes.extend(json.as_bytes());
    bytes.resize(20 + json_len, b' ');
    bytes.extend(length(binary.len())?);
    bytes.extend(b"BIN\0");
    bytes.extend(binary);
    Ok(bytes)
}

#[derive(Default)]
struct File {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    fn mesh(&mut self, baked: &BakedMesh, transfer: &Transfer) -> Value {
        let mesh = &baked.mesh;
        let mut attributes = json!({
            "POSITION": self.positions(&mesh.positions),
            "NORMAL": self.add(bytemuck::cast_slice(&mesh.normals), FLOAT, "VEC3", mesh.normals.len()),
        });
        if !mesh.uvs.is_empty() {
            attributes["TEXCOORD_0"] = self.add(bytemuck::cast_slice(&mesh.uvs), FLOAT, "VEC2", mesh.uvs.len()).into();
        }
        let (vertices, len) = (mesh.positions.len(), baked.vector_len(transfer.order));
        let mut vector = vec![0.0; len];
        for (side, name) in [FRONT, BACK].into_iter().enumerate().take(baked.sides.count()) {
            let mut groups = vec![Vec::with_capacity(4 * vertices); len.div_ceil(4)];
            for vertex in 0..vertices {
                baked.stored.read(side * vertices + vertex, &mut vector);
                for (group, numbers) in groups.iter_mut().zip(vector.chunks(4)) {
                    let mut four = [0.0_f32; 4];
                    four[..numbers.len()].copy_from_slice(numbers);
                    group.extend(four);
                }
            }
            for (k, group) in groups.iter().enumerate() {
                let number = self.add(bytemuck::cast_slice(group), FLOAT, "VEC4", vertices);
                attributes[format!("{name}{k}")] = number.into();
            }
        }
        let indices = self.add(bytemuck::cast_slice(&mesh.indices), UINT, "SCALAR", mesh.indices.len());
        json!({
            "primitives": [{ "attributes": attributes, "indices": indices }],
            "extras": { "umbrageTransfer": { "channels": baked.channels, "instance": baked.instance } },
        })
    }

    /// Positions alone have to say where they end.
    fn positions(&mut self, positions: &[Vec3]) -> usize {
        let number = self.add(bytemuck::cast_slice(positions), FLOAT, "VEC3", positions.len());
        let least = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let most = positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        self.accessors[number]["min"] = json!(least.to_array());
        self.accessors[number]["max"] = json!(most.to_array());
        number
    }

    fn add(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize) -> usize {
        let view = self.views.len();
        self.views.push(json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() }));
        self.binary.extend(bytes);
        let accessor = json!({ "bufferView": view, "componentType": component, "type": shape, "count": count });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}
