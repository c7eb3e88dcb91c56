//! A map that is kept shows what a map that is drawn anew in every frame would, and costs nothing
//! where nothing changes.

use crate::common::{gpu, move_instance, pairs, scene};
use umbrage::core::glam::{DAffine3, DVec3, Vec4};
use umbrage::core::{Camera, LightShape, Material, Scene};
use umbrage::fullscreen::target_texture;
use umbrage::{Casters, Gpu, Receivers, Recorder, View, VisibilityTarget, find};
use umbrage_renderer::{LightPass, Renderer};

/// The same scene with maps that are kept and with maps that are not.
struct Pair {
    scene: Scene,
    camera: Camera,
    kept: Renderer,
    drawn: Renderer,
    name: String,
    frame: u32,
}

impl Pair {
    fn new(gpu: &Gpu, scene: Scene, light: usize, id: &str, set: &str) -> Self {
        let [kept, drawn] = ["on", "off"].map(|cache| {
            let info = find(id).unwrap();
            let settings = info.settings(&pairs(&format!("size=128,{set},cache={cache}"))).unwrap();
            let technique = settings.make(gpu).unwrap();
            Renderer::new(gpu, &scene, 96, 72, vec![LightPass { light, technique }]).unwrap()
        });
        let camera = scene.camera.clone();
        Self { camera, kept, drawn, scene, name: format!("{id} {set}, light {light}"), frame: 0 }
    }

    /// Moves an instance away from where the scene has it.
    fn place(&mut self, instance: usize, by: DVec3) {
        let world_from_mesh = DAffine3::from_translation(by) * self.scene.instances[instance].world_from_mesh;
        for renderer in [&mut self.kept, &mut self.drawn] {
            move_instance(renderer, instance, &world_from_mesh);
        }
    }

    fn show(&mut self, instance: usize, shown: bool) {
        for renderer in [&mut self.kept, &mut self.drawn] {
            let instance = renderer.casters().instance(instance).unwrap();
            renderer.casters_mut().show(instance, shown).unwrap();
        }
    }

    fn turn_light(&mut self, by: f64) {
        for renderer in [&mut self.kept, &mut self.drawn] {
            match &mut renderer.light_mut(0).unwrap().shape {
                LightShape::Directional { direction, .. } => *direction = (*direction + DVec3::X * by).normalize(),
                LightShape::Point { position } | LightShape::Spot { position, .. } => position.x += by,
                other => panic!("{other:?} is not moved here"),
            }
        }
    }

    /// Draws a frame with both and compares; returns the draws of the one that keeps maps, and of
    /// the other.
    fn check(&mut self, what: &str) -> [u32; 2] {
        self.frame += 1;
        let [kept, drawn] = [&mut self.kept, &mut self.drawn].map(|renderer| {
            renderer.frame(&self.camera).unwrap();
            renderer.visibility(0).unwrap().data
        });
        let off = kept.iter().zip(&drawn).filter(|(a, b)| a != b).count();
        assert!(off == 0, "{}: {off} pixels differ in frame {}, {what}", self.name, self.frame);
        [self.kept.stats(0).draws, self.drawn.stats(0).draws]
    }
}

/// Casters that are not flat, by their number.
fn movable(scene: &Scene) -> Vec<usize> {
    let is_flat = |i: &usize| scene.meshes[scene.instances[*i].mesh].plane().is_some();
    (0..scene.instances.len()).filter(|i| scene.instances[*i].casts && !is_flat(i)).collect()
}

