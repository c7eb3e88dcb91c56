//! What can't be drawn from is an error that says what to change, and changes nothing.

use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Bounds, Camera, Light, LightShape, Material, Mesh, primitive};
use umbrage::fullscreen::target_texture;
use umbrage::{
    Casters, Error, Gpu, LentIndices, LentInstances, LentMatrices, LentMesh, LentShape, LentVertices, MatrixForm,
    Needs, Placement, Receivers, Recorder, TechniqueInfo, View, VisibilityTarget, find, techniques,
};
use wgpu::{BufferUsages as Usage, IndexFormat, VertexFormat};

fn text<T>(result: Result<T, Error>) -> String {
    result.err().map(|e| e.to_string()).unwrap_or_default()
}

fn unit() -> Bounds {
    Bounds { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) }
}

fn cube(gpu: &Gpu) -> LentMesh<'static> {
    let mesh = primitive::cube();
    let buffer = gpu.buffer("positions", &mesh.positions, Usage::VERTEX);
    let indices = gpu.buffer("indices", &mesh.indices, Usage::INDEX);
    LentMesh {
        positions: LentVertices { buffer, offset: 0, stride: 12, format: VertexFormat::Float32x3 },
        vertex_count: mesh.positions.len() as u32,
        uvs: None,
        indices: LentIndices { buffer: indices, format: IndexFormat::Uint32, range: 0..36, base_vertex: 0 },
        shape: LentShape::Unknown(unit()),
    }
}

/// Two devices of one adapter.
fn two_devices() -> [Gpu; 2] {
    pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        let (first, of_first) = adapter.request_device(&Default::default()).await.unwrap();
        let (second, of_second) = adapter.request_device(&Default::default()).await.unwrap();
        [Gpu::new(first, of_first), Gpu::new(second, of_second)]
    })
}

#[test]
fn buffers_that_can_not_be_drawn_from_are_refused() {
    let [gpu, second] = two_devices();
    let mut casters = Casters::empty(&gpu).unwrap();
    let (good, other, shape) = (cube(&gpu), cube(&second), primitive::cube());
    let positions = |change: fn(&mut LentVertices)| {
        let mut mesh = good.clone();
        change(&mut mesh.positions);
        mesh
    };
    let indices = |change: fn(&mut LentIndices)| {
        let mut mesh = good.clone();
        change(&mut mesh.indices);
        mesh
    };
    let wrong = |buffer: &wgpu::Buffer, change: fn(&mut LentMesh<'static>, wgpu::Buffer)| {
        let mut mesh = good.clone();
        change(&mut mesh, buffer.clone());
        mesh
    };
    let (of_vertices, of_indices) = (&good.positions.buffer, &good.indices.buffer);
    let short = Mesh { indices: vec![0, 1, 2], ..primitive::cube() };
    let broken = Mesh { indices: [vec![99], shape.indices[1..].to_vec()].concat(), ..primitive::cube() };
    for (mesh, says) in [
        (LentMesh { vertex_count: 25, ..good.clone() }, "too few for 25"),
        (LentMesh { vertex_count: u32::MAX, ..good.clone() }, "too few"),
        (positions(|p| p.offset = 16), "too few"),
        (positions(|p| p.offset = u64::MAX - 3), "too few"),
        (positions(|p| p.offset = 2), "multiples of 4"),
        (positions(|p| p.stride = 14), "multiples of 4"),
        (positions(|p| p.stride = 8), "from 12 to"),
        (positions(|p| p.stride = 4096), "from 12 to"),
        (positions(|p| p.format = VertexFormat::Float32x2), "make them one of [Float32x3"),
        (wrong(of_indices, |mesh, buffer| mesh.positions.buffer = buffer), "without BufferUsages(VERTEX)"),
        (wrong(of_vertices, |mesh, buffer| mesh.indices.buffer = buffer), "without BufferUsages(INDEX)"),
        (indices(|i| i.range = 0..35), "no whole triangles"),
        (indices(|i| i.range = 3..39), "too few for 39"),
        (indices(|i| i.base_vertex = u32::MAX), "beyond 31 bits"),
        (LentMesh { uvs: Some(good.positions.clone()), ..good.clone() }, "make them one of [Float32x2"),
        (LentMesh { shape: LentShape::Rigid(&short), ..good.clone() }, "3 indices where 36 are lent"),
        (LentMesh { shape: LentShape::Rigid(&broken), ..good.clone() }, "beyond its vertices"),
        (LentMesh { vertex_count: 20, shape: LentShape::Rigid(&shape), ..good.clone() }, "where 20 are lent"),
        (LentMesh { shape: LentShape::Moving(&shape, unit()), ..good.clone() }, "without BufferUsages(STORAGE)"),
        (LentMesh { shape: LentShape::Unknown(Bounds::EMPTY), ..good.clone() }, "empty or not finite"),
        (
            LentMesh { shape: LentShape::Unknown(Bounds { min: DVec3::NAN, max: DVec3::ONE }), ..good.clone() },
            "empty or not finite",
        ),
        (LentMesh { positions: other.positions.clone(), ..good.clone() }, "of the same device"),
        (LentMesh { indices: other.indices.clone(), ..good.clone() }, "of the same device"),
    ] {
        let said = text(casters.lend_mesh(&mesh));
        assert!(said.contains(says), "{said:?} and not {says:?}");
    }
    let empty = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 0,
        usage: Usage::VERTEX | Usage::INDEX,
        mapped_at_creation: false,
    });
    let positions = LentVertices { buffer: empty.clone(), ..good.positions.clone() };
    let nothing = LentMesh { positions, vertex_count: 0, ..good.clone() };
    assert!(text(casters.lend_mesh(&nothing)).contains("without vertices"));
    let id = casters.lend_mesh(&good).unwrap();
    casters.remove_mesh(id).unwrap();
    assert!(text(casters.touch_mesh(id, &unit())).contains("names no mesh"));
    assert!(text(casters.lend_mesh_again(id, &cube(&gpu))).contains("names no mesh"));
    gpu.check().unwrap();
}

