//! Casters in a host's own buffers cast the shadows of those that the library keeps.

use super::SIZE;
use crate::common::{gpu, scene};
use umbrage::core::glam::{DAffine3, DMat4, DQuat, DVec3, Vec2, Vec3};
use umbrage::core::{Bounds, Camera, Image, Light, LightKind, LightShape, Material, Mesh, Scene, Texture, primitive};
use umbrage::{
    Casters, Gpu, InstanceId, LentIndices, LentInstances, LentMatrices, LentMesh, LentShape, LentVertices, MaterialId,
    MatrixForm, MeshId, Needs, Placement, TechniqueInfo, techniques,
};
use umbrage_renderer::{LightPass, Renderer};
use wgpu::{BufferUsages as Usage, IndexFormat, VertexFormat};

/// A floor that all shadows fall on. The camera does not see what casts them.
fn floor() -> Scene {
    let camera = Camera { eye: DVec3::new(0.3, 2.6, 3.1), target: DVec3::new(0.0, 0.0, -0.2), ..Camera::default() };
    let mut scene = Scene { camera, ..Scene::default() };
    let (plane, plain) = (scene.add_mesh(primitive::plane()), scene.add_material(Material::default()));
    scene.place(plane, plain, DAffine3::from_scale(DVec3::splat(6.0)));
    scene
}

fn lights() -> [LightShape; 4] {
    let (position, direction) = (DVec3::new(0.6, 7.2, 0.4), DVec3::new(-0.1, -1.0, -0.05));
    [
        LightShape::Sphere { position, radius: 0.3 },
        LightShape::Directional { direction, angle_deg: 0.0 },
        LightShape::Spot { position, direction, inner_angle_deg: 30.0, outer_angle_deg: 40.0 },
        LightShape::Line { from: position, to: position + DVec3::X },
    ]
}

/// Some techniques with three kinds of light each, over the floor.
struct Shown {
    renderer: Renderer,
    names: Vec<String>,
    camera: Camera,
}

impl Shown {
    fn new(gpu: &Gpu, wanted: impl Fn(&TechniqueInfo) -> bool) -> Self {
        let mut scene = floor();
        let (mut names, mut passes) = (Vec::new(), Vec::new());
        for info in techniques().iter().filter(|info| wanted(info)) {
            let set: &[_] = if info.family.has_maps() { &[("size".into(), "128".into())] } else { &[] };
            let shapes = lights().into_iter().filter(|shape| info.lights.contains(kind(shape)));
            for shape in shapes.take(3) {
                names.push(format!("{} under {shape:?}", info.id));
                let technique = info.settings(set).unwrap().make(gpu).unwrap();
                passes.push(LightPass { light: scene.lights.len(), technique });
                scene.lights.push(Light::new(shape));
            }
        }
        let camera = scene.camera.clone();
        Self { renderer: Renderer::new(gpu, &scene, SIZE.0, SIZE.1, passes).unwrap(), names, camera }
    }

    fn casters(&mut self) -> &mut Casters {
        self.renderer.casters_mut()
    }

    fn frame(&mut self) -> Vec<Image<f32>> {
        self.renderer.frame(&self.camera).unwrap();
        (0..self.names.len()).map(|pass| self.renderer.visibility(pass).unwrap()).collect()
    }
}

fn kind(shape: &LightShape) -> LightKind {
    shape.kind()
}

/// What to place, and how: opaque ones, and one with an alpha mask.
fn meshes() -> [(Mesh, DAffine3, bool); 4] {
    let at = |x: f64, z: f64, size: f64| {
        let turn = DQuat::from_euler(Default::default(), x + 0.4, 0.3, z);
        DAffine3::from_scale_rotation_translation(DVec3::splat(size), turn, DVec3::new(x, 4.3, z))
    };
    [
        (primitive::torus(0.5, 0.2, 9, 7), at(-0.8, 0.2, 1.0), false),
        (primitive::cube(), at(0.5, 0.5, 0.5), false),
        (primitive::plane(), at(0.7, -0.7, 0.6), false),
        (primitive::plane(), at(-0.5, -0.9, 0.9), true),
    ]
}

