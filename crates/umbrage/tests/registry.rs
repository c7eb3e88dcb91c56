//! The registry holds together. Needs no GPU.

use base64::{Engine, prelude::BASE64_STANDARD};
use std::{collections::HashSet, sync::LazyLock};
use umbrage::core::{LightKind, LightKinds};
use umbrage::{Answer, ParamKind, Registry, TechniqueInfo, find, techniques};

#[test]
fn ids_are_unique_and_match_their_folders() {
    let mut seen = HashSet::new();
    for info in Registry::default().all() {
        assert!(seen.insert(info.id), "{} comes twice", info.id);
        let folder = format!("{}/src/techniques/{}", env!("CARGO_MANIFEST_DIR"), info.id.replace('-', "_"));
        let pictures = info.readme.split("](").skip(1).filter_map(|link| link.split(')').next());
        for file in pictures.filter(|link| !link.contains("://")).chain(["mod.rs", "README.md"]) {
            assert!(std::path::Path::new(&folder).join(file).is_file(), "{folder}/{file}");
        }
        assert_eq!(find(info.id).map(|i| i.id), Ok(info.id));
    }
}

#[test]
fn readmes_begin_with_their_technique() {
    for info in Registry::default().all() {
        assert!(info.readme.starts_with(&format!("# `{}`", info.id)), "{}: heading", info.id);
    }
}

/// The pictures of the documentation, drawn by the example `gallery`.
const GALLERY: &str = include_str!("../src/techniques/gallery.txt");

/// The bytes of each technique's picture, by what stands in the row of it.
fn pictured(info: &TechniqueInfo) -> Vec<u8> {
    let start = format!("| ![{}](data:image/png;base64,", info.id);
    let module = info.id.replace('-', "_");
    let end = format!(") | [`{}`](self::{module}): {} |", info.id, info.summary);
    let mut rows = GALLERY.lines().filter_map(|row| row.strip_prefix(&*start)?.strip_suffix(&*end));
    let row = rows.next().unwrap_or_else(|| panic!("{}: no row; run the example `gallery`", info.id));
    BASE64_STANDARD.decode(row).unwrap_or_else(|e| panic!("{}: {e}", info.id))
}

#[test]
fn the_documentation_has_a_picture_of_each_technique() {
    assert_eq!(GALLERY.lines().count(), techniques().len() + 2, "rows of others; run the example `gallery`");
    let mut seen = HashSet::new();
    for info in techniques() {
        let picture = umbrage_io::pictures::texture_from_bytes(info.id.as_ref(), &pictured(info)).unwrap();
        assert_eq!((picture.width, picture.height), (200, 150), "{}", info.id);
        seen.insert(picture.rgba);
    }
    // Some hard shadows are the same ones.
    assert!(seen.len() > 12, "{} pictures", seen.len());
}

#[test]
fn lists_are_by_what_techniques_answer() {
    let registry = Registry::default();
    assert!(registry.techniques().iter().all(|info| info.answer() == Answer::Visibility));
    assert!(registry.of_radiance().iter().all(|info| info.answer() == Answer::Radiance));
    for info in registry.all() {
        let takes_sky = info.lights.contains(LightKind::Environment);
        assert_eq!(takes_sky, info.answer() == Answer::Radiance, "{}", info.id);
    }
    // One of the same id gives its place up to another, whatever that answers.
    static OTHER: LazyLock<TechniqueInfo> = LazyLock::new(|| TechniqueInfo { title: "other", ..*find("prt").unwrap() });
    let with = registry.with(&OTHER);
    assert_eq!(with.of_radiance().iter().map(|info| info.title).collect::<Vec<_>>(), ["other"]);
}

#[test]
fn defaults_are_in_range_and_words_are_not_empty() {
    for info in Registry::default().all() {
        assert!(!info.title.is_empty() && !info.summary.is_empty() && !info.source.is_empty());
        let mut names = HashSet::new();
        for p in info.params() {
            assert!(names.insert(p.name) && !p.help.is_empty(), "{} {}", info.id, p.name);
            let set = [(p.name.to_string(), p.kind.default().to_string())];
            assert!(info.settings(&set).is_ok(), "{} {}: the default is not allowed", info.id, p.name);
            if let ParamKind::Choice { values } = p.kind {
                assert!(!values.is_empty());
            }
        }
    }
}

#[test]
fn a_light_that_a_technique_cannot_do_is_refused() {
    let hard_only = TechniqueInfo { lights: LightKinds::HARD, ..*find("pcf").unwrap() };
    assert_eq!(hard_only.supports(LightKind::Spot), Ok(()));
    let refused = hard_only.supports(LightKind::Line).unwrap_err().to_string();
    assert_eq!(refused, "pcf: not for line lights");
    let of_visibility = find("pcf").unwrap().supports(LightKind::Environment).unwrap_err().to_string();
    assert_eq!(of_visibility, "pcf: not for the environment, whose answer is radiance; choose prt");
    let of_radiance = find("prt").unwrap().supports(LightKind::Sphere).unwrap_err().to_string();
    assert!(of_radiance.starts_with("prt: not for sphere lights, whose answer is visibility"), "{of_radiance}");
}
