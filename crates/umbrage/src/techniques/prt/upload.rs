//! What the GPU keeps of a baked scene: its meshes as one, and the vectors of its points.

use super::pipelines::{BLOCK, PrtPoint, Vertex};
use crate::{Error, Gpu};
use std::ops::Range;
use umbrage_core::glam::Vec3;
use umbrage_core::transfer::{BakedMesh, Points, Transfer};

/// Points of a part are a multiple of this: bindings begin at multiples of 256 bytes.
const GRAIN: usize = 4096;

/// Groups of threads that one dispatch has at most.
const MOST_GROUPS: usize = 65_535;

/// All meshes of a transfer, one after the other.
pub(super) struct Upload {
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    pub points: Vec<PrtPoint>,
    /// Of each mesh, its indices.
    pub ranges: Vec<Range<u32>>,
}

impl Upload {
    /// # Errors
    /// [`Error::Scene`] for a transfer that is not whole, [`Error::Unsupported`] for one whose
    /// points are texels.
    pub fn new(transfer: &Transfer) -> Result<Self, Error> {
        if !transfer.is_whole() || transfer.meshes.iter().any(|m| m.channels != transfer.kind.channels()) {
            return Err(Error::Scene("the transfer has arrays that do not go together; bake it again".into()));
        }
        let mut upload = Self { vertices: Vec::new(), indices: Vec::new(), points: Vec::new(), ranges: Vec::new() };
        for (number, mesh) in (0..).zip(&transfer.meshes) {
            upload.add(number, mesh)?;
        }
        Ok(upload)
    }

    fn add(&mut self, number: u32, baked: &BakedMesh) -> Result<(), Error> {
        if baked.points != Points::Vertices {
            let what = "a transfer at the texels of an atlas; bake it at vertices".into();
            return Err(Error::Unsupported { technique: "prt".into(), what });
        }
        let (mesh, first) = (&baked.mesh, self.vertices.len() as u32);
        let count = mesh.positions.len() as u32;
        let size = (u64::from(first) + u64::from(count)) * 2 * baked.sides.count() as u64;
        if size > u64::from(u32::MAX >> 2) {
            return Err(Error::Size { what: "the transfer's points".into(), size, limit: u64::from(u32::MAX >> 2) });
        }
        for (i, position) in mesh.positions.iter().enumerate() {
            let uv = mesh.uvs.get(i).copied().unwrap_or_default();
            let opacity = mesh.opacities.get(i).copied().unwrap_or(1.0);
            let uv = Vec3::new(uv.x, uv.y, opacity).to_array();
            self.vertices.push(Vertex { position: position.to_array(), uv, mesh: number });
        }
        let sides = baked.sides.count() as u32;
        for side in 0..sides {
            let place = |vertex: u32| (2 * (first + vertex) + side) << 1 | u32::from(sides == 1);
            self.points.extend((0..count).map(|vertex| PrtPoint { mesh: number, place: place(vertex) }));
        }
        let start = self.indices.len() as u32;
        self.indices.extend(mesh.indices.iter().map(|i| first + i));
        self.ranges.push(start..self.indices.len() as u32);
        Ok(())
    }
}

/// How many points have their vectors in one buffer.
pub(super) fn points_per_part(gpu: &Gpu, vector_len: usize) -> usize {
    let limits = gpu.device.limits();
    let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) as usize;
    (most / (4 * vector_len.max(1))).clamp(GRAIN, MOST_GROUPS * BLOCK) / GRAIN * GRAIN
}

/// The vectors of points of all meshes, `points` of all, in blocks: number by number, each of all
/// points of the block. What is no number is 0.
pub(super) fn blocks(transfer: &Transfer, points: Range<usize>) -> Vec<f32> {
    let len = transfer.order.functions() * transfer.kind.channels();
    let mut data = vec![0.0; points.len().div_ceil(BLOCK) * BLOCK * len];
    let (mut vector, mut first) = (vec![0.0; len], 0);
    for mesh in &transfer.meshes {
        let count = mesh.point_count();
        for point in points.start.max(first)..points.end.min(first + count) {
            mesh.stored.read(point - first, &mut vector);
            let at = point - points.start;
            let start = at / BLOCK * BLOCK * len + at % BLOCK;
            for (i, value) in vector.iter().enumerate() {
                data[start + i * BLOCK] = if value.is_finite() { *value } else { 0.0 };
            }
        }
        first += count;
    }
    data
}

/// True where the normals of most of a mesh's triangles are on their back.
pub(super) fn is_turned(baked: &BakedMesh) -> bool {
    let mesh = &baked.mesh;
    let normal = |i: u32| mesh.normals.get(i as usize).copied().unwrap_or_default();
    let agrees = mesh.triangles().map(|t| {
        let [a, b, c] = mesh.corners(t);
        let side = (b - a).cross(c - a).dot(normal(t[0]) + normal(t[1]) + normal(t[2]));
        if side < 0.0 { -1 } else { i64::from(side > 0.0) }
    });
    agrees.sum::<i64>() < 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::harmonics::Order;
    use umbrage_core::primitive;
    use umbrage_core::transfer::{Kind, Sides, Stored};

    fn transfer() -> Transfer {
        let order = Order::new(2).unwrap();
        let mesh = |instance, sides: Sides, first: f32| {
            let mesh = primitive::plane();
            let count = mesh.positions.len() * sides.count() * 4;
            let stored = Stored::Full((0..count).map(|i| first + i as f32).collect());
            BakedMesh { instance, mesh, points: Points::Vertices, sides, channels: 1, stored }
        };
        let meshes = vec![mesh(0, Sides::Both, 0.0), mesh(1, Sides::Front, 100.0)];
        Transfer { order, kind: Kind::Shadowed, meshes }
    }

    #[test]
    fn vectors_lie_in_blocks_across_meshes() {
        let transfer = transfer();
        let data = blocks(&transfer, 0..12);
        let vector = |point: usize| [0, 1, 2, 3].map(|i| data[i * BLOCK + point]);
        assert_eq!((vector(0), vector(7)), ([0.0, 1.0, 2.0, 3.0], [28.0, 29.0, 30.0, 31.0]));
        assert_eq!(
            (vector(8), vector(11), vector(12)),
            ([100.0, 101.0, 102.0, 103.0], [112.0, 113.0, 114.0, 115.0], [0.0; 4])
        );
        assert_eq!(blocks(&transfer, 8..12)[0], 100.0);
    }

    #[test]
    fn meshes_become_one_and_backs_are_told() {
        let upload = Upload::new(&transfer()).unwrap();
        assert_eq!((upload.vertices.len(), upload.points.len(), upload.indices.len()), (8, 12, 12));
        assert_eq!(upload.ranges, [0..6, 6..12]);
        assert!(upload.indices[6..].iter().all(|i| *i >= 4) && upload.vertices[4].mesh == 1);
        // Front, back, and one that is both.
        assert_eq!([0, 4, 8].map(|point: usize| upload.points[point].place), [0, 0b10, 0b10001]);
        let mut broken = transfer();
        broken.meshes[0].stored = Stored::Full(Vec::new());
        assert!(Upload::new(&broken).is_err_and(|e| e.to_string().contains("bake it again")));
    }

    #[test]
    fn normals_on_the_back_are_seen() {
        let mut mesh = transfer().meshes.remove(1);
        assert!(!is_turned(&mesh));
        mesh.mesh.normals.iter_mut().for_each(|n| *n = -*n);
        assert!(is_turned(&mesh));
    }
}
