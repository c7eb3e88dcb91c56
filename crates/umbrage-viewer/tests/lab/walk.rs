//! Every technique with every parameter and every view, through the menus and sliders themselves.

use crate::common::{open, until};
use eframe::egui::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use umbrage::{Param, ParamKind, Registry, TechniqueInfo};
use umbrage_viewer::{Lab, Options};

/// Small pictures; what is tested here is that all of it can be had, not how it looks.
fn small() -> Harness<'static, Lab> {
    let scene = Some("contact:0.05".into());
    let mut lab = open([760.0, 1200.0], Options { scene, techniques: vec!["none".into()], ..Options::default() });
    lab.state_mut().set_divisor(Some(8));
    lab
}

/// A click on what has this name, and what it brings.
fn click(lab: &mut Harness<'static, Lab>, name: &str) {
    lab.get_by_role_and_label(Role::Button, name).click();
    lab.run_steps(2);
}

fn technique(lab: &Lab) -> String {
    lab.state().panes[0].technique.clone()
}

/// That nothing went wrong, or that the library itself says why it can't be.
fn check(lab: &mut Harness<'static, Lab>, info: &TechniqueInfo) {
    lab.run_steps(2);
    let state = lab.state();
    assert_eq!(state.messages(), Vec::<String>::new(), "{}", technique(state));
    if let Some(error) = state.error(0) {
        let is_known = error.contains(&format!("`{}`", info.id)) || error.contains("there is no `");
        assert!(is_known, "{}: {error}", technique(state));
    }
}

/// Changes a parameter as hands do, to several values.
fn change(lab: &mut Harness<'static, Lab>, registry: &Registry, param: &Param) -> usize {
    let before = technique(lab.state());
    match param.kind {
        ParamKind::Int { min, default, .. } => {
            let value = if min == default { min + 1 } else { min.max(default / 2) };
            lab.get_by_role_and_label(Role::Slider, param.name).set_value_accesskit(value as f64);
        }
        ParamKind::Float { min, max, default } => {
            let value = if min < default { (min + default) * 0.5 } else { min + (max - min) * 0.1 };
            lab.get_by_role_and_label(Role::Slider, param.name).set_value_accesskit(value);
        }
        ParamKind::Switch { .. } => lab.get_by_label(param.name).click(),
        _ => {
            let words = param.kind.words(registry);
            let word = words.last().copied().unwrap_or_default();
            lab.get_by_label(param.name).click();
            lab.run_steps(2);
            let choices: Vec<_> = lab.get_all_by_label(word).collect();
            choices.last().unwrap_or_else(|| panic!("{word} is not in the list of {}", param.name)).click();
        }
    }
    lab.run_steps(2);
    usize::from(technique(lab.state()) != before)
}

#[test]
fn every_technique_parameter_and_view_can_be_had() {
    let registry = Registry::default();
    let mut lab = small();
    let (mut changed, mut shown) = (0, 0);
    for (number, info) in registry.techniques().iter().enumerate() {
        if number > 0 {
            lab.key_press(eframe::egui::Key::Space);
            lab.run_steps(2);
        }
        let light = lab.state().state().lights[0].shape.kind();
        if info.supports(light).is_err() {
            continue;
        }
        while !technique(lab.state()).starts_with(info.id) {
            lab.key_press(eframe::egui::Key::Space);
            lab.run_steps(2);
        }
        check(&mut lab, info);
        for param in info.params() {
            changed += change(&mut lab, &registry, param);
            check(&mut lab, info);
            if technique(lab.state()) != info.id {
                click(&mut lab, "All defaults");
            }
            assert_eq!(technique(lab.state()), info.id, "{} goes back to its defaults", info.id);
        }
        for view in info.views {
            lab.state_mut().set_picture(0, view);
            check(&mut lab, info);
            shown += usize::from(lab.state().error(0).is_none());
        }
        lab.state_mut().set_picture(0, "color");
    }
    let params: usize = registry.techniques().iter().map(|t| t.params().len()).sum();
    println!("{changed} of {params} parameters changed, {shown} views shown");
    assert!(changed * 10 > params * 9, "only {changed} of {params} parameters changed");
}

#[test]
fn the_menus_lead_to_every_technique_and_picture() {
    let mut lab = small();
    click(&mut lab, "Technique");
    let item = lab.get_all_by_label("vsm").last();
    item.unwrap().click();
    lab.run_steps(3);
    assert_eq!(technique(lab.state()), "vsm");
    click(&mut lab, "Picture");
    lab.get_all_by_label("texel-size").last().unwrap().click();
    lab.run_steps(2);
    assert_eq!(lab.state().state().panes[0].picture, "texel-size");
    until(&mut lab, "the texels", |lab| lab.error(0).is_none());
    click(&mut lab, "Panes");
    click(&mut lab, "Compare with the truth");
    until(&mut lab, "all three", Lab::is_shown);
    assert_eq!(lab.state().state().panes.len(), 3);
}
