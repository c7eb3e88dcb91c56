//! Techniques as users name them: `id`, or `id:name=value:name=value`.

use crate::error::Error;
use std::collections::BTreeMap;
use umbrage::{Gpu, Registry, Settings, Technique, TechniqueInfo, Value};
use umbrage_core::LightKind;

/// Name of the CPU ray tracer where a technique may be named.
pub const RAY_TRACED: &str = "ray-traced";

/// What it is, in one sentence.
pub const RAY_TRACED_SUMMARY: &str =
    "The truth, traced on the CPU with rays to points all over the light. Everything is compared with it.";

/// Name of the path tracer where a technique may be named.
pub const PATH_TRACED: &str = "path-traced";

/// What it is, in one sentence.
pub const PATH_TRACED_SUMMARY: &str =
    "The truth about light from the sky, direct and reflected, traced on the CPU along paths that end in the sky.";

umbrage::settings! {
    /// Its settings.
    pub struct RayTraced {
        /// Rays for each pixel; 1 is the one ray to the light's centre, the perfect hard shadow.
        samples: u32 = 1024, in 1..=1048576,
    }
}

impl RayTraced {
    /// From pairs of name and value.
    ///
    /// # Errors
    /// Names that are not known, with the nearest one, and values out of range.
    pub fn read(registry: &Registry, set: &[(String, String)]) -> Result<Self, Error> {
        let mut settings = Self::default();
        umbrage::read_settings(registry, RAY_TRACED, &mut settings, set)?;
        Ok(settings)
    }
}

/// The pseudo-parameter that averages a hard technique over points of the light.
pub const LIGHT_SAMPLES: &str = "light-samples";

/// The pseudo-parameter that spreads these points over so many frames, as many in each.
pub const LIGHT_FRAMES: &str = "light-frames";

/// A technique with checked settings.
#[derive(Clone, Debug)]
pub struct Choice {
    /// What it is.
    pub info: &'static TechniqueInfo,
    /// All its parameters.
    pub settings: Settings,
    /// Points of the light to average over by brute force.
    pub light_samples: Option<u32>,
    /// Frames that these are spread over, each with other points.
    pub light_frames: Option<u32>,
    /// What its user should know: the name that it has now, where it was called by an old one.
    pub note: Option<String>,
    registry: Registry,
    changed: BTreeMap<String, String>,
}

impl Choice {
    /// The technique `id` of a registry with the parameters `set`, in which [`LIGHT_SAMPLES`] and
    /// [`LIGHT_FRAMES`] may stand too.
    ///
    /// # Errors
    /// Names that are not known, with the nearest one, and values out of range.
    pub fn new(registry: &Registry, id: &str, set: &[(String, String)]) -> Result<Self, Error> {
        if id == PATH_TRACED {
            let text =
                format!("`{PATH_TRACED}` is a reference that is no technique here; take it with `umbrage render`");
            return Err(Error::Name(text));
        }
        if id == RAY_TRACED {
            let text = format!("`{RAY_TRACED}` is the reference of every comparison already; leave it out");
            return Err(Error::Name(text));
        }
        if let Some(renamed) = Renamed::of(id, set) {
            return renamed.choice(registry, set);
        }
        let info = registry.find(id)?;
        let (brute, set): (Vec<_>, Vec<_>) = set.iter().cloned().partition(|(name, _)| name == LIGHT_SAMPLES);
        let (spread, set): (Vec<_>, Vec<_>) = set.into_iter().partition(|(name, _)| name == LIGHT_FRAMES);
        let settings = registry.settings(id, &set)?;
        let light_samples =
            brute.last().map(|(_, value)| parse_light_samples(registry, &settings, value)).transpose()?;
        let light_frames = spread.last().map(|(_, value)| parse_light_frames(light_samples, value)).transpose()?;
        let changed = settings.changed().map(|(name, value)| (name.to_string(), value.to_string()));
        let changed = changed.chain(light_frames.map(|n| (LIGHT_FRAMES.to_string(), n.to_string()))).collect();
        Ok(Self { info, settings, light_samples, light_frames, note: None, registry: registry.clone(), changed })
    }

    /// Reads `id:name=value:name=value`; `set` holds what applies to the technique wherever it is
    /// named, as `(id, name, value)`.
    ///
    /// # Errors
    /// As [`Choice::new`], and for a part without `=`.
    pub fn parse(registry: &Registry, text: &str, set: &[(String, String, String)]) -> Result<Self, Error> {
        let mut parts = text.split(':');
        let id = parts.next().unwrap_or_default();
        let mut pairs: Vec<_> =
            set.iter().filter(|(of, ..)| of == id).map(|(_, name, value)| (name.clone(), value.clone())).collect();
        for part in parts {
            let pair = part.split_once('=').ok_or_else(|| {
                Error::Name(format!("`{part}` in `{text}` is no setting; write technique:name=value:name=value"))
            })?;
            pairs.push((pair.0.into(), pair.1.into()));
        }
        Self::new(registry, id, &pairs)
    }

