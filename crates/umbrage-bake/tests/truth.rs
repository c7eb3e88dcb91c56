//! Baked transfer against closed forms and against independent rays.

use glam::{DAffine3, DQuat, DVec3, Vec3, Vec3Swizzles};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;
use umbrage_bake::{BakedSides, Settings, bake};
use umbrage_core::harmonics::{Light, Order, project};
use umbrage_core::transfer::{BakedMesh, Kind, Transfer};
use umbrage_core::{Material, Scene, primitive, sampling::shift};
use umbrage_reference::Tracer;

fn scene(placed: &[(umbrage_core::Mesh, DAffine3, Vec3)]) -> Scene {
    let mut scene = Scene::default();
    for (mesh, place, color) in placed {
        let mesh = scene.add_mesh(mesh.clone());
        let material = scene.add_material(Material { base_color: color.extend(1.0), ..Material::default() });
        scene.place(mesh, material, *place);
    }
    scene
}

fn baked(scene: &Scene, settings: &Settings) -> Transfer {
    bake(scene, settings, &|_, _| ControlFlow::Continue(())).expect("a transfer")
}

/// What a point sends out for a base colour of 1.
fn radiance(mesh: &BakedMesh, point: usize, light: &Light) -> DVec3 {
    let n = light.order().functions();
    let mut vector = vec![0.0; mesh.vector_len(light.order())];
    mesh.stored.read(point, &mut vector);
    let channel = |c: usize| &vector[c.min(mesh.channels - 1) * n..][..n];
    let of = |c: usize| light.coefficients().iter().zip(channel(c)).map(|(l, t)| l[c] * f64::from(*t)).sum();
    DVec3::new(of(0), of(1), of(2))
}

fn constant(order: Order) -> Light {
    project(order, 0, |_| Vec3::ONE)
}

/// Some sky of this order, nowhere constant.
fn band_limited(order: Order) -> Light {
    project(order, 60, |s| {
        let lobe = |axis: DVec3| (4.0 * (s.dot(axis.normalize()) - 1.0)).exp();
        (DVec3::new(lobe(DVec3::ONE), lobe(DVec3::new(-1.0, 1.0, 0.0)), 0.5 + lobe(DVec3::Y))).as_vec3()
    })
}

fn nearest(mesh: &BakedMesh, place: Vec3) -> usize {
    let far = |i: &usize| mesh.mesh.positions[*i].distance(place);
    (0..mesh.mesh.positions.len()).min_by(|a, b| far(a).total_cmp(&far(b))).expect("a vertex")
}

#[test]
fn a_constant_sky_gives_1_on_a_plane_and_on_a_convex_body_exactly() {
    let apart = DAffine3::from_translation(DVec3::new(0.0, 0.0, 1e6));
    for mesh in [primitive::plane(), primitive::cube()] {
        let scene = scene(&[(mesh, apart, Vec3::ONE)]);
        let settings = Settings { rays: 16, detail: 4.0, ..Settings::default() };
        let transfer = baked(&scene, &settings);
        let light = constant(settings.order);
        for point in 0..transfer.meshes[0].point_count() {
            let found = radiance(&transfer.meshes[0], point, &light).x;
            assert!((found - 1.0).abs() < 1e-6, "{}: {found}", transfer.meshes[0].mesh.name);
        }
    }
}

#[test]
fn a_constant_sky_gives_a_half_at_the_foot_of_a_wall() {
    let large = DAffine3::from_scale(DVec3::splat(2000.0));
    // Its lower edge in the middle of the floor.
    let upright = DAffine3::from_rotation_translation(DQuat::from_rotation_x(FRAC_PI_2), DVec3::Y * 1000.0);
    let scene = scene(&[(primitive::plane(), large, Vec3::ONE), (primitive::plane(), upright * large, Vec3::ONE)]);
    let settings = Settings { rays: 1024, detail: 32.0, ..Settings::default() };
    let transfer = baked(&scene, &settings);
    let light = constant(settings.order);
    let floor = &transfer.meshes[0];
    let foot = radiance(floor, nearest(floor, Vec3::ZERO), &light).x;
    assert!((foot - 0.5).abs() < 0.02, "the floor at the foot: {foot}");
    let wall = &transfer.meshes[1];
    let edge = nearest(wall, Vec3::new(0.0, 0.0, 0.5));
    for side in [0, wall.points_per_side()] {
        let found = radiance(wall, side + edge, &light).x;
        assert!((found - 0.5).abs() < 0.02, "the wall at its foot: {found}");
    }
}

/// A floor with a box on it.
fn box_on_floor(floor: Vec3, block: Vec3) -> Scene {
    let large = DAffine3::from_scale(DVec3::splat(6.0));
    let above = DAffine3::from_translation(DVec3::Y * 0.5);
    scene(&[(primitive::plane(), large, floor), (primitive::cube(), above, block)])
}

/// A direction as dense as the cosine about `normal`, without a pattern.
fn random(normal: DVec3, seed: u32) -> DVec3 {
    let u = shift(seed);
    let (radius, (sin, cos)) = (u.x.sqrt(), (TAU * u.y).sin_cos());
    let (a, b) = normal.any_orthonormal_pair();
    a * radius * cos + b * radius * sin + normal * (1.0 - u.x).sqrt()
}

