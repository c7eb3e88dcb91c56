//! Settings that techniques take over in place, and what brute force forgets.

use crate::common::{gpu, scene};
use umbrage::core::{Image, Scene};
use umbrage::techniques::none::NoShadow;
use umbrage::{Gpu, Param, ParamKind, Registry, Settings, Technique, TechniqueInfo, Value, light_samples, techniques};
use umbrage_renderer::{LightPass, Renderer};

const SIZE: (u32, u32) = (64, 48);

/// A technique in a renderer of its own, that shows the first light.
struct Shown<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    renderer: Renderer,
}

impl<'a> Shown<'a> {
    fn new(gpu: &'a Gpu, scene: &'a Scene, technique: Box<dyn Technique>) -> Self {
        let passes = vec![LightPass { light: 0, technique }];
        Self { gpu, scene, renderer: Renderer::new(gpu, scene, SIZE.0, SIZE.1, passes).unwrap() }
    }

    fn frame(&mut self) -> Image<f32> {
        self.renderer.frame(&self.scene.camera).unwrap();
        self.renderer.visibility(0).unwrap()
    }

    fn set(&mut self, settings: &Settings) -> bool {
        let stand_in = Settings::from(NoShadow {}).make(self.gpu).unwrap();
        let LightPass { light, mut technique } =
            self.renderer.exchange(0, LightPass { light: 0, technique: stand_in }).unwrap();
        let taken = technique.set(self.gpu, settings).unwrap();
        self.renderer.exchange(0, LightPass { light, technique }).unwrap();
        taken
    }
}

/// Another value than the default, small enough for a quick test.
fn another(param: &Param) -> String {
    match param.kind {
        ParamKind::Int { min, max, default } => (default / 2).clamp(min, max).to_string(),
        ParamKind::Float { min, max, default } => {
            let new = if default == 0.0 { 0.3 } else { default * 0.5 };
            new.clamp(min, max).to_string()
        }
        ParamKind::Switch { default } => Value::Switch(!default).to_string(),
        ParamKind::Choice { .. } | ParamKind::Filter { .. } => param.kind.words(&Registry::default())[1].into(),
    }
}

fn live(info: &'static TechniqueInfo) -> impl Iterator<Item = (&'static Param, Settings)> {
    info.params().iter().filter(|param| param.live).map(move |param| {
        let mut settings = small(info);
        settings.set(&Registry::default(), param.name, &another(param)).unwrap();
        (param, settings)
    })
}

/// The defaults, with small maps.
fn small(info: &'static TechniqueInfo) -> Settings {
    let set: &[_] = if info.family.has_maps() { &[("size".into(), "256".into())] } else { &[] };
    info.settings(set).unwrap()
}

#[test]
fn settings_taken_over_in_place_give_the_picture_of_a_new_technique() {
    let gpu = gpu();
    let mut taken = Vec::new();
    for scene in [scene("primitives", 0.3), scene("duelling-frusta", 0.3)] {
        for info in techniques() {
            for (param, settings) in live(info) {
                let mut old = Shown::new(&gpu, &scene, small(info).make(&gpu).unwrap());
                let before = old.frame();
                if old.set(&settings) {
                    taken.push(format!("{}.{}", info.id, param.name));
                    let wanted = Shown::new(&gpu, &scene, settings.make(&gpu).unwrap()).frame();
                    let worst = largest_difference(&old.frame(), &wanted);
                    assert!(worst < 2e-3, "{settings} in place of {} is off by {worst}", small(info));
                } else {
                    assert!(largest_difference(&old.frame(), &before) < 2e-3, "{settings} was refused, yet it counts");
                }
            }
        }
    }
    for wanted in ["shadow-map.size", "pcf.bias", "pcss.size", "cascaded.lambda", "cascaded.splits", "psm.cube"] {
        assert!(taken.iter().any(|name| name == wanted), "{wanted} makes the technique anew: {taken:?}");
    }
}

fn largest_difference(a: &Image<f32>, b: &Image<f32>) -> f32 {
    a.data.iter().zip(&b.data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn settings_that_differ_in_more_are_told_apart() {
    let parse = |text| umbrage::parse(text).unwrap();
    assert!(parse("pcf").differs_live(&parse("pcf:size=512:bias=2")));
    assert!(!parse("pcf").differs_live(&parse("pcf:size=512:kernel=5")));
    assert!(!parse("pcf").differs_live(&parse("shadow-map:size=512")));
}

#[test]
fn brute_force_under_a_hard_light_forgets_its_maps() {
    let (gpu, scene) = (gpu(), scene("primitives", 0.3));
    let settings = umbrage::parse("shadow-map:size=128").unwrap();
    let mut shown = Shown::new(&gpu, &scene, light_samples(&gpu, &settings, 16).unwrap());
    let mut draws = || {
        shown.renderer.frame(&scene.camera).unwrap();
        shown.renderer.stats(0).draws
    };
    let (first, kept) = (draws(), draws());
    assert!(kept < first, "maps are kept: {kept} draws after {first}");
    shown.renderer.forget();
    shown.renderer.frame(&scene.camera).unwrap();
    assert_eq!(shown.renderer.stats(0).draws, first);
}
