//! The points of a scene that get a transfer.

use crate::tessellate::{area, tessellated};
use crate::{BakedSides, Settings};
use glam::{DMat3, DVec2, DVec3};
use umbrage_core::mesh_check::check;
use umbrage_core::transfer::Sides;
use umbrage_core::{Bounds, Instance, Mesh, Scene};

/// How far from a vertex towards its triangles' points rays start, at most. They start within
/// triangles, so that a vertex on another surface, such as the foot of a wall, is as its
/// surroundings are and not between inside and outside.
const SPREAD: f64 = 0.1;

/// The scene with its triangles cut, and where its points are.
pub(crate) struct Surface {
    /// One instance for each of the scene, in the same order.
    pub scene: Scene,
    /// One for each instance.
    pub parts: Vec<Part>,
}

/// The points of an instance.
pub(crate) struct Part {
    pub sides: Sides,
    /// Number of its first point among all of the scene.
    pub first: usize,
    /// True where the instance mirrors its mesh, which turns its triangles round.
    pub is_mirrored: bool,
    /// Triangles around each vertex: those of vertex i begin at `starts[i]`.
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// The share of each in the area around its vertex, summed up to it.
    shares: Vec<f64>,
}

/// A point as rays see it.
pub(crate) struct Point {
    pub instance: usize,
    pub vertex: usize,
    /// Unit normal, on the point's side; world space.
    pub normal: DVec3,
}

impl Surface {
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        let mut cut =
            Scene { materials: scene.materials.clone(), textures: scene.textures.clone(), ..Scene::default() };
        let diagonal = finite_size(scene);
        let mut longest = diagonal / settings.detail;
        let corners: usize = scene.instances.iter().map(|i| scene.meshes[i.mesh].positions.len()).sum();
        let most = settings.most_vertices.max(corners);
        // Edges grow until all meshes together are within the budget.
        let meshes = loop {
            let meshes: Vec<Mesh> = cut_all(scene, longest, most);
            let is_within = meshes.iter().map(|m| m.positions.len()).sum::<usize>() <= most;
            if is_within || longest >= diagonal {
                break meshes;
            }
            longest *= 1.4;
        };
        let (mut parts, mut first) = (Vec::new(), 0);
        for (instance, mesh) in scene.instances.iter().zip(meshes) {
            let is_open = || !check(&scene.meshes[instance.mesh]).is_closed();
            let sides = if settings.sides == BakedSides::Both || is_open() { Sides::Both } else { Sides::Front };
            let part = Part::new(&mesh, instance.world_from_mesh.matrix3, sides, first);
            first += sides.count() * mesh.positions.len();
            parts.push(part);
            let mut instance = instance.clone();
            (instance.mesh, instance.pose) = (cut.meshes.len(), None);
            cut.meshes.push(mesh);
            cut.instances.push(instance);
        }
        Self { scene: cut, parts }
    }

    /// Points of the whole scene.
    pub fn point_count(&self) -> usize {
        let last = self.parts.last().zip(self.scene.meshes.last());
        last.map_or(0, |(part, mesh)| part.first + part.sides.count() * mesh.positions.len())
    }

    /// Point number `number`; `None` where no triangle with an area has it.
    pub fn point(&self, number: usize) -> Option<Point> {
        let instance = self.parts.partition_point(|part| part.first <= number).checked_sub(1)?;
        let (part, mesh) = (self.parts.get(instance)?, self.scene.meshes.get(instance)?);
        let vertices = mesh.positions.len();
        let (side, vertex) = ((number - part.first) / vertices.max(1), (number - part.first) % vertices.max(1));
        if part.around(vertex).is_empty() {
            return None;
        }
        let matrix = self.scene.instances[instance].world_from_mesh.matrix3;
        let normal = matrix.inverse().transpose() * mesh.normals.get(vertex)?.as_dvec3();
        let normal = if side == 0 { normal } else { -normal };
        Some(Point { instance, vertex, normal: normal.try_normalize()? })
    }

    /// Where a ray of a point starts, for `u` in [0, 1)².
    pub fn start(&self, point: &Point, u: DVec2) -> DVec3 {
        let (part, mesh) = (&self.parts[point.instance], &self.scene.meshes[point.instance]);
        let around = part.around(point.vertex);
        let shares = &part.shares[around.clone()];
        let chosen = shares.partition_point(|share| *share <= u.x).min(shares.len() - 1);
        let before = if chosen == 0 { 0.0 } else { shares[chosen - 1] };
        let within = ((u.x - before) / (shares[chosen] - before).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let triangle = part.triangles[around.start + chosen] as usize;
        let corners = [0, 1, 2].map(|k| mesh.positions[mesh.indices[3 * triangle + k] as usize].as_dvec3());
        // Evenly over the triangle: the square folded along its diagonal.
        let (s, t) = if within + u.y > 1.0 { (1.0 - within, 1.0 - u.y) } else { (within, u.y) };
        let target = corners[0] + (corners[1] - corners[0]) * s + (corners[2] - corners[0]) * t;
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let vertex = mesh.positions[point.vertex].as_dvec3();
        // A little towards the middle, so that no ray starts on an edge.
        let place = vertex.lerp(target.lerp(middle, 0.01), SPREAD);
        self.scene.instances[point.instance].world_from_mesh.transform_point3(place)
    }
}

