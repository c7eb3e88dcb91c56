//! The frame loop makes nothing: no pipeline, view, buffer or bind group after the first frames.

use crate::common::{gpu, pairs, scene};
use umbrage::{find, light_samples, techniques};
use umbrage_renderer::{LightPass, Renderer};

/// Objects alive on the device. Upload memory goes round in a ring that is full after a few frames.
pub fn alive(gpu: &umbrage::Gpu) -> Vec<(&'static str, isize)> {
    let hal = gpu.device.get_internal_counters().hal;
    vec![
        ("buffers", hal.buffers.read()),
        ("texture views", hal.texture_views.read()),
        ("bind groups", hal.bind_groups.read()),
        ("render pipelines", hal.render_pipelines.read()),
        ("shader modules", hal.shader_modules.read()),
    ]
}

#[test]
fn nothing_is_created_after_the_first_frames() {
    let gpu = gpu();
    let scene = scene("primitives", 1.0);
    let brute = find("shadow-map").unwrap();
    let brute = light_samples(&gpu, &brute.settings(&pairs("size=64")).unwrap(), 8).unwrap();
    let plain = techniques().iter().map(|info| (info.id, info.settings(&[]).unwrap().make(&gpu).unwrap()));
    for (id, technique) in plain.chain([("light samples", brute)]) {
        let mut renderer = Renderer::new(&gpu, &scene, 160, 120, vec![LightPass { light: 0, technique }]).unwrap();
        let mut camera = scene.camera.clone();
        let mut frame = |i: i32| {
            camera.eye.x += 0.01 * f64::from(i);
            renderer.frame(&camera).unwrap();
            renderer.wait().unwrap();
        };
        (0..4).for_each(&mut frame);
        let before = alive(&gpu);
        assert!(before.iter().all(|(_, n)| *n > 0), "the counters of the device are off: {before:?}");
        (0..8).for_each(&mut frame);
        assert_eq!(alive(&gpu), before, "{id}");
    }
}
