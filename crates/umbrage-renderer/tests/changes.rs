//! What changes between frames leaves pictures as a renderer made anew would draw them. Needs a
//! graphics adapter.

use umbrage::core::{Image, Scene};
use umbrage::fullscreen::{self, FLOATS, Fullscreen, attachment, bind, layout, target_texture};
use umbrage::{Error, Gpu, Param, ParamKind, Recorder, Shader, Technique, TechniqueInfo, find, read, techniques};
use umbrage_renderer::{LightPass, Renderer};
use wgpu::TextureFormat;

fn gpu() -> Gpu {
    Gpu::request(None).unwrap_or_else(|e| panic!("this test needs a graphics adapter: {e}"))
}

fn scene(id: &str) -> Scene {
    (umbrage::core::scenes::find(id).expect("a scene of the registry").build)(0.5)
}

fn make(gpu: &Gpu, id: &str, set: &[(&str, &str)]) -> Box<dyn Technique> {
    let info = find(id).unwrap();
    let set: Vec<_> = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    info.settings(&set).unwrap().make(gpu).unwrap()
}

/// A renderer with a technique for each of the first lights.
fn renderer(gpu: &Gpu, scene: &Scene, techniques: &[&str], size: (u32, u32)) -> Renderer {
    let pass = |(light, id): (usize, &&str)| LightPass { light, technique: make(gpu, id, &[]) };
    let passes = techniques.iter().enumerate().map(pass).collect();
    Renderer::new(gpu, scene, size.0, size.1, passes).unwrap()
}

fn color(renderer: &mut Renderer, scene: &Scene) -> Image<[u8; 4]> {
    renderer.frame(&scene.camera).unwrap();
    renderer.color().unwrap()
}

/// Objects alive on the device.
fn alive(gpu: &Gpu) -> Vec<(&'static str, isize)> {
    let hal = gpu.device.get_internal_counters().hal;
    vec![
        ("buffers", hal.buffers.read()),
        ("texture views", hal.texture_views.read()),
        ("bind groups", hal.bind_groups.read()),
        ("render pipelines", hal.render_pipelines.read()),
        ("shader modules", hal.shader_modules.read()),
    ]
}

const FIRST: (u32, u32) = (96, 72);
const SECOND: (u32, u32) = (72, 88);

#[test]
fn a_new_size_is_like_a_new_renderer() {
    let gpu = gpu();
    let scene = scene("primitives");
    for info in techniques().iter().filter(|info| info.lights.contains(scene.lights[0].shape.kind())) {
        let mut kept = renderer(&gpu, &scene, &[info.id], FIRST);
        assert_eq!(kept.technique(0).unwrap().answer(), info.answer(), "{}", info.id);
        let first = color(&mut kept, &scene);
        for size in [SECOND, FIRST] {
            kept.resize(size.0, size.1).unwrap();
            let picture = color(&mut kept, &scene);
            assert_eq!(picture.size(), size);
            assert_eq!(picture, color(&mut renderer(&gpu, &scene, &[info.id], size), &scene), "{} {size:?}", info.id);
        }
        // Away and back without a frame: of the old size, but other textures.
        kept.resize(SECOND.0, SECOND.1).unwrap();
        kept.resize(FIRST.0, FIRST.1).unwrap();
        assert_eq!(color(&mut kept, &scene), first, "{} there and back", info.id);
    }
}

#[test]
fn a_new_size_leaves_as_many_objects() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut renderer = renderer(&gpu, &scene, &["pcf"], FIRST);
    let objects = |renderer: &mut Renderer| {
        renderer.frame(&scene.camera).unwrap();
        renderer.wait().unwrap();
        // Upload memory goes round in a ring that is full after a few frames.
        alive(&gpu).into_iter().filter(|(what, _)| *what != "buffers").collect::<Vec<_>>()
    };
    let before = objects(&mut renderer);
    renderer.resize(SECOND.0, SECOND.1).unwrap();
    assert_eq!(objects(&mut renderer), before, "those of the old size are gone, and nothing else is new");
}

#[test]
fn a_size_that_can_not_be_changes_nothing() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut renderer = renderer(&gpu, &scene, &["pcf"], FIRST);
    let before = color(&mut renderer, &scene);
    let limit = gpu.device.limits().max_texture_dimension_2d;
    for (width, height) in [(0, 8), (8, limit + 1)] {
        assert!(matches!(renderer.resize(width, height), Err(Error::Size { .. })));
    }
    assert_eq!(color(&mut renderer, &scene), before);
}

