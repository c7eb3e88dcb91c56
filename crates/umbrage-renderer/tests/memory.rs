//! Frames keep no memory. It is alone in this program, since the memory of a process is what all
//! of its tests take.

#![cfg(target_os = "linux")]

use umbrage::{Gpu, find};
use umbrage_core::scenes;
use umbrage_renderer::{LightPass, Renderer};

/// Kilobytes that this process holds.
fn held() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

#[test]
fn frames_keep_no_memory() {
    const FRAMES: u32 = 100;
    let gpu = Gpu::request(None).unwrap();
    let scene = (scenes::find("primitives").unwrap().build)(1.0);
    for id in ["none", "pcf", "silhouette-map", "volume", "wedges"] {
        let technique = find(id).unwrap().settings(&[]).unwrap().make(&gpu).unwrap();
        let mut renderer = Renderer::new(&gpu, &scene, 64, 48, vec![LightPass { light: 0, technique }]).unwrap();
        let mut frames = |count: u32| {
            for _ in 0..count {
                renderer.frame(&scene.camera).unwrap();
                renderer.wait().unwrap();
            }
        };
        frames(20);
        let before = held();
        frames(FRAMES);
        let grown = (held() - before) / f64::from(FRAMES);
        println!("{id}: {grown:.1} kB a frame");
        // A driver that compiles a shader again takes hundreds.
        assert!(grown < 40.0, "{id}: each frame keeps {grown:.0} kB");
    }
}
