//! Shadow volumes against the ground truth, view by view, and against themselves.

mod agree;
mod cameras;
mod choices;
mod counting;
mod culling;
mod depth_host;
mod flags;
mod hosts;
mod inspect;
mod layers;
mod lights;
mod meshes;
mod models;
mod moving;
mod poses;
mod random;
mod references;
mod transforms;
mod views;

use crate::common::{mask, move_instance, renderer};
use umbrage::Gpu;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::core::{Camera, Image, Light, LightShape, Material, Scene, primitive};
use umbrage_metrics::{TOLERANCE, interior};
use umbrage_reference::{Options, Tracer};
use umbrage_renderer::Renderer;

/// The ways to count that are right everywhere.
pub const COUNTS: [&str; 3] = ["count=z-fail", "count=auto", "count=z-pass-eye"];

/// All ways to hard shadows that are exact to the pixel: those, and wedges of a light that has no
/// size, counted from the eye and from infinity.
pub const EXACT: [&str; 5] = ["count=z-fail", "count=auto", "count=z-pass-eye", "wedges", "wedges:unseen=on"];

/// A scene that several settings of the technique draw, to be seen from anywhere under any light.
pub struct Bench {
    pub scene: Scene,
    tracer: Tracer,
    size: (u32, u32),
    renderers: Vec<(String, Renderer)>,
}

/// What a picture should be.
pub struct Target {
    pub reference: Image<f32>,
    /// Where it is compared.
    pub mask: Image<bool>,
    /// Where it is far from every shadow edge, too.
    inside: Image<bool>,
    /// No light reaches the eye.
    pub is_eye_in_shadow: bool,
}

impl Target {
    pub fn new(reference: Image<f32>, mask: Image<bool>, is_eye_in_shadow: bool) -> Self {
        Self { inside: interior(&reference, &mask, None), reference, mask, is_eye_in_shadow }
    }

    /// How many pixels are compared, and how many of them are dark.
    pub fn pixels(&self) -> (usize, usize) {
        let dark = |(scored, v): (&bool, &f32)| *scored && *v < 0.5;
        let count = self.mask.data.iter().filter(|m| **m).count();
        (count, self.mask.data.iter().zip(&self.reference.data).filter(|p| dark(*p)).count())
    }

    /// The pixels of a picture that are compared and off.
    pub fn wrong(&self, produced: &Image<f32>) -> Vec<(u32, u32)> {
        assert_eq!(produced.size(), self.mask.size());
        let pixels = (0..produced.height).flat_map(|y| (0..produced.width).map(move |x| (x, y)));
        // NaN is off, too.
        let is_right = |p: &(u32, u32)| (produced[*p] - self.reference[*p]).abs() <= TOLERANCE as f32;
        pixels.filter(|p| self.mask[*p] && !is_right(p)).collect()
    }

    /// Percentages of pixels that are right: of all, and of those far from every shadow edge.
    pub fn right_pct(&self, produced: &Image<f32>) -> (f64, f64) {
        let wrong = self.wrong(produced);
        let inside = wrong.iter().filter(|p| self.inside[**p]).count();
        let all_inside = self.inside.data.iter().filter(|i| **i).count();
        let pct = |wrong: usize, of: usize| 100.0 - 100.0 * wrong as f64 / of.max(1) as f64;
        (pct(wrong.len(), self.pixels().0), pct(inside, all_inside))
    }

    /// What is wrong with a picture: more than one pixel in a thousand, or one that is far from
    /// every shadow edge.
    pub fn complaint(&self, what: &str, produced: &Image<f32>) -> Option<String> {
        let (correct, inside) = self.right_pct(produced);
        if correct >= 99.9 && inside == 100.0 {
            return None;
        }
        let wrong = self.wrong(produced);
        let some: Vec<_> = wrong.iter().take(4).map(|p| (p, self.reference[*p])).collect();
        let (scored, dark) = self.pixels();
        let off = wrong.len();
        Some(format!(
            "{what}: {correct:.3} % correct, {inside:.3} % inside; {off} of {scored} pixels wrong, {dark} dark; {some:?}"
        ))
    }
}

impl Bench {
    /// Renderers for the first light of `scene`.
    pub fn new(gpu: &Gpu, scene: Scene, size: (u32, u32), sets: &[&str]) -> Self {
        let made = sets.iter().map(|set| {
            let mut renderer = renderer_of(gpu, &scene, set, size);
            // What is left out is what the technique leaves out.
            renderer.set_clipping(false);
            (set.to_string(), renderer)
        });
        Self { renderers: made.collect(), tracer: Tracer::new(&scene), scene, size }
    }

    /// What every renderer gives, and what `read` makes of it.
    pub fn draw<T>(&mut self, camera: &Camera, light: &Light, read: impl Fn(&Renderer) -> T) -> Vec<(String, T)> {
        let drawn = self.renderers.iter_mut().map(|(set, renderer)| {
            *renderer.light_mut(0).unwrap() = light.clone();
            renderer.frame(camera).unwrap_or_else(|e| panic!("{set}: {e}"));
            (set.clone(), read(renderer))
        });
        drawn.collect()
    }