#[test]
fn an_overlay_is_resized_too() {
    let gpu = gpu();
    let scene = scene("primitives");
    let overlaid = |size| {
        let mut renderer = renderer(&gpu, &scene, &["volume", "none"], size);
        renderer.set_overlay(Some(0.6)).unwrap();
        renderer
    };
    let mut kept = overlaid(FIRST);
    let dark = color(&mut kept, &scene);
    kept.resize(SECOND.0, SECOND.1).unwrap();
    assert_eq!(color(&mut kept, &scene), color(&mut overlaid(SECOND), &scene));
    kept.resize(FIRST.0, FIRST.1).unwrap();
    assert_eq!(color(&mut kept, &scene), dark);
    kept.set_overlay(None).unwrap();
    assert_ne!(color(&mut kept, &scene), dark);
}

#[test]
fn a_new_technique_for_one_light_leaves_the_others() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut kept = renderer(&gpu, &scene, &["volume", "none"], FIRST);
    let before = color(&mut kept, &scene);
    let of_first = kept.visibility(0).unwrap();
    kept.set_technique(1, make(&gpu, "shadow-map", &[])).unwrap();
    let after = color(&mut kept, &scene);
    assert_ne!(after, before, "the second light has shadows now");
    assert_eq!(after, color(&mut renderer(&gpu, &scene, &["volume", "shadow-map"], FIRST), &scene));
    assert_eq!(kept.visibility(0).unwrap(), of_first);
    let error = kept.set_technique(2, make(&gpu, "none", &[])).unwrap_err();
    assert!(error.to_string().contains("no light pass 2"), "{error}");
}

/// Another value than the default.
fn other_value(info: &TechniqueInfo, param: &Param) -> String {
    match param.kind {
        // Powers of two: some parameters take nothing else.
        ParamKind::Int { min, default, .. } => if default / 2 >= min { default / 2 } else { 2 * default }.to_string(),
        ParamKind::Float { min, max, default } => (0.5 * default + 0.5 * (default + 1.0).min(max)).max(min).to_string(),
        ParamKind::Choice { values } => values.last().unwrap().to_string(),
        ParamKind::Switch { default } => if default { "off" } else { "on" }.to_string(),
        ParamKind::Filter { .. } => panic!("{} {}: a filter is another technique", info.id, param.name),
    }
}

#[test]
fn a_new_setting_is_like_a_new_renderer() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut taken_over = 0;
    for info in techniques().iter().filter(|info| info.lights.contains(scene.lights[0].shape.kind())) {
        let mut kept = renderer(&gpu, &scene, &[info.id], FIRST);
        let before = color(&mut kept, &scene);
        // One more at a time, each drawn.
        let mut set = Vec::new();
        for param in info.params().iter().filter(|p| p.live) {
            set.push((param.name.to_string(), other_value(info, param)));
            taken_over += u32::from(kept.set_settings(0, &info.settings(&set).unwrap()).unwrap());
            kept.frame(&scene.camera).unwrap();
        }
        let passes = vec![LightPass { light: 0, technique: info.settings(&set).unwrap().make(&gpu).unwrap() }];
        let mut anew = Renderer::new(&gpu, &scene, FIRST.0, FIRST.1, passes).unwrap();
        assert_eq!(color(&mut kept, &scene), color(&mut anew, &scene), "{} {set:?}", info.id);
        kept.set_settings(0, &info.default_settings()).unwrap();
        assert_eq!(color(&mut kept, &scene), before, "{} as it was", info.id);
    }
    assert!(taken_over > 20, "{taken_over} settings were taken over without making the technique anew");
}

#[test]
fn settings_of_another_technique_make_that_one() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut kept = renderer(&gpu, &scene, &["volume", "none"], FIRST);
    let settings = find("pcf").unwrap().settings(&[("kernel".into(), "5".into())]).unwrap();
    assert_eq!(kept.set_settings(1, &settings), Ok(false));
    let passes = vec![
        LightPass { light: 0, technique: make(&gpu, "volume", &[]) },
        LightPass { light: 1, technique: make(&gpu, "pcf", &[("kernel", "5")]) },
    ];
    let mut anew = Renderer::new(&gpu, &scene, FIRST.0, FIRST.1, passes).unwrap();
    assert_eq!(color(&mut kept, &scene), color(&mut anew, &scene));
    assert!(kept.set_settings(2, &settings).is_err());
}

#[test]
fn hosts_draw_the_picture_by_its_view() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut renderer = renderer(&gpu, &scene, &["pcf"], FIRST);
    for size in [FIRST, SECOND] {
        renderer.resize(size.0, size.1).unwrap();
        let color = color(&mut renderer, &scene);
        assert_eq!((renderer.picture().width(), renderer.picture().height()), size);
        assert_eq!(copied(&gpu, renderer.picture_view(), size), color);
    }
}

