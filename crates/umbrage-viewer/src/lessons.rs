//! Settings that break a technique, for learners: found from what its parameters say of themselves.

use umbrage::{Param, ParamKind, TechniqueInfo};

/// One setting that shows what a parameter is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Lesson {
    /// The parameter.
    pub name: &'static str,
    /// The value that breaks it, as users type it.
    pub value: String,
    /// What is seen then.
    pub about: &'static str,
}

impl Lesson {
    /// For a button.
    pub fn title(&self) -> String {
        format!("{} {}", self.name, self.value)
    }

    /// The technique that is broken so, as the command line has it.
    pub fn label(&self, info: &TechniqueInfo) -> String {
        format!("{}:{}={}", info.id, self.name, self.value)
    }
}

/// The smallest map that still shows something, texels across.
const SMALL_MAP: i64 = 64;

/// All that a technique has.
pub(crate) fn of(info: &TechniqueInfo) -> Vec<Lesson> {
    info.params().iter().filter_map(lesson).collect()
}

fn lesson(param: &Param) -> Option<Lesson> {
    let (value, about) = match (param.name, param.unit, param.kind) {
        ("size", "texels", ParamKind::Int { min, .. }) => {
            (min.max(SMALL_MAP).to_string(), "Texels of the map are seen: steps at edges, and thin things are lost")
        }
        ("bias", _, ParamKind::Float { min, .. }) => (min.to_string(), "Surfaces shadow themselves"),
        ("bleeding", _, ParamKind::Float { min, .. }) => {
            (min.to_string(), "Light leaks in where one shadow lies behind another")
        }
        ("radius", "texels" | "pixels", ParamKind::Float { min, .. }) => {
            (min.to_string(), "Edges are as hard as the map")
        }
        ("splits", _, ParamKind::Int { min, .. }) => {
            (min.to_string(), "One map for near and far: coarse near the camera")
        }
        ("taps" | "kernel" | "samples" | "search", _, ParamKind::Int { min, .. }) => {
            (min.to_string(), "Too few for a smooth penumbra: noise, or bands")
        }
        ("noise", _, ParamKind::Choice { values }) => {
            let none = values.iter().find(|value| **value == "none")?;
            (none.to_string(), "All pixels take the same pattern: bands in place of noise")
        }
        (_, _, ParamKind::Switch { default: true }) if param.help.contains("Without") => {
            ("off".into(), "What this switch is for: its help says what happens without it")
        }
        _ => return None,
    };
    (value != param.kind.default().to_string()).then_some(Lesson { name: param.name, value, about })
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage::Registry;

    #[test]
    fn every_lesson_is_a_setting_that_can_be_made() {
        let registry = Registry::default();
        let mut taught = 0;
        for info in registry.techniques() {
            for lesson in of(info) {
                let mut settings = info.default_settings();
                settings.set(&registry, lesson.name, &lesson.value).unwrap();
                assert!(settings.changed().next().is_some(), "{}: {lesson:?} breaks nothing", info.id);
                taught += 1;
            }
        }
        assert!(taught > registry.techniques().len(), "{taught}");
    }

    #[test]
    fn maps_get_small_and_taps_few() {
        let registry = Registry::default();
        let lessons = of(registry.find("pcss-jitter").unwrap());
        let value = |name: &str| lessons.iter().find(|l| l.name == name).map(|l| l.value.as_str());
        assert_eq!((value("size"), value("bias"), value("taps")), (Some("64"), Some("0"), Some("1")));
    }
}
