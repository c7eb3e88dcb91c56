//! The example of a host engine: a depth buffer that is finite and not reversed, and no normals.

#[path = "../../examples/bring_your_own_renderer.rs"]
mod bring_your_own_renderer;

use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Image, Light, LightShape, Material, Scene, primitive};
use umbrage_reference::{Options, Tracer};

#[test]
fn a_host_engine_gets_the_true_shadow() {
    bring_your_own_renderer::main().unwrap();
    let seen = bring_your_own_renderer::frames(1).unwrap();
    let (width, height) = seen.size();
    let mut scene = Scene::default();
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(8.0)));
    scene.place(cube, material, DAffine3::from_translation(DVec3::Y));
    let light = Light::new(LightShape::Point { position: DVec3::new(1.0, 4.0, 1.5) });
    // The host's projection scales heights by 2.
    let fov_y_deg = 2.0 * 0.5_f64.atan().to_degrees();
    let camera = Camera { eye: DVec3::new(0.0, 5.0, 6.0), near: 0.1, fov_y_deg, ..Camera::default() };
    let tracer = Tracer::new(&scene);
    let geometry = tracer.geometry(&camera, width, height);
    let truth = tracer.visibility(&geometry, &light, &[], &Options { samples: 1, ..Options::default() }, &|_, _| ());
    let off = Image::from_fn(width, height, |x, y| {
        let scored = truth.scored[(x, y)];
        scored && (seen[(x, y)] - truth.visibility[(x, y)]).abs() > 0.5
    });
    let wrong = off.data.iter().filter(|w| **w).count();
    let scored = truth.scored.data.iter().filter(|s| **s).count();
    println!("{wrong} of {scored} pixels differ");
    assert!(wrong * 1000 < scored, "{wrong} of {scored} pixels differ");
}

/// The host's own code apart, what is written for shadows is short: imports, and blocks under
/// comments that name the library or the casters, up to an empty line or what the host does next.
#[test]
fn what_a_host_adds_for_shadows_is_short() {
    let mut is_glue = false;
    let mut lines = Vec::new();
    for line in include_str!("../../examples/bring_your_own_renderer.rs").lines().map(str::trim) {
        if line.is_empty() || line.starts_with("//") {
            is_glue = ["// umbrage", "// The host's scene, as casters"].iter().any(|start| line.starts_with(start));
        } else if is_glue || line.starts_with("use umbrage") {
            lines.push(line);
        }
    }
    assert!(
        lines.iter().any(|line| line.contains("prepare(")) && lines.iter().any(|line| line.contains("Casters::new"))
    );
    println!("{} lines", lines.len());
    assert!(lines.len() <= 60, "{} lines:\n{}", lines.len(), lines.join("\n"));
}
