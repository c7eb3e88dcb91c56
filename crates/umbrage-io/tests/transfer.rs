//! Baked transfer in files of others, read again.

use glam::{DAffine3, DVec3, Vec2};
use std::fs;
use umbrage_core::harmonics::Order;
use umbrage_core::transfer::{BakedMesh, Cluster, Codes, Kind, Points, Sides, Stored, Transfer};
use umbrage_core::{Material, Scene, primitive};
use umbrage_io::{open_transfer, save_transfer};

fn scene() -> Scene {
    let mut scene = Scene::default();
    let (mesh, material) = (scene.add_mesh(primitive::plane()), scene.add_material(Material::default()));
    scene.place(mesh, material, DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0)));
    scene
}

/// A plane of both sides, and as many numbers as its eight points have.
fn transfer(order: u32, channels: usize, stored: impl Fn(Vec<f32>, usize) -> Stored) -> Transfer {
    let order = Order::new(order).unwrap();
    let len = channels * order.functions();
    let values = (0..8 * len).map(|i| (i as f32).sin()).collect();
    let kind = if channels == 3 { Kind::Interreflected { bounces: 2 } } else { Kind::Shadowed };
    let mesh = umbrage_core::Mesh { name: String::new(), ..primitive::plane() };
    let (points, sides) = (Points::Vertices, Sides::Both);
    let mesh = BakedMesh { instance: 0, mesh, points, sides, channels, stored: stored(values, len) };
    let transfer = Transfer { order, kind, meshes: vec![mesh] };
    assert!(transfer.is_whole());
    transfer
}

fn again(transfer: &Transfer, name: &str) -> Transfer {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join(name);
    save_transfer(&path, transfer, &scene()).unwrap();
    open_transfer(&path).unwrap()
}

#[test]
fn what_is_written_is_read_again() {
    for (order, channels) in [(1, 1), (5, 1), (4, 3), (10, 3)] {
        let full = transfer(order, channels, |values, _| Stored::Full(values));
        assert_eq!(again(&full, "a.npz"), full);
        assert_eq!(again(&full, "a.glb"), full);
    }
    let bytes = transfer(3, 1, |values, len| Stored::Bytes {
        bias: vec![-1.0; len],
        scale: vec![0.5; len],
        bytes: values.iter().map(|v| (v * 100.0 + 100.0) as u8).collect(),
    });
    assert_eq!(again(&bytes, "a.npz"), bytes);
    for k in [0, 2] {
        let clustered = transfer(3, 3, |values, len| {
            let cluster = |at: usize| Cluster { mean: values[at..at + len].into(), vectors: values[..k * len].into() };
            let codes = Codes { cluster: vec![0, 1, 1, 0, 0, 0, 1, 0], vectors: k, weights: values[..8 * k].into() };
            Stored::Clustered { clusters: vec![cluster(0), cluster(len)], codes }
        });
        assert_eq!(again(&clustered, "a.npz"), clustered);
    }
}

#[test]
fn texels_go_into_arrays_and_not_into_attributes() {
    let mut texels = transfer(2, 1, |values, _| Stored::Full(values));
    texels.meshes[0].points = Points::Texels { width: 2, height: 2, uvs: vec![Vec2::new(0.25, 0.75); 4] };
    assert_eq!(again(&texels, "a.npz"), texels);
    let place = tempfile::tempdir().unwrap();
    let error = save_transfer(&place.path().join("a.glb"), &texels, &scene()).unwrap_err().to_string();
    assert!(error.contains("texels") && error.contains(".npz"), "{error}");
}

#[test]
fn a_binary_gltf_with_a_transfer_is_a_model_as_any_other() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    save_transfer(&path, &transfer(5, 1, |values, _| Stored::Full(values)), &scene()).unwrap();
    let opened = umbrage_io::open(&path).unwrap().scene;
    assert_eq!(opened.triangle_count(), 2);
    assert_eq!(opened.instances[0].world_from_mesh.translation, DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn damaged_files_are_errors_that_name_them() {
    let place = tempfile::tempdir().unwrap();
    let full = transfer(3, 1, |values, _| Stored::Full(values));
    for name in ["a.npz", "a.glb"] {
        let path = place.path().join(name);
        save_transfer(&path, &full, &scene()).unwrap();
        let whole = fs::read(&path).unwrap();
        for cut in [0, 10, whole.len() / 2, whole.len() - 1] {
            fs::write(&path, &whole[..cut]).unwrap();
            let error = open_transfer(&path).unwrap_err().to_string();
            assert!(error.contains(name), "{error}");
        }
        // Bytes changed here and there: an error or a transfer, never a panic.
        for at in (0..whole.len()).step_by(7) {
            let mut changed = whole.clone();
            changed[at] ^= 0x15;
            fs::write(&path, changed).unwrap();
            let _ = open_transfer(&path).is_ok_and(|transfer| transfer.is_whole());
        }
    }
    let error = open_transfer(&place.path().join("a.txt")).unwrap_err().to_string();
    assert!(error.contains(".npz or .glb"), "{error}");
}
