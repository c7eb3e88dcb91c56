//! Contact shadows against closed forms: a wall on a floor, seen from the front, with the light
//! behind it.

use crate::common::{gpu, pairs, renderer, scene, visibility};
use umbrage::core::glam::{DAffine3, DMat3, DVec3};
use umbrage::core::{Camera, Image, Light, LightShape, Material, Scene, primitive};
use umbrage::{Contact, Error, Gpu, Length, LightPoints, contact_shadows, find};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (160, 120);

/// Metres that rays are long.
const REACH: f64 = 0.4;

/// A wall of 2 m at z = 0 on a floor, its front at z > 0, under light that comes from behind it.
fn wall(light: LightShape) -> Scene {
    let mut scene = Scene { lights: vec![Light::new(light)], ..Scene::default() };
    let (plane, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(plane, material, DAffine3::from_scale(DVec3::splat(20.0)));
    let place = DVec3::new(0.0, 1.0, -0.25);
    scene.place(
        cube,
        material,
        DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(8.0, 2.0, 0.5)), translation: place },
    );
    scene.camera = Camera {
        eye: DVec3::new(0.0, 1.6, 2.0),
        target: DVec3::new(0.0, 0.0, 0.4),
        up: DVec3::Y,
        fov_y_deg: 50.0,
        near: 0.05,
        ..Camera::default()
    };
    scene
}

/// Under no technique but contact shadows.
fn only_contact(gpu: &Gpu, scene: &Scene, contact: Contact) -> Image<f32> {
    let inner = find("none").unwrap().default_settings().make(gpu).unwrap();
    let technique = contact_shadows(gpu, inner, contact).unwrap();
    let mut renderer = Renderer::new(gpu, scene, SIZE.0, SIZE.1, vec![LightPass { light: 0, technique }]).unwrap();
    visibility(&mut renderer, scene)
}

/// Distance from the wall, z, of what each row of the middle column shows of the floor, with what
/// it sees of the light.
fn along_the_floor(scene: &Scene, seen: &Image<f32>) -> Vec<(f64, f32)> {
    let [_, up, forward] = scene.camera.axes();
    let half = (0.5 * scene.camera.fov_y_deg).to_radians().tan();
    let row = |y: u32| {
        let across = (1.0 - 2.0 * (f64::from(y) + 0.5) / f64::from(SIZE.1)) * half;
        let way = up * across + forward;
        (scene.camera.eye + way * (-scene.camera.eye.y / way.y), seen[(SIZE.0 / 2, y)])
    };
    (0..SIZE.1).map(row).filter(|(p, _)| p.z > 0.0 && p.z < 1.5).map(|(p, v)| (p.z, v)).collect()
}

#[test]
fn shadows_reach_as_far_as_rays_that_meet_the_wall() {
    let gpu = gpu();
    for slope in [0.7, 1.0, 1.6] {
        let toward = DVec3::new(0.0, slope, -1.0).normalize();
        let scene = wall(LightShape::Directional { direction: -toward, angle_deg: 0.0 });
        let contact = Contact::new(Length::Metres(REACH));
        let floor = along_the_floor(&scene, &only_contact(&gpu, &scene, contact));
        // A ray from z meets the wall after z / −toward.z metres.
        let end = REACH * -toward.z;
        let step = end / 16.0 + 0.03;
        assert!(floor.iter().any(|(z, _)| *z < 0.05) && floor.len() > 40, "{floor:?}");
        for (z, seen) in floor {
            assert!(z > end - step || seen == 0.0, "slope {slope}: {z} of {end} m sees {seen}");
            assert!(z < end + step || seen == 1.0, "slope {slope}: {z} of {end} m sees {seen}");
        }
    }
}

#[test]
fn light_from_before_the_wall_casts_nothing() {
    let gpu = gpu();
    for direction in [DVec3::new(0.0, -1.0, -1.0), DVec3::new(0.3, -0.02, -1.0), DVec3::NEG_Y] {
        let scene = wall(LightShape::Directional { direction: direction.normalize(), angle_deg: 0.0 });
        for length in [Length::Metres(REACH), Length::Pixels(40.0)] {
            let seen = only_contact(&gpu, &scene, Contact::new(length));
            let dark = seen.data.iter().filter(|v| **v < 1.0).count();
            assert!(dark <= 2, "{direction}: {dark} pixels are shadowed by nothing");
        }
    }
}

