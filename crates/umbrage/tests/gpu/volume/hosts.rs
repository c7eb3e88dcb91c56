//! Devices with less, and hosts with depth buffers and projections of their own.

use super::depth_host::{Host, Projection, SIZE};
use super::{COUNTS, Target, assert_none, put, target};
use crate::common::{gpu, pairs, renderer};
use umbrage::core::glam::{DAffine3, DVec2, DVec3};
use umbrage::core::{Camera, Image, Light, LightShape, Scene, primitive};
use umbrage::{Gpu, find};
use umbrage_reference::Tracer;
use umbrage_renderer::{LightPass, Renderer};

/// A device of a host that asked for nothing.
fn plain_gpu() -> Gpu {
    let (device, queue) = pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        adapter.request_device(&Default::default()).await.unwrap()
    });
    assert!(device.features().is_empty(), "{:?}", device.features());
    Gpu::new(device, queue)
}

fn scene() -> Scene {
    let mut scene = super::floor(LightShape::Point { position: DVec3::new(1.0, 4.0, 1.5) });
    put(&mut scene, primitive::cube(), DAffine3::from_translation(DVec3::Y));
    put(&mut scene, primitive::sphere(16, 8), DAffine3::from_translation(DVec3::new(-2.0, 1.2, 0.5)));
    put(&mut scene, primitive::plane(), DAffine3::from_translation(DVec3::new(2.0, 1.2, -0.5)));
    scene
}

/// From outside, in a shadow, beneath a caster looking out, and with a near plane that cuts.
fn cameras() -> Vec<Camera> {
    let camera = |eye: [f64; 3], target: [f64; 3], near| Camera {
        eye: eye.into(),
        target: target.into(),
        fov_y_deg: 60.0,
        near,
        ..Camera::default()
    };
    vec![
        camera([0.0, 4.0, 6.0], [0.0, 0.0, 0.0], 0.1),
        camera([-0.4, 0.3, -0.6], [-2.0, 0.0, -2.0], 0.05),
        camera([2.2, 0.5, -0.8], [0.0, 0.3, 0.0], 0.1),
        camera([0.3, 1.4, 1.3], [0.0, 0.0, -0.5], 0.9),
        camera([0.1, 1.1, 0.0], [0.9, 0.7, 0.3], 0.05),
    ]
}

#[test]
fn a_device_without_features_gives_right_pictures() {
    let (gpu, scene) = (plain_gpu(), scene());
    let tracer = Tracer::new(&scene);
    let direction = DVec3::new(-0.4, -1.0, -0.2).normalize();
    let sun = Light::new(LightShape::Directional { direction, angle_deg: 0.0 });
    let mut wrong = Vec::new();
    for count in COUNTS {
        for rest in ["", "counter=float,extrude=vertex", "extrude=cpu,reach=infinite", "parallel=quads,cull=none"] {
            let mut renderer = renderer(&gpu, &scene, 0, "volume", &format!("{count},{rest}"), SIZE);
            for light in [&scene.lights[0], &sun] {
                *renderer.light_mut(0).unwrap() = light.clone();
                for camera in cameras() {
                    renderer.frame(&camera).unwrap();
                    let target = target(&tracer, &camera, light, SIZE, 60.0);
                    let what = format!("{count},{rest} from {}, {:?}", camera.eye, light.shape.kind());
                    wrong.extend(target.complaint(&what, &renderer.visibility(0).unwrap()));
                }
            }
        }
    }
    assert_none(&wrong);
}

#[test]
fn a_stencil_counter_without_a_stencil_is_a_clear_error() {
    let (gpu, scene) = (plain_gpu(), scene());
    let info = find("volume").unwrap();
    for set in ["counter=stencil", "stencil=two-pass"] {
        let technique = info.settings(&pairs(set)).unwrap().make(&gpu).unwrap();
        let mut renderer = Renderer::new(&gpu, &scene, 32, 24, vec![LightPass { light: 0, technique }]).unwrap();
        let error = renderer.frame(&scene.camera).expect_err("no stencil").to_string();
        assert!(error.contains("DEPTH32FLOAT_STENCIL8") && error.contains("counter=float"), "{set}: {error}");
    }
}

/// Complaints about all ways to count and all cameras.
fn complaints(gpu: &Gpu, format: wgpu::TextureFormat, projection: Projection, lends_stencil: bool) -> Vec<String> {
    let (host, scene) = (Host::new(gpu, format, projection), scene());
    let tracer = Tracer::new(&scene);
    let views: Vec<(Camera, Target)> =
        cameras().into_iter().map(|c| (c.clone(), target(&tracer, &c, &scene.lights[0], SIZE, 60.0))).collect();
    let all = views.iter().flat_map(|view| COUNTS.map(|count| (view, count)));
    let looked = all.filter_map(|((camera, target), count)| {
        let seen = host.visibility(&scene, camera, count, lends_stencil).unwrap();
        target.complaint(&format!("{format:?}, {projection:?}, {count}, from {}", camera.eye), &seen)
    });
    looked.collect()
}

