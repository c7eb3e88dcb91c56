//! What users of engines complained of that no scene file can say.

use crate::host::{LAMP, SIZE, Target, Truth, depth_texture, finite, frame, gpu, layer, point, scene, seen, technique};
use umbrage::core::glam::{DAffine3, DMat4, DVec3, DVec4};
use umbrage::core::{Camera, CameraView, Image, Light, LightShape, Material, Scene, primitive};
use umbrage::{Casters, Gpu, Receivers, Technique, View, VisibilityTarget, find};

/// One of each family for hard lights.
const HARD: [&str; 8] = ["pcf", "evsm", "cascaded", "lispsm", "smoothies", "projective", "volume", "wedges"];

fn sun() -> LightShape {
    LightShape::Directional { direction: DVec3::new(-0.4, -1.0, -0.3).normalize(), angle_deg: 0.0 }
}

/// Boxes `at` places on a floor of this width, under a light.
fn boxes(width: f64, at: impl Iterator<Item = (DVec3, DVec3)>, shape: LightShape) -> Scene {
    let mut scene = Scene::default();
    let [floor, cube] = [primitive::plane(), primitive::cube()].map(|mesh| scene.add_mesh(mesh));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::new(width, 1.0, width)));
    for (place, size) in at {
        let placed = DAffine3::from_translation(place + DVec3::Y * (0.5 * size.y)) * DAffine3::from_scale(size);
        scene.place(cube, material, placed);
    }
    scene.lights.push(Light::new(shape));
    scene
}

/// From (25, 25, 25) to the origin, 21.6 m high, from 500 m behind the eye to 1000 m before it: a
/// tower between the lines of sight that is all behind the eye is seen, and so is its shadow.
#[test]
fn a_parallel_camera_sees_what_is_behind_its_eye() {
    let gpu = gpu();
    let forward = -DVec3::ONE.normalize();
    let eye = DVec3::splat(25.0);
    let behind = eye + DVec3::new(5.0, 2.0, 4.0);
    assert!((behind + DVec3::Y * 4.0 - eye).dot(forward) < 0.0);
    let at = [(DVec3::new(-1.0, 0.0, 1.0), DVec3::new(3.0, 9.0, 3.0)), (behind, DVec3::new(5.0, 0.3, 5.0))];
    let above = (behind + DVec3::Y * 2.0, DVec3::new(2.0, 1.0, 2.0));
    let aside = DVec3::new(0.7, -1.0, -0.5).normalize();
    let shape = LightShape::Directional { direction: aside, angle_deg: 0.0 };
    let scene = boxes(60.0, at.into_iter().chain([above]), shape);
    let depth = 1.0 / 1500.0;
    let (half, aspect) = (10.8, f64::from(SIZE.0) / f64::from(SIZE.1));
    let clip_from_view = DMat4::from_cols(
        DVec4::X / (half * aspect),
        DVec4::Y / half,
        DVec4::Z * depth,
        DVec4::new(0.0, 0.0, 1000.0 * depth, 1.0),
    );
    let camera = Camera { eye, target: DVec3::ZERO, ..Camera::default() };
    let view = CameraView::from_matrices(camera.view_from_world(), clip_from_view);
    let truth = Truth::of(&scene, &camera.with_parallel(21.6, -500.0, 1000.0), SIZE);
    let dark = truth.visibility.data.iter().filter(|v| **v < 0.5).count();
    assert!(dark > 150, "{dark} pixels of shadow");
    for id in HARD.into_iter().chain(["light-mask"]) {
        let error = truth.error(&seen(&gpu, &mut *technique(&gpu, id), &scene, &view, SIZE, true).unwrap());
        println!("{id}: {error:.4}");
        let most = match id {
            "volume" | "wedges" | "light-mask" => 0.001,
            // It leaves out planes that are small on the screen.
            "projective" => 0.006,
            _ => 0.003,
        };
        assert!(error < most + truth.shifted(&gpu), "{id}: {error:.4}");
    }
}

#[test]
fn a_far_plane_at_a_million_metres_costs_nothing() {
    let gpu = gpu();
    let at = [(-14.0, -5.0, 9.0), (8.0, 6.0, 14.0), (2.0, -22.0, 20.0)];
    let at = at.map(|(x, z, h)| (DVec3::new(x, 0.0, z), DVec3::new(8.0, h, 8.0)));
    let mut scene = boxes(120.0, at.into_iter(), sun());
    scene.camera = Camera { eye: DVec3::new(5.0, 35.0, 60.0), target: DVec3::ZERO, near: 10.0, ..Camera::default() };
    let truth = Truth::of(&scene, &scene.camera, SIZE);
    for id in HARD {
        let mut technique = technique(&gpu, id);
        let mut error =
            |view: &CameraView| truth.error(&seen(&gpu, &mut *technique, &scene, view, SIZE, true).unwrap());
        let plain = error(&scene.camera.view(SIZE.0, SIZE.1));
        for is_reversed in [false, true] {
            let found = error(&finite(&scene.camera, SIZE, [10.0, 1e6], is_reversed));
            println!("{id}, reversed {is_reversed}: {found:.4}, with an infinite far plane {plain:.4}");
            assert!(found < 1.2 * plain + 0.001, "{id}, reversed {is_reversed}: {found:.4}, {plain:.4}");
        }
    }
}

