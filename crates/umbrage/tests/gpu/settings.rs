//! Settings that techniques take over in place, and what brute force forgets.

use crate::common::{gpu, scene};
use umbrage::{Param, ParamKind, Registry, Settings, TechniqueInfo, Value, light_samples, techniques};
use umbrage_renderer::{LightPass, Renderer};

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

/// That the picture is the one of a new technique, the renderer's tests hold.
#[test]
fn what_needs_no_new_pipeline_is_taken_over_in_place() {
    let gpu = gpu();
    let mut taken = Vec::new();
    for info in techniques() {
        for (param, settings) in live(info) {
            if small(info).make(&gpu).unwrap().set(&gpu, &settings).unwrap() {
                taken.push(format!("{}.{}", info.id, param.name));
            }
        }
    }
    for wanted in ["shadow-map.size", "pcf.bias", "pcss.size", "cascaded.lambda", "cascaded.splits", "psm.cube"] {
        assert!(taken.iter().any(|name| name == wanted), "{wanted} makes the technique anew: {taken:?}");
    }
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
    let technique = light_samples(&gpu, &settings, 16).unwrap();
    let mut renderer = Renderer::new(&gpu, &scene, 64, 48, vec![LightPass { light: 0, technique }]).unwrap();
    let mut draws = |forgets: bool| {
        if forgets {
            renderer.forget();
        }
        renderer.frame(&scene.camera).unwrap();
        renderer.stats(0).draws
    };
    let (first, kept) = (draws(false), draws(false));
    assert!(kept < first, "maps are kept: {kept} draws after {first}");
    assert_eq!(draws(true), first);
}
