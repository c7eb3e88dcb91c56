//! What counts as visible: flags, masks, broken geometry; and that shortcuts change nothing.

use crate::scenes::{every_light, place, still_life};
use std::sync::atomic::{AtomicU64, Ordering};
use umbrage_core::glam::{DMat3, DVec2, DVec3, Vec2, Vec3, Vec4};
use umbrage_core::{Camera, Image, Light, LightShape, Material, Mesh, Sampling, Scene, Texture, primitive};
use umbrage_reference::{Options, Tracer, Truth};

const SIZE: (u32, u32) = (96, 72);

fn trace(scene: &Scene, light: &Light, options: Options) -> Truth {
    let tracer = Tracer::new(scene);
    let geometry = tracer.geometry(&scene.camera, SIZE.0, SIZE.1);
    tracer.visibility(&geometry, light, &scene.textures, &options, &|_, _| ())
}

fn options(samples: u32) -> Options {
    Options { samples, ..Options::default() }
}

/// Mean visibility of the scored pixels.
fn mean(truth: &Truth) -> f64 {
    let scored = truth.scored.data.iter().filter(|s| **s).count();
    truth.visibility.data.iter().map(|&v| f64::from(v)).sum::<f64>() / scored as f64
}

/// Leaves with holes over the still life.
fn with_leaves() -> Scene {
    let mut scene = still_life();
    let checker = |i: u32| [255, 255, 255, if (i % 8 / 2 + i / 16).is_multiple_of(2) { 255 } else { 0 }];
    scene.textures.push(Texture {
        name: "leaf".into(),
        width: 8,
        height: 8,
        rgba: (0..64).map(checker).collect(),
        sampling: Sampling::default(),
    });
    let material = Material { texture: Some(0), alpha_cutoff: Some(0.5), ..Material::default() };
    let material = Material { base_color: Vec4::ONE, ..material };
    place(&mut scene, primitive::plane(), DVec3::splat(2.0), DMat3::from_rotation_x(0.2), DVec3::new(0.2, 2.0, 0.2));
    let material = scene.add_material(material);
    let last = scene.instances.len() - 1;
    scene.instances[last].material = material;
    scene
}

#[test]
fn gathering_changes_no_bit() {
    let scene = with_leaves();
    let mut some_pass_by = false;
    for light in every_light() {
        let gathered = trace(&scene, &light, Options { samples: 40, gather: true, ..Options::default() });
        let plain = trace(&scene, &light, Options { samples: 40, gather: false, ..Options::default() });
        let name = light.shape.kind().name();
        assert!(gathered.visibility == plain.visibility && gathered.scored == plain.scored, "{name}");
        let visible = mean(&plain);
        assert!(visible > 0.3 && visible < 0.97, "{name}: mean visibility {visible}");
        assert!(gathered.rays <= plain.rays);
        some_pass_by |= gathered.rays < plain.rays / 2;
    }
    assert!(some_pass_by, "gathering spares rays");
}

#[test]
fn some_pixels_alone_are_what_they_are_among_all() {
    let (scene, light) = (still_life(), &every_light()[4]);
    let tracer = Tracer::new(&scene);
    let mask = Image::from_fn(32, 24, |x, y| (x + 3 * y) % 5 == 0);
    let (all, some) = (tracer.geometry(&scene.camera, 32, 24), tracer.geometry_where(&scene.camera, &mask));
    let trace = |geometry| tracer.visibility(geometry, light, &[], &options(16), &|_, _| ());
    let (whole, part) = (trace(&all), trace(&some));
    for (x, y) in (0..24).flat_map(|y| (0..32).map(move |x| (x, y))) {
        let wanted = mask[(x, y)].then(|| all.surface(x, y)).flatten();
        assert_eq!(some.surface(x, y), wanted, "at {x}, {y}");
        assert_eq!(part.scored[(x, y)], mask[(x, y)] && whole.scored[(x, y)]);
        assert!(!part.scored[(x, y)] || part.visibility[(x, y)] == whole.visibility[(x, y)]);
    }
}