/// Everything that may happen to a scene; returns the draws of a frame in which nothing did, with
/// and without maps that are kept.
fn live_through(pair: &mut Pair) -> [u32; 2] {
    let movable = movable(&pair.scene);
    let size = pair.scene.bounds().size().length();
    let up = |t: f64| DVec3::Y * (0.02 * size * t);
    pair.check("the first");
    let [still, drawn] = pair.check("nothing changes");
    for i in 0..5 {
        pair.place(movable[0], up(f64::from(i)));
        pair.check("one moves");
        pair.check("it stands");
    }
    pair.place(movable[1 % movable.len()], up(1.5));
    pair.check("another moves");
    pair.show(movable[0], false);
    pair.check("one is hidden");
    pair.check("it stays hidden");
    pair.show(movable[0], true);
    pair.check("it is shown again");
    pair.place(movable[0], DVec3::new(9.0 * size, 0.0, 0.0));
    pair.check("one leaves the scene");
    pair.place(movable[0], up(1.0));
    pair.check("it is back");
    for i in 0..3 {
        movable.iter().for_each(|m| pair.place(*m, up(0.3 * f64::from(i))));
        pair.check("all move");
    }
    for i in 0..35 {
        pair.place(movable[0], up(0.1 * f64::from(i)));
        if i % 5 == 0 || i > 28 {
            pair.check("one moves while the others stop");
        } else {
            pair.kept.frame(&pair.camera).unwrap();
        }
    }
    pair.place(movable[1 % movable.len()], up(2.0));
    pair.check("one that rested moves");
    pair.turn_light(0.03);
    pair.check("the light moves");
    pair.check("the light stands");
    pair.place(movable[0], up(3.0));
    pair.check("one moves under the new light");
    pair.camera.eye += DVec3::new(0.01 * size, 0.0, 0.0);
    pair.check("the camera moves");
    pair.camera.target = pair.camera.eye * 2.0 - pair.camera.target;
    pair.place(movable[0], up(1.0));
    pair.check("the camera turns");
    pair.camera = pair.scene.camera.clone();
    pair.check("the camera is back");
    [still, drawn]
}

#[test]
fn kept_maps_show_what_drawn_ones_do() {
    let gpu = gpu();
    let spot = |mut scene: Scene| {
        let position = scene.camera.eye + DVec3::Y * 3.0;
        let direction = (scene.camera.target - position).normalize();
        let (inner_angle_deg, outer_angle_deg) = (20.0, 35.0);
        scene.lights[0].shape = LightShape::Spot { position, direction, inner_angle_deg, outer_angle_deg };
        scene
    };
    let cases = [
        (scene("primitives", 0.2), "shadow-map", "focus=light"),
        (scene("primitives", 0.2), "shadow-map", "focus=visible"),
        (scene("primitives", 0.2), "shadow-map", "focus=light,faces=midpoint"),
        (scene("city", 0.1), "shadow-map", "focus=light"),
        (scene("city", 0.1), "pcf", "focus=visible,kernel=3"),
        (scene("lantern", 0.2), "shadow-map", "focus=light"),
        (scene("lantern", 0.2), "shadow-map", "focus=light,omni=dual-paraboloid"),
        (scene("lantern", 0.2), "vsm", "focus=visible"),
        (scene("city", 0.1), "evsm", "focus=light"),
        (scene("lantern", 0.2), "pcss", "focus=light"),
        (spot(scene("primitives", 0.2)), "shadow-map", "focus=light"),
    ];
    for (scene, id, set) in cases {
        let mut pair = Pair::new(&gpu, scene, 0, id, set);
        let [still, drawn] = live_through(&mut pair);
        assert!(still < drawn, "{}: a frame without a change took {still} draws of {drawn}", pair.name);
    }
}

#[test]
fn movers_are_drawn_over_casters_at_rest() {
    let gpu = gpu();
    let mut pair = Pair::new(&gpu, scene("city", 0.2), 0, "shadow-map", "focus=light");
    let mover = movable(&pair.scene)[200];
    let mut triangles = Vec::new();
    for i in 0..6 {
        pair.place(mover, DVec3::new(0.5 * f64::from(i), 0.0, 0.0));
        pair.check("one moves");
        triangles.push([pair.kept.stats(0).triangles, pair.drawn.stats(0).triangles]);
    }
    let [first, all] = triangles[0];
    assert_eq!(first, all, "the first frame draws everything");
    let [kept, all] = triangles[5];
    assert!(kept < 30 && all > 3000, "a box and the full-screen triangle were {kept} of {all} triangles");
    let held = [&pair.kept, &pair.drawn].map(|r| r.stats(0).bytes);
    assert_eq!(held[0] - held[1], 128 * 128 * 4, "the map of those at rest counts");
}