/// A net, with an alpha mask and without.
fn materials(casters: &mut Casters) -> [MaterialId; 2] {
    let rgba = (0..64_u32).map(|i| [200, 90, 60, if (i ^ (i / 8)) & 2 == 0 { 255 } else { 0 }]).collect();
    let net = Texture { name: "net".into(), width: 8, height: 8, rgba, sampling: Default::default() };
    let net = casters.add_texture(&net).unwrap();
    let masked = Material { alpha_cutoff: Some(0.5), ..Material::default() };
    [casters.add_material(&Material::default(), None).unwrap(), casters.add_material(&masked, Some(net)).unwrap()]
}

/// It casts shadows on the floor alone.
fn cast(casters: &mut Casters, mesh: MeshId, material: MaterialId, place: DAffine3) -> InstanceId {
    casters.insert(&Placement { receives: false, ..Placement::new(mesh, material, place) }).unwrap()
}

/// In what way buffers are lent.
#[derive(Clone, Copy)]
struct Way {
    /// 32-bit numbers before the first vertex, from one to the next, and before texture
    /// coordinates.
    words: [usize; 3],
    /// Vertices and indices of others that come first.
    before: usize,
    is_short: bool,
    format: VertexFormat,
}

const PLAIN: Way = Way { words: [0, 3, 0], before: 0, is_short: false, format: VertexFormat::Float32x3 };
const MIXED: Way = Way { words: [5, 9, 4], before: 6, is_short: true, format: VertexFormat::Float32x4 };

/// Positions and texture coordinates of a mesh, one beside the other where that is the way, and
/// numbers without meaning between.
fn vertices(mesh: &Mesh, way: Way) -> Vec<f32> {
    let [first, stride, uv] = way.words;
    let mut words = vec![7.5e8; first + stride * (way.before + mesh.positions.len())];
    for (i, p) in mesh.positions.iter().enumerate() {
        let at = first + stride * (way.before + i);
        words[at..at + 3].copy_from_slice(&p.to_array());
        if uv > 0 {
            let of = mesh.uvs.get(i).copied().unwrap_or_default();
            words[at + uv..at + uv + 2].copy_from_slice(&of.to_array());
        }
    }
    words
}

/// A mesh in buffers that have no usage but what is needed.
fn lent<'a>(gpu: &Gpu, mesh: &Mesh, shape: LentShape<'a>, way: Way) -> LentMesh<'a> {
    let [first, stride, uv] = way.words.map(|words| 4 * words as u64);
    let usage = if matches!(shape, LentShape::Moving(..)) { Usage::STORAGE } else { Usage::empty() };
    let buffer = gpu.buffer("vertices", &vertices(mesh, way), Usage::VERTEX | Usage::COPY_DST | usage);
    let all: Vec<u32> = vec![0; way.before].into_iter().chain(mesh.indices.iter().copied()).collect();
    let short: Vec<u16> = all.iter().map(|i| *i as u16).collect();
    let (indices, format) = match way.is_short {
        true => (gpu.buffer("indices", &short, Usage::INDEX), IndexFormat::Uint16),
        false => (gpu.buffer("indices", &all, Usage::INDEX), IndexFormat::Uint32),
    };
    let of = |offset, format| LentVertices { buffer: buffer.clone(), offset, stride, format };
    LentMesh {
        positions: of(first, way.format),
        vertex_count: (way.before + mesh.positions.len()) as u32,
        uvs: (uv > 0).then(|| of(first + uv, VertexFormat::Float32x2)),
        indices: LentIndices {
            buffer: indices,
            format,
            range: way.before as u32..all.len() as u32,
            base_vertex: way.before as u32,
        },
        shape,
    }
}

/// Pixels in which pictures differ by more than `least`, by name.
fn differences(names: &[String], [a, b]: [&[Image<f32>]; 2], least: impl Fn(&str) -> f32) -> Vec<String> {
    let all = names.iter().zip(a.iter().zip(b));
    let count = |(name, (a, b)): (&String, (&Image<f32>, &Image<f32>))| {
        // Not a number differs from everything.
        let off = |(a, b): (&f32, &f32)| Some((a - b).abs()).filter(|off| off.is_nan() || *off > least(name));
        let off: Vec<f32> = a.data.iter().zip(&b.data).filter_map(off).collect();
        let most = off.iter().copied().fold(0.0, f32::max);
        (!off.is_empty()).then(|| format!("{name}: {} pixels, by {most}", off.len()))
    };
    all.filter_map(count).collect()
}

/// To the bit; but `wedges` adds up in half floats, in the order in which compute lists edges,
/// which is not always the same on drivers with several threads: two steps of such a number below
/// 1.
fn assert_equal(names: &[String], pictures: [&[Image<f32>]; 2], what: &str) {
    let off = differences(names, pictures, least_known);
    assert!(off.is_empty(), "{what}:\n{}", off.join("\n"));
}

