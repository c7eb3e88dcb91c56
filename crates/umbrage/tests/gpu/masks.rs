//! What shapes an alpha mask shapes it the same for the rasteriser and for the ray tracer.

use crate::common::{gpu, renderer, score_frame};
use umbrage::core::glam::{DAffine3, DQuat, DVec3, Vec2, Vec4};
use umbrage::core::{Camera, Filter, Light, LightShape, Material, Mesh, Sampling, Scene, Texture, Wrap, primitive};

const SIZE: (u32, u32) = (160, 120);

/// A card with an L in its picture over a floor, its texture coordinates from −1 to 2.
fn card(sampling: Sampling, opacities: Vec<f32>) -> Scene {
    let mut scene = Scene::default();
    let is_ink = |x: u32, y: u32| x == 0 || (y == 0 && x < 3);
    let rgba = (0..16).map(|i| [255, 255, 255, if is_ink(i % 4, i / 4) { 255 } else { 0 }]).collect();
    scene.textures.push(Texture { name: "L".into(), width: 4, height: 4, rgba, sampling });
    let floor = scene.add_mesh(primitive::plane());
    let plain = scene.add_material(Material::default());
    scene.place(floor, plain, DAffine3::from_scale(DVec3::splat(12.0)));
    let plane = primitive::plane();
    let uvs = plane.uvs.iter().map(|uv| *uv * 3.0 - Vec2::ONE).collect();
    let mesh = scene.add_mesh(Mesh { uvs, opacities, ..plane });
    let masked = Material { base_color: Vec4::ONE, texture: Some(0), alpha_cutoff: Some(0.5), ..Material::default() };
    let material = scene.add_material(masked);
    let lean = DQuat::from_rotation_x(0.2);
    scene.place(mesh, material, DAffine3::from_scale_rotation_translation(DVec3::splat(4.0), lean, DVec3::Y * 3.0));
    let direction = DVec3::new(0.3, -1.0, 0.1).normalize();
    scene.lights.push(Light::new(LightShape::Directional { direction, angle_deg: 0.0 }));
    scene.camera = Camera { eye: DVec3::new(2.0, 7.0, 7.0), target: DVec3::new(0.5, 0.5, 0.0), ..Camera::default() };
    scene
}

#[test]
fn samplers_and_opacities_of_vertices_are_those_of_the_truth() {
    let gpu = gpu();
    let plain = card(Sampling::default(), Vec::new());
    let wrap = |wrap| Sampling { wrap: [wrap, wrap], filter: Filter::Linear };
    for (name, scene) in [
        ("mirror", card(wrap(Wrap::Mirror), Vec::new())),
        ("clamp", card(wrap(Wrap::Clamp), Vec::new())),
        ("one of each", card(Sampling { wrap: [Wrap::Repeat, Wrap::Clamp], filter: Filter::Linear }, Vec::new())),
        ("nearest", card(Sampling { filter: Filter::Nearest, ..Sampling::default() }, Vec::new())),
        ("fading", card(Sampling::default(), vec![0.2, 1.5, 1.5, 0.2])),
    ] {
        for (technique, set) in [("shadow-map", "size=2048"), ("pcf", "size=2048"), ("projective", "")] {
            let mut renderer = renderer(&gpu, &scene, 0, technique, set, SIZE);
            let right = score_frame(&mut renderer, &scene, 0, SIZE, 1);
            let wrong = score_frame(&mut renderer, &plain, 0, SIZE, 1);
            assert!(right.mae < 0.01, "{technique}, {name}: an error of {}", right.mae);
            assert!(wrong.mae > 2.0 * right.mae, "{technique}, {name}: {} and {}", right.mae, wrong.mae);
        }
    }
}
