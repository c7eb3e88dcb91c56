//! Devices with WebGPU's default limits and no optional feature: every technique works there, or
//! says what it lacks.

use crate::common::{gpu, pairs, scene};
use crate::wedges::difference;
use std::sync::{Arc, Mutex};
use umbrage::core::{Image, Scene};
use umbrage::{Error, Gpu, find, techniques};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (96, 72);

/// Settings that take other shaders and buffers than the defaults, beside those.
const SETS: &[(&str, &str)] = &[
    ("wedges", "batch=per-loop"),
    ("wedges", "batch=per-wedge"),
    ("wedges", "batch=per-wedge,cull=shader"),
    ("wedges", "combine=max"),
    ("wedges", "cull=stencil"),
    ("wedges", "split-light=2"),
    ("wedges", "scale=1/2"),
    ("wedges", "budget-ms=5"),
    ("wedges", "coverage=table"),
    ("wedges", "unseen=on"),
    ("volume", "extrude=vertex"),
    ("volume", "extrude=cpu"),
    ("volume", "count=z-fail,counter=float"),
    ("volume", "depth-bounds=on"),
    ("cascaded", "depth-fit=on"),
    ("cascaded", "filter=evsm"),
    ("evsm", "softness=light"),
];

/// A device of a host that asked for no feature and these limits, and what the driver complains of.
fn plain(limits: wgpu::Limits) -> (Gpu, Arc<Mutex<Vec<String>>>) {
    let (device, queue) = pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits.clone(), ..Default::default() };
        adapter.request_device(&descriptor).await.unwrap()
    });
    assert!(device.features().is_empty() && device.limits() == limits, "{:?}", device.limits());
    let complaints = Arc::new(Mutex::new(Vec::new()));
    let kept = complaints.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| kept.lock().unwrap().push(error.to_string())));
    (Gpu::new(device, queue), complaints)
}

/// Every technique at its defaults, and [`SETS`].
fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    techniques().iter().map(|t| (t.id, "")).chain(SETS.iter().copied())
}

/// One whose light takes all that the technique has.
fn scene_for(id: &str) -> Scene {
    if id == "cascaded" { scene("city", 0.3) } else { scene("contact", 1.0) }
}

fn picture(gpu: &Gpu, scene: &Scene, id: &str, set: &str) -> Result<Image<f32>, Error> {
    let info = find(id)?;
    let technique = info.settings(&pairs(set))?.make(gpu)?;
    let mut renderer = Renderer::new(gpu, scene, SIZE.0, SIZE.1, vec![LightPass { light: 0, technique }])?;
    renderer.frame(&scene.camera)?;
    renderer.visibility(0)
}

/// Whether a text names a feature or a limit as wgpu does.
fn names_what_is_lacking(text: &str) -> bool {
    let is_feature = |word: &str| word.contains('_') && wgpu::Features::from_name(word).is_some();
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .any(|word| is_feature(word) || word.starts_with("max_"))
}

#[test]
fn every_technique_works_or_says_what_is_lacking() {
    let (full, (plain, complaints)) = (gpu(), plain(wgpu::Limits::default()));
    let mut wrong = Vec::new();
    let mut works = 0;
    for (id, set) in all() {
        let scene = scene_for(id);
        match picture(&plain, &scene, id, set) {
            Ok(seen) => {
                let off = difference(&seen, &picture(&full, &scene, id, set).unwrap());
                works += 1;
                println!("{id} {set}: off by {off:.1e}");
                if off > 2e-3 {
                    wrong.push(format!("{id} {set}: off by {off:.1e}"));
                }
            }
            Err(error) if names_what_is_lacking(&error.to_string()) => println!("{id} {set}: {error}"),
            Err(error) => wrong.push(format!("{id} {set}: {error}, which names nothing that is lacking")),
        }
        wrong.extend(complaints.lock().unwrap().drain(..).map(|text| format!("{id} {set}: {text}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(works > techniques().len(), "only {works} work");
}

/// What the renderer takes itself.
const OF_RENDERER: u32 = 2;

fn storage_buffers(count: u32) -> wgpu::Limits {
    wgpu::Limits { max_storage_buffers_per_shader_stage: count, ..Default::default() }
}

#[test]
fn techniques_need_no_more_than_they_say() {
    let mut wrong = Vec::new();
    for info in techniques() {
        let mut needed = storage_buffers(0);
        (info.limits)(&mut needed);
        let count = needed.max_storage_buffers_per_shader_stage;
        let (gpu, complaints) = plain(storage_buffers(count.max(OF_RENDERER)));
        for (id, set) in all().filter(|(id, _)| *id == info.id) {
            if let Err(error) = picture(&gpu, &scene_for(id), id, set).map(drop)
                && !names_what_is_lacking(&error.to_string())
            {
                wrong.push(format!("{id} {set}: {error}"));
            }
            let complaints = std::mem::take(&mut *complaints.lock().unwrap());
            wrong.extend(complaints.first().map(|text| format!("{id} {set} with {count}: {text}")));
        }
        if count > 0 {
            let (gpu, _) = plain(storage_buffers(count - 1));
            let error = info.default_settings().make(&gpu).map(drop).unwrap_err().to_string();
            let limit = format!("max_storage_buffers_per_shader_stage is {} and has to be {count}", count - 1);
            assert!(error.contains(&limit), "{error}");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