fn least_known(name: &str) -> f32 {
    if name.starts_with("wedges") { 0.001 } else { 0.0 }
}

/// There is something to be compared.
fn assert_dark(names: &[String], pictures: &[Image<f32>]) {
    let is_lit = |image: &Image<f32>| image.data.iter().filter(|v| **v < 0.75).count() < 8;
    let lit: Vec<_> = names.iter().zip(pictures).filter(|(_, image)| is_lit(image)).map(|(name, _)| name).collect();
    assert!(lit.iter().all(|name| name.starts_with("none")), "nothing is in shadow: {lit:#?}");
}

#[test]
fn lent_meshes_cast_the_shadows_of_own_ones_for_every_technique() {
    let gpu = gpu();
    let (mut own, mut lending) = (Shown::new(&gpu, |_| true), Shown::new(&gpu, |_| true));
    let looks = [&mut own, &mut lending].map(|shown| materials(shown.casters()));
    for (i, (mesh, place, masked)) in meshes().iter().enumerate() {
        let id = own.casters().add_mesh(mesh).unwrap();
        cast(own.casters(), id, looks[0][usize::from(*masked)], *place);
        let way = if i % 2 == 0 && !masked { PLAIN } else { MIXED };
        let id = lending.casters().lend_mesh(&lent(&gpu, mesh, LentShape::Rigid(mesh), way)).unwrap();
        cast(lending.casters(), id, looks[1][usize::from(*masked)], *place);
    }
    let (kept, seen) = (own.frame(), lending.frame());
    assert_dark(&own.names, &kept);
    assert_equal(&own.names, [&kept, &seen], "lent");
    // Another mesh in another way, as the same one.
    let mesh = &meshes()[0].0;
    let grown =
        Mesh { positions: mesh.positions.iter().map(|p| *p * Vec3::new(1.0, 2.0, 1.1)).collect(), ..mesh.clone() };
    let new = own.casters().add_mesh(&grown).unwrap();
    let place = DAffine3::from_translation(DVec3::new(0.2, 4.4, 0.1));
    cast(own.casters(), new, looks[0][0], place);
    let again = lending.casters().add_mesh(mesh).unwrap();
    cast(lending.casters(), again, looks[1][0], place);
    lending.frame();
    lending.casters().lend_mesh_again(again, &lent(&gpu, &grown, LentShape::Rigid(&grown), MIXED)).unwrap();
    let (kept, seen) = (own.frame(), lending.frame());
    assert_equal(&own.names, [&kept, &seen], "lent again");
}

/// Depth alone is drawn.
fn needs_depth(info: &TechniqueInfo) -> bool {
    info.casters == Needs::Depth || info.id.starts_with("projective")
}

/// A mesh that has no inside, so that the library draws both sides of it.
fn open_mesh() -> Mesh {
    primitive::torus(0.5, 0.2, 9, 7)
}

fn in_bounds(mesh: &Mesh) -> Bounds {
    Bounds::of(mesh.positions.iter().map(|p| p.as_dvec3()))
}

#[test]
fn meshes_that_nobody_knows_and_that_move_are_drawn_where_they_are() {
    let gpu = gpu();
    let (mut own, mut lending) = (Shown::new(&gpu, needs_depth), Shown::new(&gpu, needs_depth));
    let looks = [&mut own, &mut lending].map(|shown| materials(shown.casters()));
    let mesh = open_mesh();
    let place = DAffine3::from_translation(DVec3::new(0.1, 4.3, 0.0));
    let kept = own.casters().add_mesh(&mesh).unwrap();
    cast(own.casters(), kept, looks[0][0], place);
    let shape = LentShape::Unknown(in_bounds(&mesh));
    let host = lent(&gpu, &mesh, shape, MIXED);
    let id = lending.casters().lend_mesh(&host).unwrap();
    cast(lending.casters(), id, looks[1][0], place);
    let before = own.frame();
    assert_dark(&own.names, &before);
    assert_equal(&own.names, [&before, &lending.frame()], "before it moved");
    let moved =
        Mesh { positions: mesh.positions.iter().map(|p| *p + Vec3::new(0.3, 0.1 * p.x, 0.2)).collect(), ..mesh };
    own.casters().deform_mesh(kept, &moved).unwrap();
    gpu.queue.write_buffer(&host.positions.buffer, 0, bytemuck::cast_slice(&vertices(&moved, MIXED)));
    lending.casters().touch_mesh(id, &in_bounds(&moved)).unwrap();
    let after = own.frame();
    assert!(!differences(&own.names, [&before, &after], |_| 0.5).is_empty(), "it has moved");
    assert_equal(&own.names, [&after, &lending.frame()], "after it moved");
}