    /// The choices that a list such as `all` or `shadow-map,pcf:kernel=7` makes.
    ///
    /// # Errors
    /// As [`Choice::parse`]; settings of `set` for a technique that is not in the list.
    pub fn list(registry: &Registry, names: &[String], set: &[(String, String, String)]) -> Result<Vec<Self>, Error> {
        let mut choices = Vec::new();
        for name in names {
            if name == "all" {
                for info in registry.techniques() {
                    choices.push(Self::parse(registry, info.id, set)?);
                }
            } else {
                choices.push(Self::parse(registry, name, set)?);
            }
        }
        for (id, name, value) in set {
            let is_named = |name: &String| name.split(':').next() == Some(id);
            if !choices.iter().any(|c| c.info.id == id) && !names.iter().any(is_named) {
                registry.find(id)?;
                let text = format!("--set {id}.{name}={value}: `{id}` is not among the techniques asked for");
                return Err(Error::Name(text));
            }
        }
        Ok(choices)
    }

    /// Averages a hard technique over `samples` points of the light, unless it says itself over how
    /// many.
    pub fn or_light_samples(mut self, samples: Option<u32>) -> Self {
        if self.settings.is_hard() {
            self.light_samples = self.light_samples.or(samples);
        }
        self
    }

    /// The registry that it is from: its filters are those that settings may name.
    pub fn registry(&self) -> &Registry {
        &self.registry
    }

    /// The parameters that are not at their default.
    pub fn changed(&self) -> &BTreeMap<String, String> {
        &self.changed
    }

    /// The value of a parameter, [`LIGHT_SAMPLES`] among them; `None` where it is a word, or there
    /// is none of the name.
    pub fn number(&self, name: &str) -> Option<f64> {
        if name == LIGHT_SAMPLES {
            return self.light_samples.map(f64::from);
        }
        match self.settings.get(name)? {
            Value::Int(value) => Some(value as f64),
            Value::Float(value) => Some(value),
            Value::Choice(_) | Value::Switch(_) | Value::Filter(_) => None,
        }
    }

    /// Id and what is set, as one would write it.
    pub fn label(&self) -> String {
        let mut label = self.info.id.to_string();
        self.changed.iter().for_each(|(name, value)| label += &format!(":{name}={value}"));
        self.light_samples.iter().for_each(|n| label += &format!(":{LIGHT_SAMPLES}={n}"));
        label
    }

    /// Whether it can do lights of this kind.
    ///
    /// # Errors
    /// One that names the kind.
    pub fn supports(&self, kind: LightKind) -> Result<(), Error> {
        // Averaged over points of the light, a technique only needs to do points and directions.
        let hard = if kind == LightKind::Sun { LightKind::Directional } else { LightKind::Point };
        let asked = if self.light_samples.is_some() && kind.is_soft() { hard } else { kind };
        Ok(self.info.supports(asked)?)
    }

    /// Makes it.
    ///
    /// # Errors
    /// What the adapter can't do.
    pub fn make(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Ok(match (self.light_samples, self.light_frames) {
            (Some(n), Some(frames)) => umbrage::light_samples_over(gpu, &self.settings, n, frames)?,
            (Some(n), None) => umbrage::light_samples(gpu, &self.settings, n)?,
            (None, _) => self.settings.make(gpu)?,
        })
    }
}

