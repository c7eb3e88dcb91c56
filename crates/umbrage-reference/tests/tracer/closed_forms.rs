//! The tracer against formulas.

use crate::scenes::{every_light, place, speck};
use umbrage_core::glam::{DMat3, DVec2, DVec3, Vec3};
use umbrage_core::{Light, LightKind, LightShape, Scene, primitive};
use umbrage_reference::closed_form::{
    disc_above_plane, is_inside, past_half_plane, rect_above_plane, shadow_on_ground, sphere_above_plane,
};
use umbrage_reference::{Options, Surface, Tracer};

const OPTIONS: Options = Options { samples: 4096, gather: true, same_points: false };

/// The share of a light above a plane, or `None` for lights without a formula here.
fn above_plane(light: &Light, p: DVec3, up: DVec3) -> Option<f64> {
    match light.shape {
        LightShape::Sphere { position, radius } => Some(sphere_above_plane(p, up, position, radius)),
        // The disc in the ellipsoid's own space; the plane's normal goes there by the transposed
        // map.
        LightShape::Ellipsoid { position, radii, rotation } => {
            let to_unit = |v: DVec3| rotation.transpose() * v / radii;
            let up = rotation.transpose() * up * radii;
            Some(sphere_above_plane(to_unit(p), up, to_unit(position), 1.0))
        }
        LightShape::Disc { position, direction, radius } => Some(disc_above_plane(p, up, position, direction, radius)),
        LightShape::Rect { position, direction, up: v, size, .. } => {
            let half_axes = [v.cross(direction) * size.x * 0.5, v * size.y * 0.5];
            Some(rect_above_plane(p, up, position, half_axes))
        }
        LightShape::Line { from, to } => {
            Some(rect_above_plane(p, up, (from + to) * 0.5, [(to - from) * 0.5, DVec3::ZERO]))
        }
        _ => None,
    }
}

/// Largest and mean difference over points of which at least a hundred are in a penumbra.
fn assert_agrees(what: &str, pairs: impl Iterator<Item = (f64, f64)>, largest: f64, mean: f64) {
    let penumbra = |want: f64| want > 0.0 && want < 1.0;
    let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for (got, want) in pairs {
        assert!(penumbra(want) || got == want, "{what}: {got} instead of {want}");
        if penumbra(want) {
            worst = worst.max((got - want).abs());
            sum += (got - want).abs();
            count += 1;
        }
    }
    let average = sum / f64::from(count);
    assert!(count > 100 && worst < largest && average < mean, "{what}: {count} points, {worst} and {average} off");
}

#[test]
fn lights_over_a_half_plane() {
    // A sheet so wide that only its edge at x = −0.2 counts, tilted about that edge.
    let (edge, along, into) = (DVec3::new(-0.2, 1.1, 0.0), DVec3::Z, DVec3::new(-1.0, 0.1, 0.0).normalize());
    let mut scene = Scene::default();
    place(&mut scene, speck(), DVec3::ONE, DMat3::IDENTITY, DVec3::ZERO);
    let tilt = DMat3::from_cols(-into, into.cross(along).normalize(), along);
    place(&mut scene, primitive::plane(), DVec3::splat(40.0), tilt, edge + into * 20.0);
    let tracer = Tracer::new(&scene);
    for light in every_light() {
        let surfaces = (0..2400).map(|k| Surface {
            position: DVec3::new(-3.0 + 0.0025 * f64::from(k), 0.0, -0.8),
            normal: DVec3::Y,
            casts: false,
            triangle: None,
        });
        let pairs = surfaces.enumerate().filter_map(|(k, surface)| {
            let want = above_plane(&light, surface.position, past_half_plane(surface.position, edge, along, into))?;
            Some((tracer.visibility_at(&surface, &light, &[], &OPTIONS, k as u32), want))
        });
        if above_plane(&light, DVec3::ZERO, DVec3::Y).is_some() {
            assert_agrees(light.shape.kind().name(), pairs, 6e-3, 6e-4);
        }
    }
}

#[test]
fn lights_on_the_points_own_horizon() {
    let mut scene = Scene::default();
    place(&mut scene, speck(), DVec3::ONE, DMat3::IDENTITY, DVec3::NEG_Y * 50.0);
    let tracer = Tracer::new(&scene);
    for light in every_light().iter().filter(|l| l.shape.kind().is_soft() && l.shape.kind() != LightKind::Sun) {
        let to_light = light.shape.to_center(DVec3::ZERO).normalize();
        let side = to_light.any_orthonormal_vector();
        let surface = |k: u32, casts| {
            let angle = f64::from(k) / 2400.0 * 0.4 - 0.2;
            Surface {
                position: DVec3::ZERO,
                normal: side * angle.cos() + to_light * angle.sin(),
                casts,
                triangle: None,
            }
        };
        let pairs = (0..2400).filter_map(|k| {
            let surface = surface(k, true);
            let want = above_plane(light, DVec3::ZERO, surface.normal)?;
            Some((tracer.visibility_at(&surface, light, &[], &OPTIONS, k), want))
        });
        assert_agrees(light.shape.kind().name(), pairs, 6e-3, 6e-4);
        let unshadowing = tracer.visibility_at(&surface(1200, false), light, &[], &OPTIONS, 0);
        assert_eq!(unshadowing, 1.0, "what casts no shadow does not hide the light from itself");
    }
}

#[test]
fn the_shadow_of_a_turned_box_is_the_polygon_of_its_corners() {
    let mut scene = Scene::default();
    let (turn, at) = (DMat3::from_rotation_y(0.5) * DMat3::from_rotation_x(0.3), DVec3::new(0.3, 1.2, -0.4));
    place(&mut scene, primitive::plane(), DVec3::splat(30.0), DMat3::IDENTITY, DVec3::ZERO);
    place(&mut scene, primitive::cube(), DVec3::new(0.7, 0.9, 0.5), turn, at);
    let tracer = Tracer::new(&scene);
    let light = DVec3::new(2.0, 5.0, 1.0);
    let cube = primitive::cube();
    let corner = |c: &Vec3| turn * (c.as_dvec3() * DVec3::new(0.7, 0.9, 0.5)) + at;
    let corners: Vec<DVec3> = cube.positions.iter().map(corner).collect();
    let polygon = shadow_on_ground(light, &corners).expect("a box between light and ground");
    let mut shadowed = 0;
    for k in 0..200 * 200 {
        let point = DVec2::new(f64::from(k % 200), f64::from(k / 200)) * 0.02 - DVec2::splat(2.5) + 0.0037;
        let from = DVec3::new(point.x, 0.0, point.y);
        let inside = is_inside(&polygon, point);
        assert_eq!(tracer.blocked(from, light.extend(1.0)), inside, "at {point}");
        shadowed += i32::from(inside);
    }
    assert!(shadowed > 1000, "the shadow is in the picture");
}