#[test]
fn the_same_points_of_the_light_leave_no_noise() {
    // Half of the light is hidden, and that alike from points next to each other.
    let (scene, light) = (still_life(), &every_light()[4]);
    let near = Camera { fov_y_deg: 1e-4, ..scene.camera.clone() };
    let tracer = Tracer::new(&scene);
    let differ = [false, true].map(|same_points| {
        let penumbra =
            (0..40).map(|i| Camera { target: near.target + DVec3::new(0.05 * f64::from(i), 0.0, 0.3), ..near.clone() });
        let changes = penumbra.map(|camera| {
            let geometry = tracer.geometry(&camera, 8, 8);
            let options = Options { same_points, ..options(16) };
            let values = tracer.visibility(&geometry, light, &[], &options, &|_, _| ()).visibility.data;
            values.iter().filter(|v| **v != values[0]).count()
        });
        changes.sum::<usize>()
    });
    assert!(differ[0] > 20 && differ[1] == 0, "{differ:?}");
}

#[test]
fn lights_that_swallow_the_scene_and_half_the_sky_are_no_exception() {
    let scene = still_life();
    let lights = [
        LightShape::Sphere { position: DVec3::new(0.0, 3.0, 0.0), radius: 4.0 },
        LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 170.0 },
        LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 300.0 },
        LightShape::Sphere { position: DVec3::new(1e9, 2e9, 0.0), radius: 1e7 },
    ];
    for light in lights.map(Light::new) {
        let gathered = trace(&scene, &light, Options { samples: 40, gather: true, ..Options::default() });
        let plain = trace(&scene, &light, Options { samples: 40, gather: false, ..Options::default() });
        assert!(gathered.visibility == plain.visibility, "{light:?}");
        assert!(plain.visibility.data.iter().all(|v| (0.0..=1.0).contains(v)));
    }
}

#[test]
fn one_thread_gives_the_same_as_many_and_progress_ends_at_the_total() {
    let (scene, light) = (still_life(), &every_light()[4]);
    let many = trace(&scene, light, options(16));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let (largest, calls) = (AtomicU64::new(0), AtomicU64::new(0));
    let one = pool.install(|| {
        let tracer = Tracer::new(&scene);
        let geometry = tracer.geometry(&scene.camera, SIZE.0, SIZE.1);
        tracer.visibility(&geometry, light, &[], &options(16), &|done, total| {
            assert!(done <= total && total == u64::from(SIZE.0) * u64::from(SIZE.1));
            assert!(largest.fetch_max(done, Ordering::Relaxed) < done, "done pixels only grow");
            calls.fetch_add(1, Ordering::Relaxed);
        })
    });
    assert!(one == many);
    assert_eq!((largest.into_inner(), calls.into_inner()), (96 * 72, 72));
}

#[test]
fn one_sample_of_a_soft_light_is_the_hard_shadow_of_its_centre() {
    let scene = still_life();
    let lights = every_light();
    let point = trace(&scene, &lights[0], options(1024));
    assert_eq!(point.rays, point.scored.data.iter().filter(|s| **s).count() as u64, "a hard light needs one ray");
    for (soft, hard) in [(4, 0), (5, 0), (6, 0), (7, 0), (3, 2)] {
        let hard = trace(&scene, &lights[hard], options(9));
        assert!(trace(&scene, &lights[soft], options(1)) == hard, "{:?}", lights[soft].shape);
        assert!(trace(&scene, &lights[soft], options(0)) == hard, "{:?}", lights[soft].shape);
    }
}

#[test]
fn a_mask_lets_light_through_its_holes() {
    let light = &every_light()[4];
    let mut scene = with_leaves();
    let (material, last) = (scene.instances[4].material, scene.instances.len() - 1);
    let holes = mean(&trace(&scene, light, options(64)));
    scene.materials[material].alpha_cutoff = None;
    let opaque = mean(&trace(&scene, light, options(64)));
    scene.instances.truncate(last);
    let without = mean(&trace(&scene, light, options(64)));
    assert!(opaque + 0.02 < holes && holes + 0.02 < without, "opaque {opaque}, with holes {holes}, without {without}");
}