/// A technique that is called by an old name.
struct Renamed(&'static umbrage::Renamed);

impl Renamed {
    fn of(id: &str, set: &[(String, String)]) -> Option<Self> {
        let last = |param: &str| set.iter().rev().find(|(name, _)| name == param).map(|(_, value)| value.as_str());
        umbrage::RENAMED.iter().find(|r| r.technique == id && last(r.param) == Some(r.value)).map(Self)
    }

    /// The same by its name of today. What has no effect on it is checked and left out.
    fn choice(self, registry: &Registry, set: &[(String, String)]) -> Result<Choice, Error> {
        let Self(old) = self;
        let (before, now) = (registry.find(old.technique)?, registry.find(old.to)?);
        let rest = set.iter().filter(|(name, _)| name != old.param).cloned();
        let (own, others): (Vec<_>, Vec<_>) =
            rest.partition(|(name, _)| name == LIGHT_SAMPLES || now.params().iter().any(|p| p.name == name));
        registry.settings(before.id, &others)?;
        let mut choice = Choice::new(registry, now.id, &own)?;
        let name = format!("{}:{}={}", old.technique, old.param, old.value);
        let mut note = format!("`{name}` is the technique `{}` now; write `{}`", now.id, choice.label());
        if let Some((first, _)) = others.first() {
            note += &format!(", without `{first}`, which has no effect on it");
        }
        choice.note = Some(note);
        Ok(choice)
    }
}

fn parse_light_samples(registry: &Registry, settings: &Settings, value: &str) -> Result<u32, Error> {
    if !settings.is_hard() {
        let hard: Vec<&str> = registry.techniques().iter().filter(|t| t.hard).map(|t| t.id).collect();
        let filter = settings.iter().find_map(|(name, value)| match value {
            Value::Filter(_) => Some(format!(" with another {name} than these")),
            _ => None,
        });
        let (id, filter) = (settings.info().id, filter.unwrap_or_default());
        let text = format!("`{id}`{filter} is not a hard technique; {LIGHT_SAMPLES} is for {}", hard.join(", "));
        return Err(Error::Name(text));
    }
    let number = value.parse().ok().filter(|n| *n > 0);
    number.ok_or_else(|| Error::Name(format!("{LIGHT_SAMPLES} `{value}` is not a number over 0")))
}

fn parse_light_frames(light_samples: Option<u32>, value: &str) -> Result<u32, Error> {
    if light_samples.is_none() {
        let text = format!("{LIGHT_FRAMES} spreads the points of {LIGHT_SAMPLES}; write {LIGHT_SAMPLES}=N before it");
        return Err(Error::Name(text));
    }
    let number = value.parse().ok().filter(|n| (1..=64).contains(n));
    number.ok_or_else(|| Error::Name(format!("{LIGHT_FRAMES} `{value}` is not a number from 1 to 64")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str, set: &[(String, String, String)]) -> Result<Choice, Error> {
        Choice::parse(&Registry::default(), text, set)
    }

    fn list(names: &[String], set: &[(String, String, String)]) -> Result<Vec<Choice>, Error> {
        Choice::list(&Registry::default(), names, set)
    }

    fn text(result: Result<Choice, Error>) -> String {
        result.map(|c| c.label()).unwrap_or_else(|e| e.to_string())
    }

    #[test]
    fn settings_are_read_and_written_alike() {
        assert_eq!(text(parse("shadow-map:size=512", &[])), "shadow-map:size=512");
        let set = [("shadow-map".into(), "size".into(), "500".into())];
        assert_eq!(text(parse("shadow-map:light-samples=16", &set)), "shadow-map:size=500:light-samples=16");
        assert_eq!(text(parse("none", &set)), "none");
    }

    #[test]
    fn mistakes_are_named() {
        assert!(text(parse("shadowmap", &[])).contains("did you mean `shadow-map`"));
        assert!(text(parse("shadow-map:size", &[])).contains("name=value"));
        assert!(text(parse("shadow-map:light-samples=0", &[])).contains("over 0"));
        assert!(text(parse("none:light-samples=4", &[])).contains("not a hard technique"));
        for id in ["psm", "lispsm", "plane-optimal", "cascaded"] {
            let hard = format!("{id}:filter=shadow-map:light-samples=4");
            assert_eq!(text(parse(&hard, &[])), hard);
            let filtered = text(parse(&format!("{id}:light-samples=4"), &[]));
            assert!(filtered.contains("with another filter than these is not a hard technique"), "{filtered}");
        }
        assert!(text(parse(RAY_TRACED, &[])).contains("already"));
        let unused = [("pcf".into(), "size".into(), "512".into())];
        let list = list(&["none".into()], &unused).map(|l| l.len()).unwrap_err().to_string();
        assert!(list.contains("not among"), "{list}");
    }

    #[test]
    fn points_are_spread_over_frames_where_there_are_some() {
        let label = |text: &str| parse(text, &[]).map_or_else(|error| error.to_string(), |choice| choice.label());
        let both = "shadow-map:light-frames=64:light-samples=4";
        assert_eq!(label(both), both);
        assert!(label("shadow-map:light-frames=8").contains("light-samples=N"));
        assert!(label("shadow-map:light-samples=4:light-frames=65").contains("1 to 64"));
    }

    #[test]
    fn light_samples_for_all_go_to_hard_techniques_that_have_none() {
        let label = |name: &str| parse(name, &[]).unwrap().or_light_samples(Some(9)).label();
        assert_eq!(label("shadow-map"), "shadow-map:light-samples=9");
        assert_eq!(label("shadow-map:light-samples=4"), "shadow-map:light-samples=4");
        assert_eq!(label("none"), "none");
    }

    #[test]
    fn old_names_are_understood_and_lead_to_new_ones() {
        let old = parse("wedges:samples=64:combine=bitmask", &[]).unwrap();
        assert_eq!((old.info.id, old.label().as_str()), ("light-mask", "light-mask:samples=64"));
        assert!(old.note.is_some_and(|note| note.contains("write `light-mask:samples=64`")));
        let set = |value: &str| [("wedges".to_string(), "combine".to_string(), value.to_string())];
        let list = |value| Choice::list(&Registry::default(), &["wedges".into()], &set(value)).unwrap().remove(0);
        assert_eq!((list("bitmask").info.id, list("max").info.id), ("light-mask", "wedges"));
        assert_eq!(list("max").note, None);
        let scaled = parse("wedges:combine=bitmask:scale=1/2", &[]).unwrap();
        assert!(scaled.note.is_some_and(|note| note.contains("without `scale`")));
        assert!(text(parse("wedges:combine=bitmask:scale=7", &[])).contains("scale"));
        for old in umbrage::RENAMED {
            let info = umbrage::find(old.technique).unwrap();
            assert!(info.settings(&[(old.param.into(), old.value.into())]).is_err(), "{old:?} is both");
        }
    }

    #[test]
    fn all_is_the_registry() {
        let all = list(&["all".into()], &[]).unwrap();
        assert_eq!(all.len(), umbrage::techniques().len());
    }
}