/// Frames of one technique with casters that are kept.
struct Frames<'a> {
    gpu: &'a Gpu,
    technique: Box<dyn Technique>,
    casters: Casters,
    depth: wgpu::TextureView,
    receivers: Receivers,
}

impl<'a> Frames<'a> {
    fn new(gpu: &'a Gpu, scene: &Scene, id: &str, set: &[(&str, &str)]) -> Self {
        let set: Vec<_> = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
        let technique = find(id).unwrap().settings(&set).unwrap().make(gpu).unwrap();
        let depth = layer(&depth_texture(gpu, SIZE, 1, 1), 0);
        let receivers = Receivers::new(gpu, &depth, None, SIZE).unwrap();
        Self { gpu, technique, casters: Casters::new(gpu, scene).unwrap(), depth, receivers }
    }

    fn draw(&mut self, scene: &Scene, camera: &Camera) -> Image<f32> {
        let camera = camera.view(SIZE.0, SIZE.1);
        let target = VisibilityTarget::new(self.gpu, SIZE.0, SIZE.1).unwrap();
        frame(self.gpu, |passes| {
            Target::of(&self.depth).draw(self.gpu, passes.encoder(), scene, &camera);
            self.casters.record(passes).unwrap();
            let light = &scene.lights[0];
            let view = View { camera, receivers: &self.receivers, casters: &self.casters, light, textures: &[] };
            self.technique.prepare(self.gpu, &view).unwrap().record(passes, &target).unwrap();
        });
        target.read(self.gpu).unwrap()
    }
}

#[test]
fn a_kept_point_light_is_right_after_the_camera_looked_away() {
    let gpu = gpu();
    let mut scene = scene(point());
    scene.lights[0].range = Some(9.0);
    let inside = scene.camera.clone();
    assert!(inside.eye.distance(LAMP) < 9.0);
    let out = inside.eye + (inside.eye - inside.target) * 2.0;
    assert!(out.distance(LAMP) > 9.0);
    let outside = Camera { eye: out, fov_y_deg: 16.0, ..inside.clone() };
    for (camera, focus) in [(&inside, "visible"), (&inside, "light"), (&outside, "visible"), (&outside, "light")] {
        let truth = Truth::of(&scene, camera, SIZE);
        let mut frames =
            Frames::new(&gpu, &scene, "shadow-map", &[("cache", "on"), ("focus", focus), ("size", "1024")]);
        let first = frames.draw(&scene, camera);
        // Upwards, where nothing is; along the floor; and back.
        let away = Camera { target: camera.eye + DVec3::new(0.1, 5.0, 0.0), ..camera.clone() };
        let along = Camera { target: camera.eye + DVec3::new(9.0, -0.5, 9.0), ..camera.clone() };
        for other in [&away, &along, &away] {
            frames.draw(&scene, other);
        }
        let back = frames.draw(&scene, camera);
        let (before, after) = (truth.error(&first), truth.error(&back));
        println!("focus={focus}: {before:.4}, then {after:.4}");
        assert!(before < 0.003, "focus={focus}: {before:.4}");
        assert_eq!(first.data, back.data, "focus={focus}");
    }
}

/// The tentacles stand behind the eye; what is seen of them is the shadow that they cast past the
/// camera.
#[test]
fn a_skinned_caster_behind_the_camera_casts_its_shadow_into_view() {
    let gpu = gpu();
    let mut scene = (umbrage::core::scenes::find("tentacles").unwrap().build)(0.3);
    let position = DVec3::new(0.0, 4.0, 5.0);
    scene.lights = vec![Light::new(LightShape::Point { position })];
    scene.camera = Camera {
        eye: DVec3::new(0.3, 2.2, -2.6),
        target: DVec3::new(0.3, 0.0, -5.0),
        fov_y_deg: 60.0,
        ..Camera::default()
    };
    let frustum = scene.camera.view(SIZE.0, SIZE.1).frustum();
    for instance in scene.instances.iter().filter(|instance| instance.pose.is_some()) {
        let bounds = scene.instance_bounds(instance);
        assert!(!frustum.may_see(&bounds) && bounds.min.z > scene.camera.eye.z, "a tentacle is before the camera");
    }
    let truth = Truth::of(&scene, &scene.camera, SIZE);
    let dark = truth.visibility.data.iter().filter(|v| **v < 0.5).count();
    assert!(dark > 300, "{dark} pixels of shadow");
    for id in HARD {
        let view = scene.camera.view(SIZE.0, SIZE.1);
        let error = truth.error(&seen(&gpu, &mut *technique(&gpu, id), &scene, &view, SIZE, true).unwrap());
        println!("{id}: {error:.4}");
        let most = if matches!(id, "volume" | "wedges") { 0.001 } else { 0.006 };
        assert!(error < most, "{id}: {error:.4}");
    }
}