#[test]
fn a_mask_is_seen_through_by_the_camera() {
    let mut scene = Scene {
        camera: Camera { eye: DVec3::Z * 4.0, target: DVec3::ZERO, ..Camera::default() },
        textures: vec![Texture {
            name: "half".into(),
            width: 2,
            height: 1,
            rgba: vec![[0, 0, 0, 255], [0, 0, 0, 0]],
            sampling: Sampling::default(),
        }],
        ..Scene::default()
    };
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let quad = Mesh {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        // From the middle of the one texel to the middle of the other.
        uvs: corners.map(|(x, y)| Vec2::new(0.5 + x / 4.0, y)).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    };
    place(&mut scene, quad, DVec3::ONE, DMat3::IDENTITY, DVec3::ZERO);
    scene.materials[0] = Material { texture: Some(0), alpha_cutoff: Some(0.25), ..Material::default() };
    scene.materials[0].base_color.w = 1.0;
    let shown = |scene: &Scene| Tracer::new(scene).geometry(&scene.camera, 200, 200);
    let columns = |scene: &Scene| (0..200).filter(|&x| shown(scene).model[(x, 100)] == 0).count();
    // Alpha falls from 1 to 0 over the quad's width; three quarters are over the cutoff.
    let half_width = 100.0 / 4.0 / (22.5f64.to_radians().tan());
    assert!((columns(&scene) as f64 - 1.5 * half_width).abs() <= 1.0, "{} columns", columns(&scene));
    scene.materials[0].base_color.w = 0.5;
    assert!((columns(&scene) as f64 - half_width).abs() <= 1.0, "{} columns", columns(&scene));
    scene.materials[0].base_color.w = 0.0;
    assert_eq!(columns(&scene), 0);
}

#[test]
fn flags_of_lights_casters_and_receivers_count() {
    let mut scene = still_life();
    let mut light = every_light()[4].clone();
    let before = trace(&scene, &light, options(32));
    light.casts = false;
    let unshadowed = trace(&scene, &light, options(32));
    assert!(unshadowed.scored == before.scored && mean(&unshadowed) == 1.0);
    light.casts = true;

    scene.instances.iter_mut().for_each(|i| i.casts = false);
    assert_eq!(mean(&trace(&scene, &light, options(32))), 1.0);
    scene.instances[1].casts = true;
    let box_alone = mean(&trace(&scene, &light, options(32)));
    assert!(box_alone > mean(&before) && box_alone < 1.0, "{box_alone}");

    scene.instances[0].receives = false;
    let without_floor = trace(&scene, &light, options(32));
    let tracer = Tracer::new(&scene);
    let model = tracer.geometry(&scene.camera, SIZE.0, SIZE.1).model;
    let on_floor = without_floor.scored.data.iter().zip(&model.data).filter(|(scored, model)| **scored && **model == 0);
    assert_eq!(on_floor.count(), 0);
    assert!(without_floor.scored.data.iter().any(|s| *s));
}

#[test]
fn broken_triangles_are_left_out_and_an_empty_scene_shows_nothing() {
    let mut scene = still_life();
    let sound = Tracer::new(&scene).triangle_count();
    let broken = Mesh {
        positions: vec![Vec3::ZERO, Vec3::NAN, Vec3::X, Vec3::INFINITY, Vec3::Y],
        indices: vec![0, 1, 2, 0, 2, 3, 0, 2, 2, 0, 2, 99, 0, 2, 4],
        ..Mesh::default()
    };
    place(&mut scene, broken, DVec3::ONE, DMat3::IDENTITY, DVec3::Y * 9.0);
    assert_eq!(Tracer::new(&scene).triangle_count(), sound + 1);

    let empty = Scene { camera: scene.camera.clone(), ..Scene::default() };
    let truth = trace(&empty, &every_light()[4], options(8));
    assert!(truth.scored == Image::filled(SIZE.0, SIZE.1, false) && truth.rays == 0);
}

