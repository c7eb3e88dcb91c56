//! A technique whose answer is radiance, among those that answer with visibility. Needs a graphics
//! adapter.

use umbrage::core::{Image, Scene};
use umbrage::fullscreen::attachment;
use umbrage::{
    Answer, Error, Gpu, InOrder, Inside, Passes, RadianceTarget, Stats, Technique, View, VisibilityTarget, find,
};
use umbrage_renderer::{LightPass, Renderer};

/// The same radiance from every surface.
struct Constant([f64; 3]);

impl Technique for Constant {
    fn prepare_view(&mut self, _: &Gpu, _: &View<'_>, _: InOrder) -> Result<(), Error> {
        Ok(())
    }

    fn record_visibility(
        &mut self,
        _: &mut Passes<'_>,
        _: &View<'_>,
        _: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        self.answer().refuse()
    }

    fn answer(&self) -> Answer {
        Answer::Radiance
    }

    fn record_radiance(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        radiance: &RadianceTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        radiance.check(view.receivers)?;
        let [r, g, b] = self.0;
        let color = wgpu::Color { r, g, b, a: 1.0 };
        passes.render("constant", &[attachment(&radiance.view, wgpu::LoadOp::Clear(color))], None);
        Ok(())
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Constant {
    fn stats(&self) -> Stats {
        Stats::default()
    }
}

const SIZE: (u32, u32) = (96, 72);
/// Powers of two, which half floats hold.
const COLOR: [f64; 3] = [0.25, 0.125, 0.0625];

fn gpu() -> Gpu {
    Gpu::request(None).unwrap_or_else(|e| panic!("this test needs a graphics adapter: {e}"))
}

fn scene() -> Scene {
    (umbrage::core::scenes::find("primitives").expect("a scene of the registry").build)(0.5)
}

fn hard(gpu: &Gpu) -> Box<dyn Technique> {
    find("shadow-map").unwrap().default_settings().make(gpu).unwrap()
}

fn renderer(gpu: &Gpu, scene: &Scene, techniques: Vec<Box<dyn Technique>>) -> Renderer {
    let passes = techniques.into_iter().enumerate().map(|(light, technique)| LightPass { light, technique });
    Renderer::new(gpu, scene, SIZE.0, SIZE.1, passes.collect()).unwrap()
}

fn color(renderer: &mut Renderer, scene: &Scene) -> Image<[u8; 4]> {
    renderer.frame(&scene.camera).unwrap();
    renderer.color().unwrap()
}

#[test]
fn radiance_is_added_as_it_is() {
    let gpu = gpu();
    let scene = scene();
    let mut glowing = scene.clone();
    glowing.materials.iter_mut().for_each(|m| m.emissive += umbrage::core::glam::DVec3::from(COLOR).as_vec3());
    // Beside a light under its visibility, too.
    for others in [0, 1] {
        let with = |first: Option<Box<dyn Technique>>| {
            let others = (0..others).map(|_| hard(&gpu));
            first.into_iter().chain(others).collect::<Vec<_>>()
        };
        let mut added = renderer(&gpu, &scene, with(Some(Box::new(Constant(COLOR)))));
        let lights = with(None).into_iter().map(|technique| LightPass { light: 1, technique }).collect();
        let mut emitted = Renderer::new(&gpu, &glowing, SIZE.0, SIZE.1, lights).unwrap();
        let (a, b) = (color(&mut added, &scene), color(&mut emitted, &glowing));
        let largest = a.data.as_flattened().iter().zip(b.data.as_flattened()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(largest <= Some(1), "half floats round sums of another order: {largest:?}");
        let dark = color(&mut renderer(&gpu, &scene, Vec::new()), &scene);
        assert!(a.data.iter().zip(&dark.data).any(|(a, b)| a[0] > b[0] + 20), "it is light");
    }
}

#[test]
fn the_answer_is_read_back_by_its_kind() {
    let gpu = gpu();
    let scene = scene();
    let mut renderer = renderer(&gpu, &scene, vec![Box::new(Constant(COLOR)), hard(&gpu)]);
    for (width, height) in [SIZE, (40, 30)] {
        renderer.resize(width, height).unwrap();
        renderer.frame(&scene.camera).unwrap();
        assert_eq!(renderer.radiance(0).unwrap(), Image::filled(width, height, COLOR.map(|c| c as f32)));
        assert_eq!(renderer.visibility(1).unwrap().size(), (width, height));
    }
    for error in [renderer.visibility(0).unwrap_err(), renderer.radiance(1).unwrap_err()] {
        assert!(matches!(error, Error::Unsupported { .. }) && error.to_string().contains("answers with"), "{error}");
    }
}

#[test]
fn one_kind_takes_the_place_of_the_other() {
    let gpu = gpu();
    let scene = scene();
    let mut kept = renderer(&gpu, &scene, vec![hard(&gpu)]);
    let shaded = color(&mut kept, &scene);
    kept.set_technique(0, Box::new(Constant(COLOR))).unwrap();
    let constant = color(&mut kept, &scene);
    assert_eq!(constant, color(&mut renderer(&gpu, &scene, vec![Box::new(Constant(COLOR))]), &scene));
    let before = kept.exchange(0, LightPass { light: 0, technique: hard(&gpu) }).unwrap();
    assert_eq!(before.technique.answer(), Answer::Radiance);
    assert_eq!(color(&mut kept, &scene), shaded);
    assert_ne!(shaded, constant);
}

#[test]
fn an_overlay_is_made_of_visibility() {
    let gpu = gpu();
    let scene = scene();
    let volume = find("volume").unwrap().default_settings().make(&gpu).unwrap();
    let mut renderer = renderer(&gpu, &scene, vec![volume, Box::new(Constant(COLOR))]);
    renderer.set_overlay(Some(0.5)).unwrap();
    let error = renderer.frame(&scene.camera).unwrap_err();
    assert!(error.to_string().contains("answers with radiance"), "{error}");
    renderer.set_overlay(None).unwrap();
    renderer.frame(&scene.camera).unwrap();
}
