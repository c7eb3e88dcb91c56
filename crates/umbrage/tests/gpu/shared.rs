//! What all techniques of a device share: the second light of a kind compiles nothing.

use crate::common::{gpu, pairs, scene};
use crate::limits::lights;
use umbrage::core::glam::DVec3;
use umbrage::core::{Light, LightShape, Scene};
use umbrage::{PipelineKind, PipelineParts, StageParts, techniques};
use umbrage_renderer::{LightPass, Renderer};

/// Objects of the driver that take long to make, as the driver's own layer counts them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Made {
    pipelines: isize,
    modules: isize,
    layouts: isize,
    samplers: isize,
}

impl Made {
    fn on(device: &wgpu::Device) -> Self {
        let counted = device.get_internal_counters().hal;
        Self {
            pipelines: counted.render_pipelines.read() + counted.compute_pipelines.read(),
            modules: counted.shader_modules.read(),
            layouts: counted.bind_group_layouts.read() + counted.pipeline_layouts.read(),
            samplers: counted.samplers.read(),
        }
    }
}

/// Two lights of a kind, the first one again at another place.
fn two_lights(id: &str) -> Scene {
    let mut scene = scene(if id == "cascaded" { "city" } else { "contact" }, 0.3);
    let mut second = scene.lights[0].clone();
    if let LightShape::Point { position } | LightShape::Sphere { position, .. } = &mut second.shape {
        *position += DVec3::new(0.2, 0.1, 0.0);
    }
    scene.lights = vec![scene.lights[0].clone(), second];
    scene
}

#[test]
fn the_second_light_of_a_kind_compiles_nothing() {
    let mut wrong = Vec::new();
    for info in techniques() {
        let gpu = gpu();
        // wgpu itself has some.
        let others = Made::on(&gpu.device).pipelines;
        let scene = two_lights(info.id);
        let sized = info.params().iter().any(|param| param.name == "size");
        let settings = info.settings(&pairs(if sized { "size=64" } else { "" })).unwrap();
        let pass = |light| LightPass { light, technique: settings.make(&gpu).unwrap() };
        let mut one = Renderer::new(&gpu, &scene, 48, 36, vec![pass(0)]).unwrap();
        one.frame(&scene.camera).unwrap();
        let before = Made::on(&gpu.device);
        let mut two = Renderer::new(&gpu, &scene, 48, 36, vec![pass(0), pass(1)]).unwrap();
        two.frame(&scene.camera).unwrap();
        let after = Made::on(&gpu.device);
        gpu.wait().unwrap();
        println!("{}: {before:?}", info.id);
        if before.pipelines == 0 || after != before {
            wrong.push(format!("{}: {before:?}, then {after:?}", info.id));
        }
        let parts = gpu.pipelines();
        if parts.len() as isize != before.pipelines - others || !parts.iter().all(has_its_entries) {
            wrong.push(format!("{}: parts of {} pipelines, {others} of others", info.id, parts.len()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What is told of a pipeline is the text that it was compiled from.
fn has_its_entries(parts: &PipelineParts) -> bool {
    let has = |stage: &StageParts| {
        stage.entry.as_ref().is_some_and(|entry| stage.text.contains(&format!("fn {entry}(")))
            && stage.constants.iter().all(|(name, _)| stage.text.contains(&format!("override {name}")))
    };
    match &parts.kind {
        PipelineKind::Compute(stage) => has(stage),
        PipelineKind::Render(render) => has(&render.vertex) && render.fragment.iter().all(|(stage, _)| has(stage)),
    }
}

/// Every other kind.
fn some_lights() -> Vec<Light> {
    lights().into_iter().step_by(2).collect()
}

/// Scenes with all that casters and lights may be: one from beside, one from within a shadow.
fn scenes() -> [Scene; 3] {
    let mut contact = scene("contact", 0.3);
    let mut dark = scene("contact", 0.3);
    dark.camera.eye = dark.camera.target + DVec3::Y * 0.02;
    contact.lights = some_lights();
    [contact, scene("tentacles", 0.3), dark]
}

#[test]
fn what_was_made_ahead_is_all_that_the_first_frame_needs() {
    let scenes = scenes();
    let mut wrong = Vec::new();
    for info in techniques() {
        let gpu = gpu();
        let sized = info.params().iter().any(|param| param.name == "size");
        let settings = info.settings(&pairs(if sized { "size=64" } else { "" })).unwrap();
        let floor = || LightPass { light: 0, technique: umbrage::baseline::floor(&gpu) };
        let renderers = scenes.each_ref().map(|scene| {
            let mut renderer = Renderer::new(&gpu, scene, 32, 24, vec![floor()]).unwrap();
            renderer.frame(&scene.camera).unwrap();
            renderer
        });
        let does = |light: &&Light| info.supports(light.shape.kind()).is_ok();
        let lights: Vec<Light> = some_lights().iter().filter(does).cloned().collect();
        let mut ahead = settings.make(&gpu).unwrap();
        renderers[0].warm_up(&mut *ahead, &lights, &scenes[0].camera).unwrap();
        let before = Made::on(&gpu.device);
        for (mut renderer, scene) in renderers.into_iter().zip(&scenes) {
            for (light, of_scene) in scene.lights.iter().enumerate().filter(|(_, light)| does(light)) {
                renderer.exchange(0, LightPass { light, technique: settings.make(&gpu).unwrap() }).unwrap();
                renderer.frame(&scene.camera).unwrap();
                let after = Made::on(&gpu.device);
                if after != before {
                    let kind = of_scene.shape.kind().name();
                    wrong.push(format!("{} in {}, {kind}: {before:?}, then {after:?}", info.id, scene.name));
                }
            }
        }
        gpu.wait().unwrap();
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A light of 64 points has as many pipelines as one of two.
#[test]
fn points_of_a_light_share_their_pipelines() {
    let made = |samples: u32| {
        let (gpu, mut scene) = (gpu(), scene("contact", 0.3));
        scene.lights.truncate(1);
        scene.lights[0].shape = LightShape::Line { from: DVec3::new(-0.5, 3.0, 0.0), to: DVec3::new(0.5, 3.0, 0.0) };
        let settings = umbrage::parse(&format!("linear-light:size=16:samples={samples}")).unwrap();
        let technique = settings.make(&gpu).unwrap();
        let mut renderer = Renderer::new(&gpu, &scene, 16, 12, vec![LightPass { light: 0, technique }]).unwrap();
        renderer.frame(&scene.camera).unwrap();
        gpu.wait().unwrap();
        Made::on(&gpu.device)
    };
    let (few, many) = (made(3), made(64));
    assert_eq!(few, many);
    assert!(few.pipelines > 2, "{few:?}");
}

/// What is kept for techniques to come goes with the device's last `Gpu`.
#[test]
fn nothing_outlives_the_last_gpu() {
    let gpu = gpu();
    let device = gpu.device.clone();
    let at_start = Made::on(&device);
    let technique = umbrage::parse("pcf:size=64").unwrap().make(&gpu).unwrap();
    let scene = scene("contact", 0.3);
    let mut renderer = Renderer::new(&gpu, &scene, 16, 12, vec![LightPass { light: 0, technique }]).unwrap();
    renderer.frame(&scene.camera).unwrap();
    gpu.wait().unwrap();
    assert_ne!(Made::on(&device), at_start);
    drop((renderer, gpu));
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    assert_eq!(Made::on(&device), at_start);
}
