//! Darkness is dark: nothing leaks into a closed room, and a light that has shrunk to a point is a
//! hard light.

use crate::common::{gpu, renderer, visibility};
use crate::layouts::rooms::empty_room;
use umbrage::core::glam::{DMat3, DVec3};
use umbrage::core::{Camera, LightShape, Scene};
use umbrage::techniques;

/// A closed room seen from within, and a light outside of it.
fn closed(light: LightShape) -> Scene {
    let mut scene = empty_room(DVec3::new(4.0, 2.5, 4.0), 1, light);
    let (eye, target) = (DVec3::new(1.5, 1.6, 1.5), DVec3::new(-1.0, 0.8, -1.2));
    scene.camera = Camera { eye, target, fov_y_deg: 75.0, ..Camera::default() };
    scene
}

/// Lights outside of the room. Places on its walls see the flat ones edge-on, and the first of them
/// where the axes of the world are in line with it.
fn outside() -> Vec<LightShape> {
    let position = DVec3::new(5.0, 6.0, 0.5);
    let direction = DVec3::new(-0.7, -0.7, 0.1).normalize();
    let aside = DVec3::new(0.7, -0.7, 0.0).normalize();
    vec![
        LightShape::Point { position },
        LightShape::Spot { position, direction, inner_angle_deg: 50.0, outer_angle_deg: 60.0 },
        LightShape::Sphere { position, radius: 0.3 },
        LightShape::Disc { position, direction: DVec3::Z, radius: 0.0 },
        LightShape::Disc { position, direction: aside, radius: 0.3 },
        LightShape::Rect { position, direction: DVec3::Z, up: DVec3::Y, size: [0.6, 0.4].into(), texture: None },
        LightShape::Line { from: position, to: position + direction },
    ]
}

/// Pixels that are lit in a closed room, with what was asked for.
fn lit(scene: &Scene, id: &str, set: &str) -> Option<String> {
    let seen = visibility(&mut renderer(&gpu(), scene, 0, id, set, (120, 90)), scene);
    let lit = seen.data.iter().filter(|v| **v > 1e-3).count();
    let most = seen.data.iter().copied().fold(0.0, f32::max);
    (lit > 0).then(|| format!("{id}:{set} {:?}: {lit} pixels, up to {most}", scene.lights[0].shape))
}

#[test]
fn no_light_leaks_into_a_closed_room() {
    let [first, others @ ..] = &outside()[..] else { panic!("no light") };
    let scene = closed(first.clone());
    let mut wrong = Vec::new();
    for info in techniques().iter().filter(|info| info.id != "none") {
        let has_size = info.params().iter().any(|p| p.name == "size");
        wrong.extend(lit(&scene, info.id, if has_size { "size=256" } else { "" }));
    }
    for shape in others {
        let scene = closed(shape.clone());
        for (id, set) in [("pcss", "size=256"), ("pcss-jitter", "size=256,omni=tetrahedral"), ("light-mask", "")] {
            wrong.extend(lit(&scene, id, set));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn lights_without_extent_are_hard() {
    let gpu = gpu();
    let position = DVec3::new(1.0, 3.0, 1.0);
    let of_size = |r: f64| {
        let rect = |direction: DVec3| LightShape::Rect {
            position,
            direction,
            up: direction.any_orthonormal_vector(),
            size: [r, 0.5 * r].into(),
            texture: None,
        };
        vec![
            LightShape::Sphere { position, radius: r },
            LightShape::Ellipsoid { position, radii: DVec3::new(r, 0.5 * r, 0.1 * r), rotation: DMat3::IDENTITY },
            LightShape::Disc { position, direction: DVec3::NEG_Y, radius: r },
            LightShape::Disc { position, direction: DVec3::Z, radius: r },
            rect(DVec3::new(0.6, -0.8, 0.0)),
            LightShape::Line { from: position, to: position + DVec3::X * r },
        ]
    };
    let soft = ["pcss", "pcss-jitter", "wedges", "light-mask"];
    for id in soft {
        let seen = |shape: LightShape| {
            let mut scene = crate::robust::box_scene(shape);
            scene.camera.eye = DVec3::new(0.0, 3.0, 7.0);
            visibility(&mut renderer(&gpu, &scene, 0, id, "", (80, 60)), &scene)
        };
        let hard = seen(LightShape::Point { position });
        assert!(hard.data.iter().filter(|v| **v == 0.0).count() > 100, "{id}: no shadow");
        for shape in [0.0, 2e-9].into_iter().flat_map(of_size) {
            let what = format!("{id} {shape:?}");
            let other = seen(shape);
            let off = hard.data.iter().zip(&other.data).filter(|(a, b)| (**a - **b).abs() > 1e-3).count();
            assert!(off <= 2, "{what}: {off} pixels are not those of a point");
        }
    }
}