#[test]
fn stored_numbers_of_sixteen_bits_are_drawn_as_well() {
    let gpu = gpu();
    let wanted = |info: &TechniqueInfo| ["shadow-map", "volume"].contains(&info.id);
    let mut own = Shown::new(&gpu, wanted);
    let look = materials(own.casters());
    // Corners that 16 bits hold exactly.
    let mesh = primitive::plane();
    let unit = |p: Vec3| Vec3::new(p.x + 0.5, 0.0, p.z + 0.5).round();
    let mesh = Mesh { positions: mesh.positions.iter().map(|p| unit(*p)).collect(), ..mesh };
    let place = DAffine3::from_translation(DVec3::new(-0.5, 4.3, -0.5));
    let kept = own.casters().add_mesh(&mesh).unwrap();
    cast(own.casters(), kept, look[0], place);
    let kept = own.frame();
    assert_dark(&own.names, &kept);
    for (format, one) in
        [(VertexFormat::Unorm16x4, 65535_u16), (VertexFormat::Snorm16x4, 32767), (VertexFormat::Float16x4, 0x3c00)]
    {
        let mut lending = Shown::new(&gpu, wanted);
        let look = materials(lending.casters());
        let number = |v: f32| if v > 0.75 { one } else { 0 };
        let words: Vec<[u16; 4]> = mesh.positions.iter().map(|p| [number(p.x), number(p.y), number(p.z), 9]).collect();
        let buffer = gpu.buffer("vertices", &words, Usage::VERTEX | Usage::STORAGE);
        let positions = LentVertices { buffer, offset: 0, stride: 8, format };
        let shape = LentShape::Moving(&mesh, in_bounds(&mesh));
        let id = lending.casters().lend_mesh(&LentMesh { positions, ..lent(&gpu, &mesh, shape, PLAIN) }).unwrap();
        cast(lending.casters(), id, look[0], place);
        assert_equal(&own.names, [&kept, &lending.frame()], &format!("{format:?}"));
    }
}

/// The mesh of the tentacles, and its joints at a time.
fn tentacle(seconds: f64) -> (Mesh, Vec<DAffine3>) {
    let mut scene = scene("tentacles", 0.1);
    scene.advance(seconds);
    let bent = scene.instances.iter().find(|i| i.pose.is_some()).expect("one with joints");
    (scene.meshes[bent.mesh].clone(), scene.joints(bent).expect("joints"))
}

/// What can be found of meshes whose vertices the GPU alone knows.
fn follows(info: &TechniqueInfo) -> bool {
    info.id != "light-mask"
}

/// The library bends a mesh, and hands what it bent to the host, which lends it to other casters.
#[test]
fn what_is_bent_once_is_shared_both_ways() {
    let gpu = gpu();
    let (mut own, mut lending) = (Shown::new(&gpu, follows), Shown::new(&gpu, follows));
    let looks = [&mut own, &mut lending].map(|shown| materials(shown.casters()));
    let (mesh, joints) = tentacle(0.3);
    let up = DAffine3::IDENTITY;
    let raised = |joints: Vec<DAffine3>| -> Vec<DAffine3> {
        joints.into_iter().map(|joint| DAffine3::from_translation(DVec3::new(0.2, 3.6, 0.1)) * joint).collect()
    };
    let kept = own.casters().add_mesh(&mesh).unwrap();
    let placement =
        Placement { receives: false, joints: Some(raised(joints)), ..Placement::new(kept, looks[0][0], up) };
    let bent = own.casters().insert(&placement).unwrap();
    let bounds = |shown: &Shown| shown.renderer.casters().casting_bounds().last().expect("a caster");
    let host = lent(&gpu, &mesh, LentShape::Moving(&mesh, bounds(&own)), PLAIN);
    let id = lending.casters().lend_mesh(&host).unwrap();
    cast(lending.casters(), id, looks[1][0], up);
    let mut seen = Vec::new();
    for (round, seconds) in [0.3, 1.1, 1.9].into_iter().enumerate() {
        own.casters().set_pose(bent, &raised(tentacle(seconds).1)).unwrap();
        let kept = own.frame();
        assert_dark(&own.names, &kept);
        let vertices = own.renderer.casters().vertices(bent).unwrap();
        assert_eq!(vertices.vertex_count as usize, mesh.positions.len());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let (from, size) = (vertices.positions, 12 * u64::from(vertices.vertex_count));
        encoder.copy_buffer_to_buffer(from.buffer(), from.offset(), &host.positions.buffer, 0, size);
        gpu.queue.submit([encoder.finish()]);
        lending.casters().touch_mesh(id, &bounds(&own)).unwrap();
        seen = lending.frame();
        assert_equal(&own.names, [&kept, &seen], &format!("in round {round}"));
    }
    // And as if all had been lent when it was as it is now.
    let mut anew = Shown::new(&gpu, follows);
    let look = materials(anew.casters());
    let shape = LentShape::Moving(&mesh, bounds(&own));
    let id = anew.casters().lend_mesh(&LentMesh { shape, ..host }).unwrap();
    cast(anew.casters(), id, look[0], up);
    assert_equal(&own.names, [&seen, &anew.frame()], "lent anew");
}

