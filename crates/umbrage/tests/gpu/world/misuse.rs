//! What hosts get wrong is an error that names what, and changes nothing.

use crate::common::gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Light, LightShape, Material, Mesh, Scene, Texture, primitive};
use umbrage::fullscreen::target_texture;
use umbrage::{Casters, Error, Placement, Receivers, Recorder, View, VisibilityTarget, find};

fn text<T>(result: Result<T, Error>) -> String {
    result.err().map(|e| e.to_string()).unwrap_or_default()
}

#[test]
fn handles_that_name_nothing_are_refused() {
    let gpu = gpu();
    let (mut casters, mut others) = (Casters::empty(&gpu).unwrap(), Casters::empty(&gpu).unwrap());
    let mesh = casters.add_mesh(&primitive::cube()).unwrap();
    let material = casters.add_material(&Material::default(), None).unwrap();
    let placement = Placement::new(mesh, material, DAffine3::IDENTITY);
    let first = casters.insert(&placement).unwrap();
    casters.remove(first).unwrap();
    let second = casters.insert(&placement).unwrap();
    for refused in [
        text(casters.remove(first)),
        text(casters.move_instance(first, &DAffine3::IDENTITY)),
        text(casters.show(first, false)),
        text(casters.set_flags(first, true, false)),
        text(casters.set_material(first, material)),
        text(casters.set_pose(first, &[])),
        text(others.move_instance(second, &DAffine3::IDENTITY)),
    ] {
        assert!(refused.contains("names no instance") && refused.contains("removed"), "{refused}");
    }
    assert!(text(others.insert(&placement)).contains("names no mesh"));
    assert!(text(casters.remove_mesh(mesh)).contains("remove them first"));
    assert!(text(casters.remove_material(material)).contains("remove them or give them another"));
    casters.remove(second).unwrap();
    casters.remove_mesh(mesh).unwrap();
    casters.remove_material(material).unwrap();
    assert!(text(casters.insert(&placement)).contains("names no mesh"));
    assert!(text(casters.deform_mesh(mesh, &primitive::cube())).contains("names no mesh"));
    assert!(text(casters.replace_mesh(mesh, &primitive::cube())).contains("names no mesh"));
    assert!(text(casters.replace_material(material, &Material::default(), None)).contains("names no material"));
    assert!(casters.is_empty() && casters.instance(0).is_none(), "there was no scene");
}

#[test]
fn a_texture_goes_when_no_material_has_it() {
    let gpu = gpu();
    let mut casters = Casters::empty(&gpu).unwrap();
    let picture =
        || Texture { name: "one".into(), width: 1, height: 1, rgba: vec![[9; 4]], sampling: Default::default() };
    let texture = casters.add_texture(&picture()).unwrap();
    let materials = [0, 1].map(|_| casters.add_material(&Material::default(), Some(texture)).unwrap());
    assert!(text(casters.remove_texture(texture)).contains("2 materials have this texture"));
    casters.remove_material(materials[0]).unwrap();
    assert!(text(casters.remove_texture(texture)).contains("1 materials have this texture"));
    casters.replace_material(materials[1], &Material::default(), None).unwrap();
    casters.remove_texture(texture).unwrap();
    // Its place is taken again, and its handle is not.
    let other = casters.add_texture(&picture()).unwrap();
    for refused in [
        text(casters.remove_texture(texture)),
        text(casters.add_material(&Material::default(), Some(texture))),
        text(casters.replace_material(materials[1], &Material::default(), Some(texture))),
    ] {
        assert!(refused.contains("names no texture"), "{refused}");
    }
    casters.replace_material(materials[1], &Material::default(), Some(other)).unwrap();
    assert!(text(casters.remove_texture(other)).contains("1 materials"));
}

#[test]
fn what_is_not_finite_or_leads_nowhere_is_refused() {
    let gpu = gpu();
    let mut casters = Casters::empty(&gpu).unwrap();
    let mesh = casters.add_mesh(&primitive::cube()).unwrap();
    let material = casters.add_material(&Material::default(), None).unwrap();
    let nan = DAffine3::from_translation(DVec3::NAN);
    assert!(text(casters.insert(&Placement::new(mesh, material, nan))).contains("not finite"));
    let instance = casters.insert(&Placement::new(mesh, material, DAffine3::IDENTITY)).unwrap();
    for odd in [nan, DAffine3::from_scale(DVec3::splat(f64::INFINITY))] {
        assert!(text(casters.move_instance(instance, &odd)).contains("not finite"));
    }
    let broken = Mesh { indices: vec![0, 1, 99], ..primitive::cube() };
    assert!(text(casters.add_mesh(&broken)).contains("beyond its vertices"));
    assert!(text(casters.replace_mesh(mesh, &broken)).contains("beyond its vertices"));
    assert!(text(casters.deform_mesh(mesh, &primitive::plane())).contains("use `replace_mesh`"));
    let torn =
        Texture { name: "torn".into(), width: 4, height: 4, rgba: vec![[0; 4]; 3], sampling: Default::default() };
    assert!(text(casters.add_texture(&torn)).contains("`torn`"));
    let mut scene = Scene::default();
    let cube = scene.add_mesh(primitive::cube());
    let plain = scene.add_material(Material::default());
    scene.place(cube, plain, nan);
    assert!(text(Casters::new(&gpu, &scene)).contains("instance 0: a transform that is not finite"));
    assert_eq!(casters.len(), 1, "nothing has changed");
}

#[test]
fn a_host_that_forgets_to_record_is_told() {
    let gpu = gpu();
    let mut scene = Scene::default();
    let (floor, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(8.0)));
    scene.place(cube, material, DAffine3::from_translation(DVec3::Y));
    let depth = target_texture(&gpu, "depth", (8, 8), 1, wgpu::TextureFormat::Depth32Float);
    let depth = depth.create_view(&Default::default());
    let receivers = Receivers::new(&gpu, &depth, None, (8, 8)).unwrap();
    let target = VisibilityTarget::new(&gpu, 8, 8).unwrap();
    let light = Light::new(LightShape::Point { position: DVec3::Y * 4.0 });
    let camera = Camera::default().view(8, 8);
    let mut casters = Casters::new(&gpu, &scene).unwrap();
    let mut technique = find("shadow-map").unwrap().default_settings().make(&gpu).unwrap();
    let mut recorder = Recorder::new(&gpu);
    let mut frame = |casters: &mut Casters, records: bool| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = recorder.begin(&mut encoder);
        if records {
            casters.record(&mut passes)?;
        }
        let view = View { camera, receivers: &receivers, casters, light: &light, textures: &[] };
        technique.prepare(&gpu, &view)?.record(&mut passes, &target)?;
        passes.finish();
        gpu.queue.submit([encoder.finish()]);
        Ok::<(), Error>(())
    };
    frame(&mut casters, false).unwrap();
    let moved = casters.instance(1).unwrap();
    casters.move_instance(moved, &DAffine3::from_translation(DVec3::Y * 2.0)).unwrap();
    assert!(text(frame(&mut casters, false)).contains("call `Casters::record`"));
    frame(&mut casters, true).unwrap();
    frame(&mut casters, false).unwrap();
    casters.remove(moved).unwrap();
    assert!(text(frame(&mut casters, false)).contains("call `Casters::record`"));
}
