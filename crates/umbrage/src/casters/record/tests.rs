//! Needs a graphics adapter.

use crate::casters::read_back::read;
use crate::{Casters, Gpu, LentIndices, LentMesh, LentShape, LentVertices, Placement, Recorder};
use umbrage_core::glam::{DAffine3, DVec3, Vec3};
use umbrage_core::{Bounds, Material, primitive};

/// Records what has changed, and submits or drops it.
fn record(gpu: &Gpu, casters: &mut Casters, submits: bool) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut recorder = Recorder::new(gpu);
    let mut passes = recorder.begin(&mut encoder);
    casters.record(&mut passes).unwrap();
    passes.finish();
    if submits {
        gpu.queue.submit([encoder.finish()]);
        gpu.wait().unwrap();
    }
}

fn heights(gpu: &Gpu, casters: &Casters) -> Vec<f32> {
    read(gpu, casters.instances.buffer()).chunks(16).take(casters.len()).map(|i| i[7]).collect()
}

#[test]
fn what_was_recorded_into_a_dropped_encoder_is_recorded_again() {
    let gpu = Gpu::request(None).unwrap();
    let mut casters = Casters::empty(&gpu).unwrap();
    let material = casters.add_material(&Material::default(), None).unwrap();
    let (mut ids, mut wanted) = (Vec::new(), Vec::new());
    for round in 0..12 {
        // New meshes and instances have buffers grow, too.
        let mesh = casters.add_mesh(&primitive::sphere(4 + round, 4)).unwrap();
        let up = |y: f64| DAffine3::from_translation(DVec3::Y * y);
        ids.push(casters.insert(&Placement::new(mesh, material, up(0.25 * f64::from(round)))).unwrap());
        wanted.push(0.25 * round as f32);
        casters.move_instance(ids[0], &up(f64::from(round))).unwrap();
        wanted[0] = round as f32;
        record(&gpu, &mut casters, round % 3 == 2);
        if round % 3 == 2 {
            assert_eq!(heights(&gpu, &casters), wanted, "round {round}");
            let positions = read(&gpu, casters.positions());
            for part in casters.meshes() {
                let first = 3 * part.base_vertex as usize;
                let known: Vec<f32> = part.mesh.positions.iter().flat_map(|p| p.to_array()).collect();
                assert!(positions[first..first + known.len()] == known, "round {round}");
            }
        }
    }
}

#[test]
fn a_scene_that_moves_far_away_is_sent_anew_about_its_own_middle() {
    let gpu = Gpu::request(None).unwrap();
    let mut casters = Casters::empty(&gpu).unwrap();
    let material = casters.add_material(&Material::default(), None).unwrap();
    let mesh = casters.add_mesh(&primitive::cube()).unwrap();
    let ids: Vec<_> = (0..5)
        .map(|i| Placement::new(mesh, material, DAffine3::from_translation(DVec3::Y * f64::from(i))))
        .map(|placement| casters.insert(&placement).unwrap())
        .collect();
    record(&gpu, &mut casters, true);
    let version = casters.version();
    let far = DVec3::new(3e7, 1e7, -2e7);
    for (i, id) in (0..).zip(&ids) {
        let at = DAffine3::from_translation(far + DVec3::Y * f64::from(i));
        casters.move_instance(*id, &at).unwrap();
    }
    record(&gpu, &mut casters, true);
    assert_ne!(casters.version(), version, "nothing that was kept holds");
    assert!(casters.origin().distance(far) < 64.0, "{}", casters.origin());
    let base = (far.y - casters.origin().y) as f32;
    assert_eq!(heights(&gpu, &casters), [0.0, 1.0, 2.0, 3.0, 4.0].map(|y: f32| base + y));
}

/// Vertices that a host moves follow in the first frame that is executed.
#[test]
fn what_a_host_moved_is_copied_again_after_a_dropped_encoder() {
    let gpu = Gpu::request(None).unwrap();
    let mut casters = Casters::empty(&gpu).unwrap();
    let cube = primitive::cube();
    let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    let buffer = gpu.buffer("positions", &cube.positions, usage);
    let indices = gpu.buffer("indices", &cube.indices, wgpu::BufferUsages::INDEX);
    let bounds = Bounds { min: DVec3::splat(-9.0), max: DVec3::splat(9.0) };
    let lent = LentMesh {
        positions: LentVertices { buffer, offset: 0, stride: 12, format: wgpu::VertexFormat::Float32x3 },
        vertex_count: 24,
        uvs: None,
        indices: LentIndices { buffer: indices, format: wgpu::IndexFormat::Uint32, range: 0..36, base_vertex: 0 },
        shape: LentShape::Moving(&cube, bounds),
    };
    let mesh = casters.lend_mesh(&lent).unwrap();
    record(&gpu, &mut casters, true);
    for round in 1..7 {
        let moved: Vec<Vec3> = cube.positions.iter().map(|p| *p + Vec3::Y * round as f32).collect();
        gpu.queue.write_buffer(&lent.positions.buffer, 0, bytemuck::cast_slice(&moved));
        casters.touch_mesh(mesh, &bounds).unwrap();
        record(&gpu, &mut casters, round % 3 == 0);
        if round % 3 != 0 {
            // Nothing is changed any more, but what was recorded is lost.
            record(&gpu, &mut casters, round % 2 == 0);
        }
        if round % 3 == 0 || round % 2 == 0 {
            let wanted: Vec<f32> = moved.iter().flat_map(|p| p.to_array()).collect();
            assert!(read(&gpu, casters.positions())[..72] == wanted[..], "round {round}");
        }
    }
}

/// Triangles stay where they are while vertices move and no two that were together part.
#[test]
fn a_deformed_mesh_sends_its_vertices_alone() {
    let gpu = Gpu::request(None).unwrap();
    let mut casters = Casters::empty(&gpu).unwrap();
    let mut sphere = primitive::sphere(7, 5);
    let mesh = casters.add_mesh(&sphere).unwrap();
    record(&gpu, &mut casters, true);
    for round in 1..4 {
        sphere.positions.iter_mut().for_each(|p| p.y *= 1.5);
        casters.deform_mesh(mesh, &sphere).unwrap();
        let written = [&casters.geometry.positions, &casters.geometry.indices, &casters.geometry.welded]
            .map(|store| casters.journal.writes_to(store.buffer()));
        assert_eq!(written, [true, false, false], "round {round}");
        record(&gpu, &mut casters, true);
    }
    // The seam opens.
    sphere.positions[0].x += 1.0;
    casters.deform_mesh(mesh, &sphere).unwrap();
    assert!(casters.journal.writes_to(casters.geometry.welded.buffer()));
    record(&gpu, &mut casters, true);
    let welded = read(&gpu, casters.geometry.welded.buffer());
    let welded: Vec<u32> = welded.iter().map(|word| word.to_bits()).take(sphere.indices.len()).collect();
    assert_eq!(welded, sphere.welded_indices());
}
