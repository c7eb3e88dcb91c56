//! What is in the picture: casters, panes and smoke.

use umbrage::core::glam::{DAffine3, DVec3, Vec3};
use umbrage::core::{Bounds, Material, Scene, primitive};

/// One corner of a triangle: where it is in the world, which way its triangle faces, its colour and
/// opacity, and what kind of thing it is (see `forward.wgsl`).
pub struct Corner {
    pub position: DVec3,
    pub normal: Vec3,
    pub color: [f32; 4],
    pub kind: u32,
}

/// What casts shadows.
pub fn casters() -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let [plane, cube, sphere] =
        [primitive::plane(), primitive::cube(), primitive::sphere(32, 16)].map(|mesh| scene.add_mesh(mesh));
    let at = |x, y, z| DAffine3::from_translation(DVec3::new(x, y, z));
    let sized = |x, y, z| DAffine3::from_scale(DVec3::new(x, y, z));
    scene.place(plane, material, sized(4.0, 4.0, 4.0));
    scene.place(cube, material, at(-2.0, 1.1, 0.1) * DAffine3::from_rotation_y(0.4) * sized(0.6, 2.2, 0.6));
    scene.place(cube, material, at(-2.1, 0.6, 1.6) * sized(0.3, 1.2, 0.3));
    scene.place(cube, material, at(0.9, 0.35, -2.0) * DAffine3::from_rotation_y(0.9) * sized(0.7, 0.7, 0.7));
    scene.place(sphere, material, at(1.1, 0.5, 0.1) * sized(0.5, 0.5, 0.5));
    scene
}

/// Triangles of the casters.
pub fn solids() -> Vec<Corner> {
    let scene = casters();
    let colors = [[0.7, 0.68, 0.64], [0.75, 0.32, 0.22], [0.65, 0.6, 0.3], [0.4, 0.6, 0.35], [0.35, 0.5, 0.75]];
    let corners = scene.instances.iter().zip(colors).flat_map(|(instance, [r, g, b])| {
        let mesh = &scene.meshes[instance.mesh];
        let world = |i: &u32| instance.world_from_mesh.transform_point3(mesh.positions[*i as usize].as_dvec3());
        let places: Vec<DVec3> = mesh.indices.iter().map(world).collect();
        triangles(&places, [r, g, b, 1.0], 0)
    });
    corners.collect()
}

/// Panes of coloured glass and smoke, the farthest from `eye` first.
pub fn transparent(eye: DVec3) -> Vec<Corner> {
    let mut things: Vec<Vec<Corner>> = panes().into_iter().chain(smoke(eye)).collect();
    let distance = |thing: &Vec<Corner>| thing.iter().map(|c| c.position.distance(eye)).fold(0.0, f64::max);
    things.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
    things.into_iter().flatten().collect()
}

/// Boxes around what is transparent: maps cover what the casters are, unless they are told more.
pub fn beside_casters() -> [Bounds; 1] {
    let around = transparent(DVec3::ZERO);
    [Bounds::of(around.iter().map(|corner| corner.position))]
}

fn panes() -> Vec<Vec<Corner>> {
    let pane = |x: f64, z: f64, turn: f64, color| {
        let place = DAffine3::from_translation(DVec3::new(x, 0.9, z)) * DAffine3::from_rotation_y(turn);
        quad(
            [(-0.8, -0.85), (0.8, -0.85), (0.8, 0.85), (-0.8, 0.85)]
                .map(|(x, y)| place.transform_point3(DVec3::new(x, y, 0.0))),
            color,
            1,
        )
    };
    vec![pane(-0.7, 1.2, 1.2, [0.3, 0.9, 0.5, 0.55]), pane(2.1, -0.9, -0.7, [0.9, 0.8, 0.3, 0.5])]
}

/// Puffs on a spiral that rises behind the tall box: out of its shadow.
fn smoke(eye: DVec3) -> Vec<Vec<Corner>> {
    let puff = |i: u32| {
        let (turn, up) = (f64::from(i) * 2.4, f64::from(i) / 500.0);
        let wide = (0.12 + 0.35 * up) * (0.2 + 0.8 * (f64::from(i) * 0.618).fract());
        let middle = DVec3::new(-0.5 + wide * turn.cos(), 0.1 + 2.3 * up, -0.65 + wide * turn.sin());
        let toward = (eye - middle).normalize();
        let right = DVec3::Y.cross(toward).normalize() * 0.07;
        let top = toward.cross(right);
        let corners = [-right - top, right - top, right + top, -right + top].map(|way| middle + way);
        quad(corners, [0.9, 0.9, 0.9, 0.2], 2)
    };
    (0..500).map(puff).collect()
}

fn quad([a, b, c, d]: [DVec3; 4], color: [f32; 4], kind: u32) -> Vec<Corner> {
    triangles(&[a, b, c, a, c, d], color, kind)
}

fn triangles(places: &[DVec3], color: [f32; 4], kind: u32) -> Vec<Corner> {
    let corners = places.chunks_exact(3).flat_map(|p| {
        let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero().as_vec3();
        p.iter().map(move |position| Corner { position: *position, normal, color, kind })
    });
    corners.collect()
}
