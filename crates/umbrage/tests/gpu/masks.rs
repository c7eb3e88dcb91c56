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
        for (technique, set) in [("shadow-map", "size=2048"), ("pcf", "size=2048"), ("projective", ""), ("volume", "")]
        {
            let mut renderer = renderer(&gpu, &scene, 0, technique, set, SIZE);
            let right = score_frame(&mut renderer, &scene, 0, SIZE, 1);
            let wrong = score_frame(&mut renderer, &plain, 0, SIZE, 1);
            assert!(right.mae < 0.01, "{technique}, {name}: an error of {}", right.mae);
            assert!(wrong.mae > 2.0 * right.mae, "{technique}, {name}: {} and {}", right.mae, wrong.mae);
        }
    }
}

/// The card under a light, with a block beside it that casts as its triangles do.
fn card_and_block(shape: LightShape) -> Scene {
    let mut scene = card(Sampling::default(), Vec::new());
    let (block, plain) = (scene.add_mesh(primitive::cube()), scene.instances[0].material);
    let place = |at| DAffine3::from_scale_rotation_translation(DVec3::new(1.0, 0.4, 1.0), DQuat::IDENTITY, at);
    scene.place(block, plain, place(DVec3::new(1.5, 1.5, 1.0)));
    scene.place(block, plain, place(DVec3::new(-1.0, 4.0, 0.5)));
    scene.lights[0] = Light::new(shape);
    scene
}

#[test]
fn techniques_of_edges_and_triangles_leave_masked_casters_to_maps() {
    let gpu = gpu();
    let direction = DVec3::new(0.3, -1.0, 0.1).normalize();
    for (shape, techniques, samples) in [
        (LightShape::Point { position: DVec3::new(-1.0, 8.0, 0.5) }, vec!["volume", "wedges", "light-mask"], 1),
        (LightShape::Directional { direction, angle_deg: 2.0 }, vec!["wedges", "light-mask"], 256),
    ] {
        let scene = card_and_block(shape);
        for technique in techniques {
            let score =
                |set| score_frame(&mut renderer(&gpu, &scene, 0, technique, set, SIZE), &scene, 0, SIZE, samples);
            let (maps, whole) = (score(""), score("masked=whole"));
            println!("{technique}: {:.4}, whole {:.4}", maps.mae, whole.mae);
            assert!(maps.mae < 0.01, "{technique}: an error of {}", maps.mae);
            assert!(whole.mae > 3.0 * maps.mae, "{technique}: {} and, whole, {}", maps.mae, whole.mae);
        }
    }
}