#[test]
fn what_was_lent_in_another_way_is_refused() {
    let gpu = gpu();
    let mut casters = Casters::empty(&gpu).unwrap();
    let known = primitive::cube();
    let own = casters.add_mesh(&known).unwrap();
    let unknown = casters.lend_mesh(&cube(&gpu)).unwrap();
    let rigid = casters.lend_mesh(&LentMesh { shape: LentShape::Rigid(&known), ..cube(&gpu) }).unwrap();
    assert!(text(casters.touch_mesh(own, &unit())).contains("call `deform_mesh`"));
    assert!(text(casters.touch_mesh(rigid, &unit())).contains("`LentShape::Moving`"));
    assert!(text(casters.touch_mesh(unknown, &Bounds::EMPTY)).contains("not finite"));
    assert!(text(casters.deform_mesh(unknown, &known)).contains("call `touch_mesh`"));
    let material = casters.add_material(&Material::default(), None).unwrap();
    let of = casters.insert(&Placement::new(unknown, material, DAffine3::IDENTITY)).unwrap();
    assert!(text(casters.vertices(of)).contains("where the host has them"));
    assert!(text(casters.touch_instances(of, 1, &unit())).contains("call `move_instance`"));
    let buffer = gpu.buffer("matrices", &[[0_f32; 16]; 4], Usage::VERTEX);
    let matrices = LentMatrices { buffer, offset: 0, stride: 64, form: MatrixForm::Columns4x4, count: 4 };
    let good = LentInstances {
        mesh: own,
        material,
        world_from_group: DAffine3::IDENTITY,
        matrices: matrices.clone(),
        bounds: unit(),
        casts: true,
        receives: false,
    };
    let with = |matrices| LentInstances { matrices, ..good.clone() };
    let nan = DAffine3::from_translation(DVec3::NAN);
    for (instances, says) in [
        (with(LentMatrices { count: 5, ..matrices.clone() }), "too few for 5"),
        (with(LentMatrices { stride: 48, ..matrices.clone() }), "from 64 to"),
        (with(LentMatrices { offset: 1, ..matrices.clone() }), "multiples of 4"),
        (LentInstances { bounds: Bounds::EMPTY, ..good.clone() }, "not finite"),
        (LentInstances { world_from_group: nan, ..good.clone() }, "not finite"),
    ] {
        let said = text(casters.insert_lent(&instances));
        assert!(said.contains(says), "{said:?} and not {says:?}");
    }
    let group = casters.insert_lent(&good).unwrap();
    assert!(text(casters.touch_instances(group, 5, &unit())).contains("5 instances where 4 were lent"));
    assert!(text(casters.touch_instances(group, 4, &Bounds::EMPTY)).contains("not finite"));
    casters.touch_instances(group, 0, &Bounds::EMPTY).unwrap();
    casters.touch_instances(group, 4, &unit()).unwrap();
    assert!(text(casters.remove_mesh(own)).contains("remove them first"));
    casters.remove(group).unwrap();
    assert!(text(casters.touch_instances(group, 1, &unit())).contains("names no instance"));
}

