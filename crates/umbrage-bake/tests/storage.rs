//! Ways to store vectors against the vectors themselves.

use glam::{DAffine3, DVec3, Vec3};
use std::ops::ControlFlow;
use umbrage_bake::{Loss, Settings, Storage, bake, radiance, vectors};
use umbrage_core::harmonics::{Order, project};
use umbrage_core::transfer::{Kind, Stored, Transfer};
use umbrage_core::{Material, Scene, primitive, sampling::shift};

/// A ring on a floor, in three colours.
fn ring_on_floor() -> Transfer {
    let mut scene = Scene::default();
    let raised = DAffine3::from_scale_rotation_translation(
        DVec3::ONE,
        glam::DQuat::from_rotation_x(1.0),
        DVec3::new(0.0, 1.0, 0.0),
    );
    let wide = DAffine3::from_scale(DVec3::splat(4.0));
    for (mesh, place) in [(primitive::plane(), wide), (primitive::torus(0.7, 0.25, 24, 12), raised)] {
        let base_color = Vec3::new(0.8, 0.5, 0.3).extend(1.0);
        let (mesh, material) =
            (scene.add_mesh(mesh), scene.add_material(Material { base_color, ..Material::default() }));
        scene.place(mesh, material, place);
    }
    let kind = Kind::Interreflected { bounces: 1 };
    let settings = Settings { kind, rays: 32, detail: 20.0, order: Order::new(4).unwrap(), ..Settings::default() };
    bake(&scene, &settings, &|_, _| ControlFlow::Continue(())).expect("a transfer")
}

fn storage(text: &str) -> Storage {
    text.parse().expect("a way to store")
}

#[test]
fn more_components_and_more_clusters_lose_less_and_all_of_them_nothing() {
    let transfer = ring_on_floor();
    for mesh in &transfer.meshes {
        let (len, all) = (mesh.vector_len(transfer.order), vectors(mesh, transfer.order));
        let encode = |text: &str| storage(text).encode(&all, len);
        let lost = |text: &str| Loss::of(&encode(text), &all, len).relative;
        assert_eq!(lost("full"), 0.0);
        // Each of these rows loses less and less.
        for row in [
            &["pca:1", "pca:2", "pca:4", "pca:16", "pca:47"][..],
            &["vq:1", "vq:4", "vq:16", "vq:64"],
            &["vq:8", "cpca:8:1", "cpca:8:2", "cpca:8:4", "cpca:8:16"],
            &["pca:2", "cpca:4:2", "cpca:16:2", "cpca:64:2"],
        ] {
            let losses: Vec<f64> = row.iter().map(|text| lost(text)).collect();
            assert!(losses.is_sorted_by(|a, b| b < a), "{row:?}: {losses:?}");
        }
        for text in ["pca:48", "cpca:8:48"] {
            let loss = lost(text);
            assert!(loss < 1e-6, "all components are the whole: {text} loses {loss}");
        }
        assert!(lost("vq:4096") < 1e-7, "a vector for each is the whole");
        assert!(encode("cpca:8:4").bytes() < encode("full").bytes());
    }
}

#[test]
fn a_byte_is_off_by_half_its_step_at_most() {
    let transfer = ring_on_floor();
    let (mesh, len) = (&transfer.meshes[1], transfer.meshes[1].vector_len(transfer.order));
    let all = vectors(mesh, transfer.order);
    let stored = storage("bytes").encode(&all, len);
    let Stored::Bytes { scale, .. } = &stored else { panic!("{stored:?}") };
    let mut read = vec![0.0; len];
    for (point, vector) in all.chunks(len).enumerate() {
        stored.read(point, &mut read);
        for ((found, wanted), scale) in read.iter().zip(vector).zip(scale) {
            assert!((found - wanted).abs() <= 0.5001 * scale + 1e-6, "point {point}: {found} for {wanted}");
        }
    }
    assert_eq!(stored.bytes(), all.len() + 8 * len);
}

#[test]
fn a_sky_lights_clusters_once_and_points_as_their_vectors_say() {
    let full = ring_on_floor();
    let sky = |s: DVec3| Vec3::new(1.0, 0.5, 0.2) * (3.0 * (s.dot(DVec3::new(0.6, 0.8, 0.0)) - 1.0)).exp() as f32;
    let light = project(Order::new(5).unwrap(), 20, sky);
    for text in ["bytes", "pca:3", "vq:32", "cpca:8:3"] {
        let stored = storage(text).apply(&full);
        assert!(stored.is_whole() && stored.bytes() < full.bytes(), "{text}: {} bytes", stored.bytes());
        for mesh in &stored.meshes {
            let mut decoded = mesh.clone();
            decoded.stored = Stored::Full(vectors(mesh, full.order));
            let pairs = radiance(mesh, full.order, &light).into_iter().zip(radiance(&decoded, full.order, &light));
            let worst = pairs.map(|(a, b)| a.distance(b)).fold(0.0, f32::max);
            assert!(worst < 1e-5, "{text}: {worst}");
        }
    }
}

#[test]
fn points_in_two_planes_need_two_clusters_of_two_components() {
    // Without an assignment by the error of reconstruction, one cluster would get some of both.
    let normals = [[1.0, 2.0, 0.0, 0.0], [0.0, 1.0, 3.0, 0.0], [2.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 2.0]];
    let point = |i: u32| {
        let (u, pair) = (shift(i) - 0.5, 2 * (i as usize % 2));
        (0..4).map(move |k| (u.x * normals[pair][k] + u.y * normals[pair + 1][k] + pair as f64) as f32)
    };
    let points: Vec<f32> = (0..400).flat_map(point).collect();
    let lost = |text: &str| Loss::of(&storage(text).encode(&points, 4), &points, 4).relative;
    assert!(lost("cpca:2:2") < 1e-4 && lost("pca:2") > 0.05, "{} {}", lost("cpca:2:2"), lost("pca:2"));
}

#[test]
fn few_vectors_none_and_equal_ones_are_stored() {
    for text in ["full", "bytes", "pca:4", "vq:64", "cpca:64:4"] {
        for (vectors, len) in [(vec![], 9), (vec![], 0), (vec![0.25; 9], 9), (vec![0.0; 90], 9)] {
            let stored = storage(text).encode(&vectors, len);
            let points = vectors.len() / len.max(1);
            assert!(Loss::of(&stored, &vectors, len).worst < 1e-6, "{text}");
            assert!(points == 0 || stored.is_whole(points, len), "{text}: {stored:?}");
        }
    }
}