#[test]
fn hosts_with_other_depths_and_projections_get_right_shadows() {
    use Projection::{Finite, FiniteReversed, InfiniteReversed};
    use wgpu::TextureFormat::{Depth24Plus, Depth24PlusStencil8, Depth32Float, Depth32FloatStencil8};
    let (full, plain) = (gpu(), plain_gpu());
    let mut wrong = Vec::new();
    for (gpu, what) in [(&full, "all features"), (&plain, "no features")] {
        for (format, projection) in [
            (Depth32Float, Finite),
            (Depth32Float, FiniteReversed),
            (Depth32Float, InfiniteReversed),
            (Depth24Plus, Finite),
            (Depth24PlusStencil8, Finite),
        ] {
            wrong.extend(complaints(gpu, format, projection, false).into_iter().map(|c| format!("{what}: {c}")));
        }
    }
    for projection in [Finite, InfiniteReversed] {
        wrong.extend(
            complaints(&full, Depth32FloatStencil8, projection, true).into_iter().map(|c| format!("lent: {c}")),
        );
    }
    assert_none(&wrong);
}

/// Truth for parallel lines of sight: of floor points that no caster hides, nor one near them.
fn parallel_target(host: &Host, scene: &Scene, camera: &Camera) -> Target {
    let tracer = Tracer::new(scene);
    let world_from_clip = host.camera(camera).clip_from_world().inverse();
    let seen = Image::from_fn(SIZE.0, SIZE.1, |x, y| {
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let share = pixel / DVec2::new(f64::from(SIZE.0), f64::from(SIZE.1));
        let ndc = DVec3::new(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.0);
        let (start, end) = (world_from_clip.project_point3(ndc), world_from_clip.project_point3(ndc.with_z(1.0)));
        let p = start + (end - start) * (start.y / (start.y - end.y));
        // Before the near plane there is nothing to see.
        let is_floor =
            start.y > 0.0 && end.y < 0.0 && p.x.abs() < 5.0 && p.z.abs() < 5.0 && !tracer.blocked(start, p.extend(1.0));
        is_floor.then_some(p)
    });
    let around =
        |x: u32, y: u32| (-1..=1).flat_map(move |i| (-1..=1).map(move |j| (i64::from(x) + i, i64::from(y) + j)));
    let mask =
        Image::from_fn(SIZE.0, SIZE.1, |x, y| around(x, y).all(|(x, y)| seen.get(x, y).is_none_or(Option::is_some)));
    let center = scene.lights[0].shape.center();
    let reference = seen.map(|p| if p.is_some_and(|p| !tracer.blocked(p, center)) { 1.0 } else { 0.0 });
    Target::new(reference, mask, false)
}

#[test]
fn parallel_lines_of_sight_get_right_shadows() {
    let gpu = gpu();
    let (host, scene) = (Host::new(&gpu, wgpu::TextureFormat::Depth32Float, Projection::Parallel), scene());
    let mut wrong = Vec::new();
    // From above all, and from below the casters and among them, which are then behind the eye.
    for (eye, toward) in [([4.0, 6.0, 5.0], [0.0; 3]), ([0.0, 0.4, 0.0], [0.5, 0.0, -0.4]), ([0.0, 1.5, 2.0], [0.0; 3])]
    {
        let camera = Camera { eye: eye.into(), target: toward.into(), ..Camera::default() };
        let target = parallel_target(&host, &scene, &camera);
        assert!(target.pixels().1 > 300, "{:?}", target.pixels());
        for count in COUNTS {
            let seen = host.visibility(&scene, &camera, count, false).unwrap();
            wrong.extend(target.complaint(&format!("{count} from {eye:?}"), &seen));
        }
    }
    assert_none(&wrong);
}

#[test]
fn parallel_lines_of_sight_without_depth_clamping_are_right_or_a_clear_error() {
    let (host, scene) = (Host::new(&plain_gpu(), wgpu::TextureFormat::Depth32Float, Projection::Parallel), scene());
    let camera = Camera { eye: DVec3::new(4.0, 6.0, 5.0), ..Camera::default() };
    match host.visibility(&scene, &camera, "", false) {
        Ok(seen) => assert_eq!(parallel_target(&host, &scene, &camera).complaint("a plain device", &seen), None),
        Err(error) => assert!(error.to_string().contains("DEPTH_CLIP_CONTROL"), "{error}"),
    }
}