/// Of 1,000 boxes the camera sees 3; 50 more, beside the picture, cast their shadows into it.
#[test]
fn of_a_thousand_instances_those_are_drawn_whose_shadows_are_seen() {
    let gpu = gpu();
    let pole = DVec3::new(0.13, 3.0, 0.13);
    let seen_boxes = [-1.5, 0.0, 1.5].map(|x| (DVec3::new(x, 0.0, 0.0), DVec3::splat(0.5)));
    // Beside the picture, towards the light, in two rows.
    let beside = (0..50).map(|i| {
        let (row, place) = (f64::from(i / 25), f64::from(i % 25));
        (DVec3::new(5.8 + row, 0.0, -3.4 + 0.28 * place), pole)
    });
    let far = (0..947).map(|i| {
        let (turn, distance) = (f64::from(i) * 2.4, 60.0 + 0.05 * f64::from(i));
        (DVec3::new(turn.cos() * distance, 0.0, turn.sin() * distance), DVec3::ONE)
    });
    let direction = DVec3::new(-1.0, -0.4, 0.0).normalize();
    let shape = LightShape::Directional { direction, angle_deg: 0.0 };
    let mut scene = boxes(400.0, seen_boxes.into_iter().chain(beside).chain(far), shape);
    scene.camera =
        Camera { eye: DVec3::new(0.0, 9.0, 0.01), target: DVec3::ZERO, up: DVec3::NEG_Z, ..Camera::default() };
    assert_eq!(scene.instances.len(), 1001);
    let view = scene.camera.view(SIZE.0, SIZE.1);
    let frustum = view.frustum();
    let visible = scene.instances[1..].iter().filter(|i| frustum.may_see(&scene.instance_bounds(i))).count();
    assert_eq!(visible, 3);
    let truth = Truth::of(&scene, &scene.camera, SIZE);
    for (id, set, most) in [
        ("shadow-map", vec![("size", "2048")], 0.02),
        ("cascaded", vec![("size", "2048")], 0.02),
        ("volume", vec![], 0.001),
        ("wedges", vec![], 0.001),
    ] {
        let mut frames = Frames::new(&gpu, &scene, id, &set);
        let error = truth.error(&frames.draw(&scene, &scene.camera));
        let (stats, shifted) = (frames.technique.inside().stats(), truth.shifted(&gpu));
        println!("{id}: {error:.4}, by shifted edges {shifted:.4}, {stats:?}");
        assert!(error < most + shifted, "{id}: {error:.4}, by shifted edges {shifted:.4}");
        assert!(stats.casters_drawn >= 53 && stats.casters_culled >= 800, "{id}: {stats:?}");
    }
}

/// A sun moves by 0.0042° a second. No map is kept for the one of the frame before, and after many
/// frames a technique says what a new one says.
#[test]
fn a_sun_that_creeps_is_followed() {
    let gpu = gpu();
    let mut scene = scene(sun());
    let camera = scene.camera.clone();
    let at = |frame: u32| {
        let turned = DAffine3::from_rotation_y((0.0042 * f64::from(frame)).to_radians());
        let LightShape::Directional { direction, .. } = sun() else { unreachable!() };
        LightShape::Directional { direction: turned.transform_vector3(direction), angle_deg: 0.0 }
    };
    for (id, set) in [
        ("shadow-map", vec![("cache", "on"), ("focus", "light"), ("size", "512")]),
        ("cascaded", vec![("cache", "on"), ("size", "512")]),
        ("volume", vec![]),
    ] {
        let mut frames = Frames::new(&gpu, &scene, id, &set);
        let mut last = None;
        for frame in 0..40 {
            scene.lights[0].shape = at(frame);
            last = Some(frames.draw(&scene, &camera));
        }
        let anew = Frames::new(&gpu, &scene, id, &set).draw(&scene, &camera);
        let truth = Truth::of(&scene, &camera, SIZE);
        let (crept, anew) = (truth.error(&last.unwrap()), truth.error(&anew));
        println!("{id}: {crept:.5}, anew {anew:.5}");
        assert!(crept < anew + 0.0005 && crept < 0.004, "{id}: {crept:.5}, anew {anew:.5}");
    }
}