/// Places of copies, and a box around them.
fn places(turn: f64) -> Vec<DAffine3> {
    let at = |i: u32| {
        let angle = turn + f64::from(i) * 2.2;
        let place = DVec3::new(1.1 * angle.cos(), 4.2 + 0.1 * f64::from(i), 1.1 * angle.sin());
        DAffine3::from_scale_rotation_translation(DVec3::splat(0.7), DQuat::from_rotation_x(angle), place)
    };
    (0..3).map(at).collect()
}

fn around(mesh: &Mesh, places: &[DAffine3]) -> Bounds {
    places.iter().fold(Bounds::EMPTY, |all, place| all.union(in_bounds(mesh).transformed(place)))
}

/// As they are stored; with words between.
fn matrices(places: &[DAffine3], form: MatrixForm) -> Vec<[f32; 18]> {
    let of = |place: &DAffine3| {
        let matrix = DMat4::from(*place).as_mat4();
        let (columns, rows) = (matrix.to_cols_array(), matrix.transpose().to_cols_array());
        let mut words = [3e9; 18];
        match form {
            MatrixForm::Columns4x4 => words[1..17].copy_from_slice(&columns),
            MatrixForm::Rows3x4 => words[1..13].copy_from_slice(&rows[..12]),
        }
        words
    };
    places.iter().map(of).collect()
}

fn lent_instances(
    gpu: &Gpu,
    (mesh, material): (MeshId, MaterialId),
    of: (&Mesh, &[DAffine3]),
    form: MatrixForm,
) -> LentInstances {
    let usage = Usage::VERTEX | Usage::COPY_DST;
    let buffer = gpu.buffer("matrices", &matrices(of.1, form), usage);
    LentInstances {
        mesh,
        material,
        world_from_group: DAffine3::IDENTITY,
        matrices: LentMatrices { buffer, offset: 4, stride: 72, form, count: of.1.len() as u32 },
        bounds: around(of.0, of.1),
        casts: true,
        receives: false,
    }
}

/// One by a host's matrix is where one of the library's is, to the bit.
#[test]
fn a_lent_instance_casts_the_shadow_of_an_own_one() {
    let gpu = gpu();
    for (form, masked) in [(MatrixForm::Rows3x4, false), (MatrixForm::Columns4x4, true)] {
        let (mut own, mut lending) = (Shown::new(&gpu, needs_depth), Shown::new(&gpu, needs_depth));
        let looks = [&mut own, &mut lending].map(|shown| materials(shown.casters())[usize::from(masked)]);
        let mesh = if masked { primitive::plane() } else { open_mesh() };
        let (id, kept) = (lending.casters().add_mesh(&mesh).unwrap(), own.casters().add_mesh(&mesh).unwrap());
        let place = &places(0.4)[..1];
        cast(own.casters(), kept, looks[0], place[0]);
        let host = lent_instances(&gpu, (id, looks[1]), (&mesh, place), form);
        lending.casters().insert_lent(&host).unwrap();
        let kept = own.frame();
        assert_dark(&own.names, &kept);
        let (seen, what) = (lending.frame(), format!("{form:?}"));
        assert_near(&own.names, [&kept, &seen], &what);
        // What its textures cover is what boxes of casters may shade, and the box of a lent
        // instance lies along the world's axes.
        let is_of_boxes = |name: &str| name.starts_with("projective-fake");
        let off =
            differences(
                &own.names,
                [&kept, &seen],
                |name| {
                    if is_of_boxes(name) { f32::INFINITY } else { least_known(name) }
                },
            );
        assert!(off.is_empty(), "{what}:\n{}", off.join("\n"));
    }
}

