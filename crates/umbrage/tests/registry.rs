//! The registry holds together. Needs no GPU.

use std::collections::HashSet;
use umbrage::core::{LightKind, LightKinds};
use umbrage::{ParamKind, TechniqueInfo, find, techniques};

#[test]
fn ids_are_unique_and_match_their_folders() {
    let mut seen = HashSet::new();
    for info in techniques() {
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
    for info in techniques() {
        assert!(info.readme.starts_with(&format!("# `{}`", info.id)), "{}: heading", info.id);
    }
}

#[test]
fn defaults_are_in_range_and_words_are_not_empty() {
    for info in techniques() {
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
}