/// Techniques that need more than depth say so, and draw again once all is known.
#[test]
fn techniques_that_need_edges_refuse_what_nobody_knows() {
    let gpu = gpu();
    let mut casters = Casters::empty(&gpu).unwrap();
    let material = casters.add_material(&Material::default(), None).unwrap();
    let floor = casters.add_mesh(&primitive::plane()).unwrap();
    casters.insert(&Placement::new(floor, material, DAffine3::from_scale(DVec3::splat(4.0)))).unwrap();
    let mesh = casters.lend_mesh(&cube(&gpu)).unwrap();
    let up = DAffine3::from_translation(DVec3::Y);
    casters.insert(&Placement::new(mesh, material, up)).unwrap();
    let position = DVec3::new(0.5, 4.0, 0.2);
    let sphere = Light::new(LightShape::Sphere { position, radius: 0.2 });
    let line = Light::new(LightShape::Line { from: position, to: position + DVec3::X });
    // One end alone needs no edges.
    let light_of = |info: &TechniqueInfo| if info.id == "linear-light" { &line } else { &sphere };
    let size = (16, 16);
    let depth = target_texture(&gpu, "depth", size, 1, wgpu::TextureFormat::Depth32Float);
    let receivers = Receivers::new(&gpu, &depth.create_view(&Default::default()), None, size).unwrap();
    let camera = Camera { eye: DVec3::new(0.0, 3.0, 3.0), ..Camera::default() }.view(size.0, size.1);
    let refuses = |casters: &mut Casters| -> Vec<&'static str> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut recorder = Recorder::new(&gpu);
        let mut passes = recorder.begin(&mut encoder);
        casters.record(&mut passes).unwrap();
        passes.finish();
        gpu.queue.submit([encoder.finish()]);
        let view = View { camera, receivers: &receivers, casters, light: &sphere, textures: &[] };
        let all = techniques().iter().filter(|info| info.lights.contains(light_of(info).shape.kind()));
        let mut refusing = Vec::new();
        for info in all {
            let mut technique = info.settings(&[]).unwrap().make(&gpu).unwrap();
            if let Err(error) = technique.prepare(&gpu, &View { light: light_of(info), ..view }) {
                let said = error.to_string();
                assert!(said.contains("lent") && said.contains("technique"), "{}: {said}", info.id);
                refusing.push(info.id);
            }
        }
        refusing
    };
    let needs_more = |info: &&&TechniqueInfo| {
        let needs = [Needs::Edges, Needs::Triangles].contains(&info.casters) && !info.id.starts_with("projective");
        needs && info.lights.contains(light_of(info).shape.kind())
    };
    let needy: Vec<&str> = techniques().iter().filter(needs_more).map(|info| info.id).collect();
    assert!(needy.len() > 3, "{needy:?}");
    assert_eq!(refuses(&mut casters), needy);
    let known = primitive::cube();
    casters.lend_mesh_again(mesh, &LentMesh { shape: LentShape::Rigid(&known), ..cube(&gpu) }).unwrap();
    assert_eq!(refuses(&mut casters), Vec::<&str>::new());
    // The host moves it: whoever looks at vertices on the CPU can't follow.
    let mut lent = LentMesh { shape: LentShape::Moving(&known, unit()), ..cube(&gpu) };
    lent.positions.buffer = gpu.buffer("positions", &known.positions, Usage::VERTEX | Usage::STORAGE);
    casters.lend_mesh_again(mesh, &lent).unwrap();
    assert_eq!(refuses(&mut casters), ["light-mask"]);
    let view = View { camera, receivers: &receivers, casters: &casters, light: &sphere, textures: &[] };
    let point = Light::new(LightShape::Point { position });
    for (set, refused) in [("cpu", true), ("compute", false), ("vertex", false)] {
        let set = [("extrude".to_string(), set.to_string())];
        let mut volume = find("volume").unwrap().settings(&set).unwrap().make(&gpu).unwrap();
        let said = text(volume.prepare(&gpu, &View { light: &point, ..view }));
        assert_eq!(said.contains("the host moves"), refused, "{said:?}");
    }
    // The library's own takes its place.
    casters.replace_mesh(mesh, &known).unwrap();
    assert_eq!(refuses(&mut casters), Vec::<&str>::new());
}