/// The box around many is not their boxes, so maps are fitted to other places, and soft filters
/// search elsewhere.
#[test]
fn many_lent_instances_move_with_their_buffer() {
    let (gpu, form) = (gpu(), MatrixForm::Rows3x4);
    let (mut own, mut lending) = (Shown::new(&gpu, needs_depth), Shown::new(&gpu, needs_depth));
    let looks = [&mut own, &mut lending].map(|shown| materials(shown.casters())[0]);
    let mesh = open_mesh();
    let (id, kept) = (lending.casters().add_mesh(&mesh).unwrap(), own.casters().add_mesh(&mesh).unwrap());
    let start = places(0.0);
    let ids: Vec<_> = start.iter().map(|place| cast(own.casters(), kept, looks[0], *place)).collect();
    let host = lent_instances(&gpu, (id, looks[1]), (&mesh, &start), form);
    let group = lending.casters().insert_lent(&host).unwrap();
    let before = own.frame();
    assert_dark(&own.names, &before);
    assert_near(&own.names, [&before, &lending.frame()], "three");
    // Elsewhere, and one fewer; and a lent mesh in the place of the library's.
    let moved = places(0.9);
    ids.iter().zip(&moved).for_each(|(id, place)| own.casters().move_instance(*id, place).unwrap());
    own.casters().remove(ids[2]).unwrap();
    gpu.queue.write_buffer(&host.matrices.buffer, 0, bytemuck::cast_slice(&matrices(&moved, form)));
    lending.casters().touch_instances(group, 2, &around(&mesh, &moved[..2])).unwrap();
    let by = lent(&gpu, &mesh, LentShape::Unknown(in_bounds(&mesh)), MIXED);
    lending.casters().lend_mesh_again(id, &by).unwrap();
    let (after, seen) = (own.frame(), lending.frame());
    assert!(!differences(&own.names, [&before, &after], |_| 0.5).is_empty(), "they have moved");
    assert_near(&own.names, [&after, &seen], "two, elsewhere");
    let mut anew = Shown::new(&gpu, needs_depth);
    let look = materials(anew.casters())[0];
    let id = anew.casters().lend_mesh(&by).unwrap();
    let host = lent_instances(&gpu, (id, look), (&mesh, &moved[..2]), form);
    anew.casters().insert_lent(&host).unwrap();
    assert_equal(&own.names, [&seen, &anew.frame()], "lent anew");
}

fn assert_near(names: &[String], [a, b]: [&[Image<f32>]; 2], what: &str) {
    let mean = |a: &Image<f32>, b: &Image<f32>| {
        let sum: f32 = a.data.iter().zip(&b.data).map(|(a, b)| (a - b).abs()).sum();
        sum / a.data.len() as f32
    };
    let off: Vec<_> = names.iter().zip(a.iter().zip(b)).map(|(name, (a, b))| (name, mean(a, b))).collect();
    assert!(off.iter().all(|(_, mean)| *mean < 0.01), "{what}: {off:#?}");
}

#[test]
fn texture_coordinates_are_lent_too() {
    let gpu = gpu();
    let wanted = |info: &TechniqueInfo| info.id == "pcf";
    let mesh = primitive::plane();
    let stretched = Mesh { uvs: mesh.uvs.iter().map(|uv| *uv * Vec2::new(0.4, 0.5)).collect(), ..mesh.clone() };
    let place = DAffine3::from_translation(DVec3::new(0.0, 4.3, 0.0));
    let mut all = Vec::new();
    for of in [&mesh, &stretched] {
        let mut shown = Shown::new(&gpu, wanted);
        let look = materials(shown.casters());
        let id = shown.casters().lend_mesh(&lent(&gpu, of, LentShape::Unknown(in_bounds(of)), MIXED)).unwrap();
        cast(shown.casters(), id, look[1], place);
        all.push(shown.frame());
        assert_dark(&shown.names, &all[all.len() - 1]);
    }
    let names: Vec<String> = all[0].iter().map(|_| "pcf".into()).collect();
    assert!(!differences(&names, [&all[0], &all[1]], |_| 0.5).is_empty(), "the net is another");
}