#[test]
fn lengths_in_pixels_are_as_many_on_the_picture() {
    let gpu = gpu();
    let scene = wall(LightShape::Directional { direction: DVec3::new(-1.0, -1e-3, 0.0).normalize(), angle_deg: 0.0 });
    // Light along the wall, a post on the floor in it.
    let mut scene = scene;
    let mesh = scene.instances[1].mesh;
    let material = scene.instances[1].material;
    scene.place(
        mesh,
        material,
        DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(0.1, 1.0, 0.1)), translation: DVec3::new(0.3, 0.5, 0.6) },
    );
    scene.lights[0].shape =
        LightShape::Directional { direction: DVec3::new(-1.0, -0.2, 0.0).normalize(), angle_deg: 0.0 };
    let widths = [8.0, 16.0].map(|pixels| {
        let contact = Contact { length: Length::Pixels(pixels), thickness: Length::Metres(0.1) };
        let seen = only_contact(&gpu, &scene, contact);
        seen.data.chunks(SIZE.0 as usize).map(|row| row.iter().filter(|v| **v == 0.0).count()).max().unwrap_or(0)
    });
    println!("{widths:?} pixels");
    assert!((5..=10).contains(&widths[0]) && (12..=19).contains(&widths[1]), "{widths:?}");
}

#[test]
fn the_gap_that_an_offset_leaves_is_closed() {
    let gpu = gpu();
    let toward = DVec3::new(0.0, 1.0, -1.0).normalize();
    let scene = wall(LightShape::Directional { direction: -toward, angle_deg: 0.0 });
    let settings = find("pcf").unwrap().settings(&pairs("size=512,offset=classic,constant=1.2")).unwrap();
    let [plain, closed] = [None, Some(Contact::new(Length::Metres(REACH)))].map(|contact| {
        let inner = settings.make(&gpu).unwrap();
        let technique = match contact {
            Some(contact) => contact_shadows(&gpu, inner, contact).unwrap(),
            None => inner,
        };
        let mut renderer =
            Renderer::new(&gpu, &scene, SIZE.0, SIZE.1, vec![LightPass { light: 0, technique }]).unwrap();
        along_the_floor(&scene, &visibility(&mut renderer, &scene))
    });
    let lit = |floor: &[(f64, f32)]| floor.iter().filter(|(z, v)| *z < 0.2 && *v > 0.0).count();
    println!("{} and {} rows lit beside the wall", lit(&plain), lit(&closed));
    assert!(lit(&plain) > 5 && lit(&closed) == 0, "{} and {}", lit(&plain), lit(&closed));
}

#[test]
fn contact_shadows_of_a_soft_light_are_soft() {
    let gpu = gpu();
    let scene = wall(LightShape::Sphere { position: DVec3::new(0.0, 3.0, -3.0), radius: 1.0 });
    let floor = along_the_floor(&scene, &only_contact(&gpu, &scene, Contact::new(Length::Metres(REACH))));
    let levels: std::collections::BTreeSet<u32> = floor.iter().map(|(_, v)| (v * 4.0) as u32).collect();
    assert!(levels.len() >= 3, "four points of the light give {levels:?} quarters");
    assert!(floor.iter().filter(|(z, _)| *z < 0.1).all(|(_, v)| *v == 0.0), "{floor:?}");
    // Brute force takes the contact shadows of each of its points.
    let settings = find("shadow-map").unwrap().settings(&pairs("size=64")).unwrap();
    let contact = Some(Contact::new(Length::Metres(REACH)));
    let [bare, closed] = [None, contact].map(|contact| {
        let technique = LightPoints { samples: 16, frames: None, contact }.average(&gpu, &settings).unwrap();
        let light = vec![LightPass { light: 0, technique }];
        let mut renderer = Renderer::new(&gpu, &scene, SIZE.0, SIZE.1, light).unwrap();
        visibility(&mut renderer, &scene)
    });
    assert!(bare.data.iter().zip(&closed.data).all(|(bare, closed)| closed <= bare));
}

#[test]
fn odd_pictures_and_lengths_are_right_or_refused() {
    let (gpu, scene) = (gpu(), scene("primitives", 0.2));
    let make = |length| {
        let inner = find("pcf").unwrap().default_settings().make(&gpu).unwrap();
        contact_shadows(&gpu, inner, Contact::new(length))
    };
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(make(Length::Metres(length)), Err(Error::Setting { .. })), "{length}");
    }
    let plain = |size| visibility(&mut renderer(&gpu, &scene, 0, "pcf", "", size), &scene);
    for size in [(1, 1), (3, 2), (2, 40)] {
        let technique = make(Length::Metres(1e5)).unwrap();
        let mut renderer =
            Renderer::new(&gpu, &scene, size.0, size.1, vec![LightPass { light: 0, technique }]).unwrap();
        let (seen, plain) = (visibility(&mut renderer, &scene), plain(size));
        assert!(seen.data.iter().zip(&plain.data).all(|(seen, plain)| (0.0..=*plain).contains(seen)), "{size:?}");
    }
}