/// Nothing is nothing, and casts no shadow.
#[test]
fn empty_buffers_are_no_casters() {
    let gpu = gpu();
    let mut casters = Casters::empty(&gpu).unwrap();
    let material = casters.add_material(&Material::default(), None).unwrap();
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 0,
        usage: Usage::VERTEX | Usage::INDEX | Usage::STORAGE,
        mapped_at_creation: false,
    });
    let nothing = Mesh::default();
    let positions = LentVertices { buffer: buffer.clone(), offset: 8, stride: 12, format: VertexFormat::Float32x3 };
    let indices = LentIndices { buffer: buffer.clone(), format: IndexFormat::Uint16, range: 0..0, base_vertex: 0 };
    let shapes =
        [LentShape::Unknown(Bounds::EMPTY), LentShape::Rigid(&nothing), LentShape::Moving(&nothing, Bounds::EMPTY)];
    let matrices = LentMatrices { buffer, offset: 0, stride: 64, form: MatrixForm::Columns4x4, count: 0 };
    let cube = casters.add_mesh(&primitive::cube()).unwrap();
    for shape in shapes {
        let (positions, indices) = (positions.clone(), indices.clone());
        let lent = LentMesh { positions, vertex_count: 0, uvs: None, indices, shape };
        let mesh = casters.lend_mesh(&lent).unwrap();
        casters.insert(&Placement::new(mesh, material, DAffine3::IDENTITY)).unwrap();
        for mesh in [mesh, cube] {
            let group = LentInstances {
                mesh,
                material,
                world_from_group: DAffine3::IDENTITY,
                matrices: matrices.clone(),
                bounds: unit(),
                casts: true,
                receives: true,
            };
            casters.insert_lent(&group).unwrap();
        }
    }
    let size = (8, 8);
    let depth = target_texture(&gpu, "depth", size, 1, wgpu::TextureFormat::Depth32Float);
    let receivers = Receivers::new(&gpu, &depth.create_view(&Default::default()), None, size).unwrap();
    let target = VisibilityTarget::new(&gpu, size.0, size.1).unwrap();
    let camera = Camera { eye: DVec3::new(0.0, 3.0, 3.0), ..Camera::default() }.view(size.0, size.1);
    let light = Light::new(LightShape::Point { position: DVec3::Y * 4.0 });
    let mut technique = find("shadow-map").unwrap().settings(&[]).unwrap().make(&gpu).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut recorder = Recorder::new(&gpu);
    let mut passes = recorder.begin(&mut encoder);
    casters.record(&mut passes).unwrap();
    let view = View { camera, receivers: &receivers, casters: &casters, light: &light, textures: &[] };
    technique.prepare(&gpu, &view).unwrap().record(&mut passes, &target).unwrap();
    passes.finish();
    gpu.queue.submit([encoder.finish()]);
    gpu.check().unwrap();
    assert_eq!(technique.inside().stats().draws, 1, "the look-up alone");
}