    /// The visibility that every renderer gives, 1 where no surface is: whatever is there means
    /// nothing.
    pub fn visibility_of_surfaces(&mut self, camera: &Camera, light: &Light) -> Vec<(String, Image<f32>)> {
        self.draw(camera, light, |renderer| {
            let (seen, depth) = (renderer.visibility(0).unwrap(), renderer.depth(camera).unwrap());
            Image::from_fn(seen.width, seen.height, |x, y| if depth[(x, y)] > 0.0 { seen[(x, y)] } else { 1.0 })
        })
    }

    /// The visibility that every renderer gives.
    pub fn visibility(&mut self, camera: &Camera, light: &Light) -> Vec<(String, Image<f32>)> {
        self.draw(camera, light, |renderer| renderer.visibility(0).unwrap())
    }

    /// The renderer of settings number `i`.
    pub fn renderer(&mut self, i: usize) -> &mut Renderer {
        &mut self.renderers[i].1
    }

    /// Moves and bends the instances to how `scene` has them; the truth does not follow.
    pub fn move_all(&mut self, scene: &Scene) {
        for (_, renderer) in &mut self.renderers {
            for (i, instance) in scene.instances.iter().enumerate() {
                move_instance(renderer, i, &instance.world_from_mesh);
                if let Some(joints) = scene.joints(instance) {
                    let instance = renderer.casters().instance(i).expect("an instance of the scene");
                    renderer.casters_mut().set_pose(instance, &joints).expect("a pose");
                }
            }
        }
    }

    /// What the renderer of settings number `i` counted of this.
    pub fn count_of(&mut self, i: usize, name: &str) -> u64 {
        let counts = self.renderers[i].1.technique(0).unwrap().inside().counts();
        counts.iter().find(|(n, _)| *n == name).unwrap_or_else(|| panic!("no count {name}")).1
    }

    /// The truth of distant pixels, too.
    pub fn whole_target(&self, camera: &Camera, light: &Light) -> Target {
        target(&self.tracer, camera, light, self.size, f32::INFINITY)
    }

    /// The truth.
    pub fn target(&self, camera: &Camera, light: &Light) -> Target {
        target(&self.tracer, camera, light, self.size, 60.0)
    }

    /// Complaints about a view, one for each of the settings that are wrong.
    pub fn complaints(&mut self, what: &str, camera: &Camera, light: &Light) -> Vec<String> {
        let target = self.target(camera, light);
        assert!(target.pixels().0 > 0, "{what}: nothing to compare");
        self.compare(what, camera, light, &target)
    }

    /// The same with the truth at hand.
    pub fn compare(&mut self, what: &str, camera: &Camera, light: &Light, target: &Target) -> Vec<String> {
        let drawn = self.visibility(camera, light);
        drawn.iter().filter_map(|(set, seen)| target.complaint(&format!("{what}, {set}"), seen)).collect()
    }

    /// The same for the scene's own camera and light.
    pub fn own_complaints(&mut self, what: &str) -> Vec<String> {
        let (camera, light) = (self.scene.camera.clone(), self.scene.lights[0].clone());
        self.complaints(what, &camera, &light)
    }
}

/// Settings of volumes, or of wedges as `wedges:name=value`.
pub fn renderer_of(gpu: &Gpu, scene: &Scene, set: &str, size: (u32, u32)) -> Renderer {
    let wedges = set.strip_prefix("wedges").map(|set| ("wedges", set.trim_start_matches(':')));
    let (technique, set) = wedges.unwrap_or(("volume", set));
    renderer(gpu, scene, 0, technique, set, size)
}

/// What `tracer` finds, to be compared up to a distance of `far` metres.
pub fn target(tracer: &Tracer, camera: &Camera, light: &Light, size: (u32, u32), far: f32) -> Target {
    let (width, height) = size;
    let geometry = tracer.geometry(camera, width, height);
    let options = Options { samples: 1, ..Options::default() };
    let truth = tracer.visibility(&geometry, light, &[], &options, &|_, _| ());
    let mask = mask(&truth, &geometry, far);
    Target::new(truth.visibility, mask, tracer.blocked(camera.eye, light.shape.center()))
}

/// Fails with all complaints.
pub fn assert_none(complaints: &[String]) {
    assert!(complaints.is_empty(), "{} complaints\n{}", complaints.len(), complaints.join("\n"));
}

/// A 10 m floor under a light, seen from above, and nothing on it yet.
pub fn floor(shape: LightShape) -> Scene {
    let mut scene = Scene { lights: vec![Light::new(shape)], ..Scene::default() };
    let plane = scene.add_mesh(primitive::plane());
    let material = scene.add_material(Material::default());
    scene.place(plane, material, DAffine3::from_scale(DVec3::splat(10.0)));
    scene.camera = Camera { eye: DVec3::new(0.0, 4.0, 7.0), ..Camera::default() };
    scene
}

/// Puts a mesh of material 0 into a scene; returns the number of the instance.
pub fn put(scene: &mut Scene, mesh: umbrage::core::Mesh, place: DAffine3) -> usize {
    let mesh = scene.add_mesh(mesh);
    scene.place(mesh, 0, place);
    scene.instances.len() - 1
}
