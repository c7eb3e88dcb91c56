//! Scenes around a light, and their truth.

use crate::common::{mask, renderer, visibility};
use umbrage::Gpu;
use umbrage::core::glam::{DAffine3, DMat3, DVec3};
use umbrage::core::{Camera, Image, Light, LightShape, Material, Mesh, Scene, primitive};
use umbrage_metrics::{Comparison, Scores, map_reach, score};
use umbrage_reference::{Geometry, Options, Tracer, Truth};

pub const LIGHT: DVec3 = DVec3::new(0.1, 1.3, -0.15);
/// The same surface with every edge in `n` parts.
fn split(mesh: &Mesh, n: u32) -> Mesh {
    let mut out = Mesh { name: mesh.name.clone(), ..Mesh::default() };
    for t in mesh.triangles() {
        let [a, b, c] = mesh.corners(t);
        let normal = mesh.normals[t[0] as usize];
        let first = out.positions.len() as u32;
        // Row j has n − j + 1 points.
        let at = |i: u32, j: u32| first + j * (n + 1) - j * j.saturating_sub(1) / 2 + i;
        for j in 0..=n {
            for i in 0..=n - j {
                out.positions.push(a + (b - a) * (i as f32 / n as f32) + (c - a) * (j as f32 / n as f32));
                out.normals.push(normal);
            }
        }
        for j in 0..n {
            for i in 0..n - j {
                out.indices.extend([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    out.indices.extend([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    out
}

/// A room of slabs without anything in it, on the height 0 and `size` large.
pub fn empty_room(size: DVec3, parts: u32, light: LightShape) -> Scene {
    let mut scene = Scene { lights: vec![Light::new(light)], ..Scene::default() };
    let cube = scene.add_mesh(split(&primitive::cube(), parts));
    let material = scene.add_material(Material::default());
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut center = DVec3::Y * 0.5 * size.y;
            let mut slab = size + 0.8;
            center[axis] += side * (0.5 * size[axis] + 0.2);
            slab[axis] = 0.4;
            scene.place(cube, material, placed(center, slab, 0.0));
        }
    }
    scene
}

/// A table right under the light, and boxes around it: all edges of the table are more than 90
/// degrees long as the light sees them.
pub fn room(parts: u32, light: LightShape) -> Scene {
    let mut scene = empty_room(DVec3::new(6.0, 3.0, 6.0), parts, light);
    let (eye, target) = (DVec3::new(2.4, 2.3, 2.6), DVec3::new(-0.9, 0.3, -1.1));
    scene.camera = Camera { eye, target, fov_y_deg: 75.0, ..Camera::default() };
    for (center, size, turn) in [
        ([0.0, 0.75, 0.0], [1.3, 0.06, 1.2], 0.2),
        ([-1.0, 1.2, -0.6], [0.1, 1.4, 0.9], 0.4),
        ([0.3, 1.3, -1.2], [0.7, 0.7, 0.1], -0.3),
        ([2.3, 0.25, 0.1], [0.5, 0.5, 0.5], 0.7),
    ] {
        scene.place(0, 0, placed(DVec3::from(center), DVec3::from(size), turn));
    }
    scene
}

fn placed(center: DVec3, size: DVec3, turn: f64) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_rotation_y(turn) * DMat3::from_diagonal(size), center)
}

/// The longest edge of what stands in the room, degrees as the light sees it.
pub fn longest_edge(scene: &Scene) -> f64 {
    let edges = scene.instances.iter().skip(6).flat_map(|instance| {
        let mesh = &scene.meshes[instance.mesh];
        let way = move |i: u32| {
            (instance.world_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3()) - LIGHT).normalize()
        };
        let of = move |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)].map(|(a, b)| way(a).angle_between(way(b)));
        mesh.triangles().flat_map(of)
    });
    edges.fold(0.0, f64::max).to_degrees()
}

/// A slab twice as far from the light at its bottom as at its top, and what its shadow falls on.
pub fn slab() -> Scene {
    let mut scene = Scene { lights: vec![Light::new(LightShape::Point { position: LIGHT })], ..Scene::default() };
    let cube = scene.add_mesh(split(&primitive::cube(), 16));
    let material = scene.add_material(Material::default());
    scene.place(cube, material, placed(LIGHT - DVec3::Y * 1.5, DVec3::new(4.0, 1.0, 4.0), 0.0));
    scene.place(cube, material, placed(LIGHT - DVec3::Y * 3.5, DVec3::new(9.0, 1.0, 9.0), 0.0));
    scene
}

/// A scene with its truth.
pub struct Traced {
    scene: Scene,
    geometry: Geometry,
    truth: Truth,
    mask: Image<bool>,
}

impl Traced {
    pub fn new(scene: Scene, (width, height): (u32, u32), samples: u32) -> Self {
        let tracer = Tracer::new(&scene);
        let geometry = tracer.geometry(&scene.camera, width, height);
        let options = Options { samples, ..Options::default() };
        let truth = tracer.visibility(&geometry, &scene.lights[0], &scene.textures, &options, &|_, _| ());
        let mask = mask(&truth, &geometry, 60.0);
        Self { scene, geometry, truth, mask }
    }

    pub fn score(&self, gpu: &Gpu, id: &str, set: &str) -> Scores {
        let mut renderer = renderer(gpu, &self.scene, 0, id, set, self.geometry.depth.size());
        let produced = visibility(&mut renderer, &self.scene);
        let technique = renderer.technique(0).unwrap();
        let reach = map_reach(
            technique.inside().light_views(),
            technique.inside().split_distances(),
            &self.scene.camera,
            &self.geometry.depth,
            &self.geometry.normal,
        );
        let (reference, mask) = (&self.truth.visibility, &self.mask);
        score(&Comparison { produced: &produced, reference, mask, hard: None, reach: Some(&reach), contacts: None })
            .unwrap()
    }
}