#[test]
fn rays_that_make_no_sense_are_not_blocked() {
    let tracer = Tracer::new(&still_life());
    let up = DVec3::Y.extend(0.0);
    assert!(tracer.blocked(DVec3::NEG_Y, up));
    assert!(tracer.blocked(DVec3::NEG_Y * 1e15, up), "from far below");
    assert!(tracer.blocked(DVec3::NEG_Y, (DVec3::Y * 1e15).extend(1.0)), "to far above");
    assert!(!tracer.blocked(DVec3::NEG_Y, (DVec3::NEG_Y * 0.5).extend(1.0)), "the floor is beyond the end");
    for (from, to) in [
        (DVec3::NAN, up),
        (DVec3::NEG_Y, DVec3::NAN.extend(1.0)),
        (DVec3::NEG_Y, DVec3::NEG_Y.extend(1.0)),
        (DVec3::NEG_Y, DVec3::ZERO.extend(0.0)),
        (DVec3::INFINITY, up),
    ] {
        assert!(!tracer.blocked(from, to), "from {from} to {to}");
    }
}

#[test]
fn a_bright_spot_on_a_textured_light_counts_for_more() {
    let mut scene = still_life();
    // The light's picture is black but for its left half, so that the light is as one of half the
    // width.
    let rgba = (0..16).map(|i| if i % 4 < 2 { [255; 4] } else { [0, 0, 0, 255] }).collect();
    scene.textures.push(Texture { name: "half lit".into(), width: 4, height: 4, rgba, sampling: Sampling::default() });
    let (position, direction, up) = (DVec3::new(0.0, 4.0, 0.0), DVec3::NEG_Y, DVec3::NEG_Z);
    let rect = |position, size, texture| {
        Light::new(LightShape::Rect { position, direction, up, size: DVec2::from(size), texture })
    };
    let textured = trace(&scene, &rect(position, (2.0, 0.5), Some(0)), options(1024));
    // Left for somebody who looks at the emitting side, from below with up = −Z.
    let left = position + direction.cross(up) * 0.5;
    let half = trace(&scene, &rect(left, (1.0, 0.5), None), options(1024));
    let other = trace(&scene, &rect(position * 2.0 - left, (1.0, 0.5), None), options(1024));
    let differ = |a: &Truth| {
        let pairs = a.visibility.data.iter().zip(&textured.visibility.data).zip(&textured.scored.data);
        pairs.filter(|((x, y), scored)| **scored && (*x - *y).abs() > 0.03).count()
    };
    assert!(differ(&half) < 10 && differ(&other) > 100, "{} and {}", differ(&half), differ(&other));
}

#[test]
fn a_surface_in_line_with_the_light_is_not_scored() {
    // The light is in the plane of a turned wall, where rounding alone would choose pixels; the
    // floor before it is scored.
    let turn = DMat3::from_rotation_y(0.3);
    let mut scene = Scene::default();
    place(&mut scene, primitive::plane(), DVec3::splat(10.0), DMat3::IDENTITY, DVec3::ZERO);
    let wall = DVec3::new(0.1, 1.3, -2.7);
    let upright = turn * DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2);
    place(&mut scene, primitive::plane(), DVec3::splat(3.0), upright, wall);
    scene.camera = Camera { eye: DVec3::new(1.0, 2.0, 5.0), target: DVec3::Y, ..Camera::default() };
    let position = wall + turn * DVec3::new(0.7, 1.9, 0.0);
    for shape in [LightShape::Point { position }, LightShape::Sphere { position, radius: 0.2 }] {
        let truth = trace(&scene, &Light::new(shape), options(4));
        let geometry = Tracer::new(&scene).geometry(&scene.camera, SIZE.0, SIZE.1);
        let scored = |model: i32| {
            let of_model = geometry.model.data.iter().zip(&truth.scored.data).filter(|(m, _)| **m == model);
            (of_model.clone().filter(|(_, scored)| **scored).count(), of_model.count())
        };
        let ((floor, floors), (wall, walls)) = (scored(0), scored(1));
        assert_eq!((floor, wall), (floors, 0));
        assert!(floors > 500 && walls > 500, "{floors} {walls}");
    }
}