#[test]
fn transfer_and_rays_agree_under_a_band_limited_sky() {
    let scene = box_on_floor(Vec3::ONE, Vec3::ONE);
    let tracer = Tracer::new(&scene);
    for n in [1, 3, 5, 10] {
        let settings = Settings { order: Order::new(n).unwrap(), rays: 4096, detail: 8.0, ..Settings::default() };
        let (transfer, light) = (baked(&scene, &settings), band_limited(settings.order));
        let floor = &transfer.meshes[0];
        // Next to the box, and farther off; on no edge of its shadow.
        for place in [Vec3::new(0.125, 0.0, 0.25), Vec3::new(-0.25, 0.0, 0.0), Vec3::new(0.375, 0.0, 0.375)] {
            let point = nearest(floor, place);
            let from = scene.instances[0].world_from_mesh.transform_point3(floor.mesh.positions[point].as_dvec3());
            let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
            let count = 4000;
            for seed in 0..count {
                let direction = random(DVec3::Y, 77 + seed);
                let seen = !tracer.blocked(from, direction.extend(0.0));
                let value = if seen { light.radiance(direction) } else { DVec3::ZERO };
                (sum, squares) = (sum + value, squares + value * value);
            }
            let mean = sum / f64::from(count);
            let error = ((squares / f64::from(count) - mean * mean) / f64::from(count)).map(f64::sqrt);
            let off = (radiance(floor, point, &light) - mean).abs();
            assert!((off - 3.0 * error).max_element() < 0.0, "order {n} at {place}: {off} off, error {error}");
        }
    }
}

#[test]
fn reflected_light_is_that_of_traced_paths() {
    let (floor, block) = (Vec3::new(0.9, 0.5, 0.3), Vec3::new(0.2, 0.6, 0.8));
    let scene = box_on_floor(floor, block);
    let tracer = Tracer::new(&scene);
    let kind = Kind::Interreflected { bounces: 2 };
    let settings = Settings { kind, rays: 1024, detail: 24.0, sides: BakedSides::Both, ..Settings::default() };
    let (transfer, light) = (baked(&scene, &settings), band_limited(settings.order));
    // The side of the box, whose light from below is all reflected.
    let side = &transfer.meshes[1];
    let right = (0..side.mesh.positions.len()).filter(|&i| side.mesh.normals[i] == Vec3::X);
    let inner = right.filter(|&i| side.mesh.positions[i].yz().abs().max_element() < 0.4);
    let (mut baked_sum, mut traced_sum, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for point in inner {
        let from = side.mesh.positions[point].as_dvec3() + DVec3::Y * 0.5;
        for seed in 0..2000 {
            traced_sum += path(&scene, &tracer, &light, (from, DVec3::X), 3, 10_000 * point as u32 + 4 * seed) / 2000.0;
        }
        baked_sum += radiance(side, point, &light);
        count += 1.0;
    }
    assert!(count >= 9.0, "{count} points");
    let off = (baked_sum / traced_sum - 1.0).abs().max_element();
    assert!(off < 0.02, "{} against {}", baked_sum / count, traced_sum / count);
}

/// The light that reaches a point along a random path with so many rays.
fn path(scene: &Scene, tracer: &Tracer, light: &Light, (from, normal): (DVec3, DVec3), rays: u32, seed: u32) -> DVec3 {
    let direction = random(normal, seed + rays);
    let Some(hit) = tracer.hit(from, direction) else { return light.radiance(direction) };
    if rays == 1 {
        return DVec3::ZERO;
    }
    let instance = &scene.instances[hit.instance as usize];
    let mesh = &scene.meshes[instance.mesh];
    let corners = [0, 1, 2].map(|k| mesh.positions[mesh.indices[3 * hit.triangle as usize + k] as usize].as_dvec3());
    let at: DVec3 = corners.iter().zip(hit.barycentric).map(|(p, share)| *p * share).sum();
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
    let normal = if hit.is_front { normal } else { -normal };
    let color = scene.materials[instance.material].base_color;
    let at = instance.world_from_mesh.transform_point3(at);
    color.truncate().as_dvec3() * path(scene, tracer, light, (at, normal), rays - 1, seed)
}

#[test]
fn a_box_on_a_floor_of_two_triangles_casts_a_shadow() {
    let scene = box_on_floor(Vec3::ONE, Vec3::ONE);
    let transfer = baked(&scene, &Settings { rays: 64, detail: 24.0, ..Settings::default() });
    let light = constant(Order::default());
    let floor = &transfer.meshes[0];
    let at = |x: f32| radiance(floor, nearest(floor, Vec3::new(x, 0.0, 0.0)), &light).x;
    let (under, beside, far) = (at(0.0), at(0.11), at(0.5));
    assert!(under < 1e-6 && beside > 0.3 && beside < far - 0.1 && far > 0.9, "{under} {beside} {far}");
}

#[test]
fn without_shadows_it_is_the_closed_form() {
    let scene = box_on_floor(Vec3::ONE, Vec3::ONE);
    let order = Order::new(4).unwrap();
    let transfer = baked(&scene, &Settings { order, kind: Kind::Unshadowed, ..Settings::default() });
    let mut want = [0.0; 16];
    umbrage_core::harmonics::unshadowed(order, DVec3::Y, &mut want);
    let mut found = [0.0; 16];
    transfer.meshes[0].stored.read(0, &mut found);
    assert_eq!(found, want.map(|value| value as f32));
}