impl Part {
    fn new(mesh: &Mesh, matrix: DMat3, sides: Sides, first: usize) -> Self {
        let mut starts = vec![0_u32; mesh.positions.len() + 1];
        let areas: Vec<f64> = mesh.triangles().map(|t| area(mesh.corners(t), matrix)).collect();
        let counted =
            || mesh.triangles().zip(&areas).zip(0..).filter(|((_, area), _)| **area > 0.0 && area.is_finite());
        for ((corners, _), _) in counted() {
            corners.iter().for_each(|&i| starts[i as usize + 1] += 1);
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let total = starts.last().map_or(0, |last| *last as usize);
        let (mut triangles, mut next) = (vec![0_u32; total], starts.clone());
        for ((corners, _), triangle) in counted() {
            for i in corners {
                triangles[next[i as usize] as usize] = triangle;
                next[i as usize] += 1;
            }
        }
        let mut shares = vec![0.0; total];
        for bounds in starts.windows(2) {
            let around = bounds[0] as usize..bounds[1] as usize;
            let all: f64 = triangles[around.clone()].iter().map(|&t| areas[t as usize]).sum();
            let mut sum = 0.0;
            for k in around {
                sum += areas[triangles[k] as usize] / all;
                shares[k] = sum;
            }
        }
        Self { sides, first, is_mirrored: matrix.determinant() < 0.0, starts, triangles, shares }
    }

    /// Where the triangles around a vertex are in the lists.
    fn around(&self, vertex: usize) -> std::ops::Range<usize> {
        let at = |i: usize| self.starts.get(i).map_or(0, |start| *start as usize);
        at(vertex)..at(vertex + 1).max(at(vertex))
    }
}

fn cut_all(scene: &Scene, longest: f64, most: usize) -> Vec<Mesh> {
    let cut = |i: &Instance| tessellated(&scene.posed_mesh(i), i.world_from_mesh.matrix3, longest, most);
    scene.instances.iter().map(cut).collect()
}

/// The diagonal of the box around all corners that are finite, metres.
fn finite_size(scene: &Scene) -> f64 {
    let of = |i: &Instance| {
        let mesh = scene.posed_mesh(i);
        let corners = mesh.indices.iter().filter_map(|&k| mesh.positions.get(k as usize));
        let places = corners.map(|p| i.world_from_mesh.transform_point3(p.as_dvec3()));
        Bounds::of(places.filter(|p| p.is_finite()))
    };
    let bounds = scene.instances.iter().map(of).fold(Bounds::EMPTY, Bounds::union);
    let size = bounds.size().length();
    if size.is_finite() { size } else { 0.0 }
}