/// What a pass of the host that reads `view` draws.
fn copied(gpu: &Gpu, view: &wgpu::TextureView, size: (u32, u32)) -> Image<[u8; 4]> {
    const COPY: &str = "// needs: fullscreen
        @group(0) @binding(0) var picture: texture_2d<f32>;
        @fragment fn copy(@builtin(position) at: vec4f) -> @location(0) vec4f {
            return textureLoad(picture, vec2i(at.xy), 0);
        }";
    let module = Shader::new("copy", COPY).module(gpu);
    let group = layout(gpu, "copy", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS)]);
    let target = target_texture(gpu, "copy", size, 1, TextureFormat::Rgba8UnormSrgb);
    let target_view = target.create_view(&Default::default());
    let pipeline = Fullscreen {
        label: "copy",
        module: &module,
        entry: "copy",
        groups: &[&group],
        target: target.format().into(),
        constants: &[],
    }
    .pipeline(gpu);
    let mut recorder = Recorder::new(gpu);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = recorder.begin(&mut encoder);
    let mut pass = passes.render("copy", &[attachment(&target_view, wgpu::LoadOp::Load)], None);
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bind(gpu, "copy", &group, &[wgpu::BindingResource::TextureView(view)]), &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    passes.finish();
    gpu.queue.submit([encoder.finish()]);
    read::rgba8(gpu, &target).unwrap()
}

#[test]
fn targets_of_a_host_get_the_same_picture() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut renderer = renderer(&gpu, &scene, &["pcf"], FIRST);
    let own = color(&mut renderer, &scene);
    for format in [TextureFormat::Rgba8UnormSrgb, TextureFormat::Rgba8Unorm, TextureFormat::Bgra8UnormSrgb] {
        let target = target_texture(&gpu, "a host's", FIRST, 1, format);
        renderer.frame_into(&scene.camera, &target.create_view(&Default::default()), format).unwrap();
        let is_reversed = format == TextureFormat::Bgra8UnormSrgb;
        let found = read::rgba8(&gpu, &target).unwrap();
        let found = found.map(|&[a, b, c, d]| if is_reversed { [c, b, a, d] } else { [a, b, c, d] });
        let differences = own.data.as_flattened().iter().zip(found.data.as_flattened());
        let largest = differences.map(|(a, b)| a.abs_diff(*b)).max();
        // The GPU's own encoding may round another way.
        assert!(largest <= Some(u8::from(!format.is_srgb())), "{format:?}: {largest:?}");
    }
}

#[test]
fn targets_that_do_not_fit_are_refused() {
    let gpu = gpu();
    let scene = scene("primitives");
    let mut renderer = renderer(&gpu, &scene, &[], FIRST);
    for (size, format, word) in [
        (SECOND, TextureFormat::Rgba8UnormSrgb, "72×88"),
        (FIRST, TextureFormat::R32Uint, "R32Uint"),
        (FIRST, TextureFormat::Depth32Float, "Depth32Float"),
    ] {
        let target = target_texture(&gpu, "a host's", size, 1, format).create_view(&Default::default());
        let error = renderer.frame_into(&scene.camera, &target, format).unwrap_err();
        assert!(matches!(error, Error::Scene(_)) && error.to_string().contains(word), "{error}");
    }
    renderer.frame(&scene.camera).unwrap();
    renderer.wait().unwrap();
}

#[test]
fn frames_make_nothing_whatever_they_are_drawn_to() {
    let gpu = gpu();
    let mut scene = scene("primitives");
    let mut renderer = renderer(&gpu, &scene, &["pcf", "volume"], FIRST);
    let targets = [TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8Unorm].map(|format| {
        let texture = target_texture(&gpu, "a host's", FIRST, 1, format);
        (texture.create_view(&Default::default()), format)
    });
    let mut frames = |count: u32| {
        for _ in 0..count {
            scene.camera.eye.x += 0.01;
            renderer.frame(&scene.camera).unwrap();
            renderer.wait().unwrap();
            for (view, format) in &targets {
                renderer.frame_into(&scene.camera, view, *format).unwrap();
                renderer.wait().unwrap();
            }
        }
    };
    frames(4);
    let before = alive(&gpu);
    assert!(before.iter().all(|(_, n)| *n > 0), "the counters of the device are off: {before:?}");
    frames(4);
    assert_eq!(alive(&gpu), before);
}