#[test]
fn a_place_that_an_instance_has_is_no_move() {
    let gpu = gpu();
    let mut pair = Pair::new(&gpu, scene("primitives", 0.1), 0, "shadow-map", "focus=light");
    (0..3).for_each(|_| {
        (0..pair.scene.instances.len()).for_each(|i| pair.place(i, DVec3::ZERO));
        pair.check("everything is put where it is");
    });
    assert_eq!(pair.kept.stats(0).draws, 1, "the look-up alone");
}

/// What is opaque casts the same in any colour; with an alpha mask it does not.
#[test]
fn another_colour_draws_no_map() {
    let gpu = gpu();
    let mut pair = Pair::new(&gpu, scene("primitives", 0.1), 0, "shadow-map", "focus=light");
    (0..3).for_each(|_| {
        pair.check("before");
    });
    let mut change = |material: &Material, all: bool| {
        for renderer in [&mut pair.kept, &mut pair.drawn] {
            let casters = renderer.casters_mut();
            let id = casters.material(0).unwrap();
            casters.replace_material(id, material, None).unwrap();
            let new = casters.add_material(material, None).unwrap();
            let instances: Vec<_> = (0..).map_while(|i| casters.instance(i)).collect();
            instances.iter().filter(|_| all).for_each(|id| casters.set_material(*id, new).unwrap());
        }
        pair.check("another look")[0]
    };
    let red = Material { base_color: Vec4::new(1.0, 0.2, 0.1, 1.0), ..Material::default() };
    assert_eq!([change(&red, false), change(&red, true)], [1, 1], "the look-up alone");
    let clear = Material { alpha_cutoff: Some(2.0), ..red.clone() };
    assert!(change(&clear, true) > 1, "all are cut out");
    assert_eq!(change(&clear, false), 1, "no instance has the first material any more");
    assert!(change(&red, true) > 1, "all are there again");
}

#[test]
fn a_dropped_encoder_leaves_nothing_behind() {
    let gpu = gpu();
    let scene = scene("primitives", 0.1);
    let info = find("shadow-map").unwrap();
    let mut technique = info.settings(&pairs("size=64")).unwrap().make(&gpu).unwrap();
    let casters = Casters::new(&gpu, &scene).unwrap();
    let depth = target_texture(&gpu, "depth", (16, 16), 1, wgpu::TextureFormat::Depth32Float);
    let receivers = Receivers::new(&gpu, &depth.create_view(&Default::default()), None, (16, 16)).unwrap();
    let target = VisibilityTarget::new(&gpu, 16, 16).unwrap();
    let mut recorder = Recorder::new(&gpu);
    let mut frame = |submit: bool| {
        let camera = scene.camera.view(16, 16);
        let light = &scene.lights[0];
        let view = View { camera, receivers: &receivers, casters: &casters, light, textures: &[] };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = recorder.begin(&mut encoder);
        technique.prepare(&gpu, &view).unwrap().record(&mut passes, &target).unwrap();
        passes.finish();
        if submit {
            gpu.queue.submit([encoder.finish()]);
        }
        technique.inside().stats().draws
    };
    let first = frame(false);
    assert_eq!(frame(true), first, "nothing was drawn in the frame that was dropped");
    assert_eq!(frame(true), 1, "a submitted map is kept");
    assert_eq!(frame(false), 1);
    assert_eq!(frame(true), first, "whatever was in the dropped frame is drawn again");
}
