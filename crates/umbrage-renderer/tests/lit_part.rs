//! Lights are left out where they light nothing that is seen, and shading is clipped to what they
//! light: the pictures stay as they are.

use umbrage::Gpu;
use umbrage::core::glam::DVec3;
use umbrage::core::{Camera, Light, LightShape, Scene, scenes};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (96, 72);

fn lamp(position: DVec3, range: f64) -> Light {
    Light { range: Some(range), ..Light::new(LightShape::Point { position }) }
}

/// Lamps in view, at its borders, around the eye and out of it, and spots.
fn lights() -> Vec<Light> {
    let spot = |position, direction| {
        let shape = LightShape::Spot { position, direction, inner_angle_deg: 20.0, outer_angle_deg: 30.0 };
        Light { range: Some(4.0), ..Light::new(shape) }
    };
    vec![
        lamp(DVec3::new(0.0, 1.5, 0.5), 2.0),
        lamp(DVec3::new(-2.5, 1.0, 0.0), 1.5),
        lamp(DVec3::new(2.0, 3.0, 3.0), 6.0),
        lamp(DVec3::new(0.0, 2.0, 6.0), 3.0),
        lamp(DVec3::new(0.0, 1.0, 70.0), 5.0),
        spot(DVec3::new(0.5, 2.5, 0.5), DVec3::new(0.3, -1.0, 0.0).normalize()),
        spot(DVec3::new(0.0, 2.5, 0.0), DVec3::Y),
    ]
}

fn renderer(gpu: &Gpu, scene: &Scene, technique: &str) -> Renderer {
    let settings = umbrage::parse(technique).unwrap();
    let pass = |light| LightPass { light, technique: settings.make(gpu).unwrap() };
    Renderer::new(gpu, scene, SIZE.0, SIZE.1, (0..scene.lights.len()).map(pass).collect()).unwrap()
}

fn scene() -> Scene {
    Scene { lights: lights(), ..(scenes::find("primitives").unwrap().build)(0.3) }
}

#[test]
fn clipping_changes_no_pixel() {
    let (gpu, scene) = (Gpu::request(None).unwrap(), scene());
    let eyes = [scene.camera.eye, DVec3::new(3.0, 1.0, 2.0), DVec3::new(0.2, 6.0, 0.1)];
    for technique in ["pcf:size=128", "volume", "wedges"] {
        let mut renderer = renderer(&gpu, &scene, technique);
        for eye in eyes {
            let camera = Camera { eye, ..scene.camera.clone() };
            let [clipped, whole] = [true, false].map(|clips| {
                renderer.set_clipping(clips);
                renderer.frame(&camera).unwrap();
                renderer.color().unwrap()
            });
            let lit = whole.data.iter().filter(|pixel| **pixel != whole.data[0]).count();
            assert!(lit > 500, "{technique}: there is something to see, {lit} pixels");
            let differ = clipped.data.iter().zip(&whole.data).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{technique} from {eye}");
        }
    }
}

#[test]
fn what_lights_nothing_that_is_seen_costs_nothing_until_it_does() {
    let (gpu, mut scene) = (Gpu::request(None).unwrap(), scene());
    scene.lights = vec![lamp(DVec3::new(0.0, 1.0, 70.0), 5.0), lamp(DVec3::new(0.0, 1.5, 0.5), 4.0)];
    let mut renderer = renderer(&gpu, &scene, "pcf:size=64");
    renderer.frame(&scene.camera).unwrap();
    assert_eq!(renderer.stats(0).draws, 0);
    assert!(renderer.stats(1).draws > 0);
    assert!(renderer.visibility(0).unwrap().data.iter().all(|v| *v == 1.0), "light that is left out is not in shadow");
    // It comes near, shadows, and goes again.
    renderer.light_mut(0).unwrap().shape = LightShape::Point { position: DVec3::new(0.5, 2.5, 0.5) };
    renderer.frame(&scene.camera).unwrap();
    assert!(renderer.stats(0).draws > 0);
    assert!(renderer.visibility(0).unwrap().data.iter().any(|v| *v < 0.5), "there is a shadow");
    renderer.light_mut(0).unwrap().shape = LightShape::Point { position: DVec3::new(0.0, 1.0, 70.0) };
    renderer.frame(&scene.camera).unwrap();
    assert!(renderer.visibility(0).unwrap().data.iter().all(|v| *v == 1.0), "nothing is left of it");
}
