//! Techniques as users name them: `id`, or `id:name=value:name=value`.

use crate::error::Error;
use std::collections::BTreeMap;
use umbrage::{Contact, Gpu, LightPoints, Registry, Settings, Technique, TechniqueInfo, Value};
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

/// The pseudo-parameter that adds contact shadows: how long their rays are.
pub const CONTACT: &str = "contact";

/// The pseudo-parameter that says how thick they take things to be.
pub const CONTACT_THICKNESS: &str = "contact-thickness";

/// The pseudo-parameter that averages a soft technique over pieces of the light.
pub const LIGHT_PIECES: &str = "light-pieces";

/// All that stand for no parameter of the technique.
const PSEUDO: [&str; 5] = [LIGHT_SAMPLES, LIGHT_FRAMES, LIGHT_PIECES, CONTACT, CONTACT_THICKNESS];

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
    /// Pieces of the light to average over.
    pub light_pieces: Option<u32>,
    /// Contact shadows on top.
    pub contact: Option<Contact>,
    /// What its user should know: the name that it has now, where it was called by an old one.
    pub note: Option<String>,
    registry: Registry,
    changed: BTreeMap<String, String>,
}

impl Choice {
    /// The technique `id` of a registry with the parameters `set`, in which [`LIGHT_SAMPLES`],
    /// [`LIGHT_FRAMES`], [`LIGHT_PIECES`], [`CONTACT`] and [`CONTACT_THICKNESS`] may stand too.
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
        let (pseudo, set): (Vec<_>, Vec<_>) = set.iter().cloned().partition(|(name, _)| PSEUDO.contains(&&**name));
        let last = |of: &str| pseudo.iter().rev().find(|(name, _)| name == of).map(|(_, value)| value.as_str());
        let settings = registry.settings(id, &set)?;
        let samples = |value| parse_light_samples(registry, &settings, value);
        let light_samples = last(LIGHT_SAMPLES).map(samples).transpose()?;
        let light_frames = last(LIGHT_FRAMES).map(|value| parse_light_frames(light_samples, value)).transpose()?;
        let light_pieces = last(LIGHT_PIECES).map(|value| parse_light_pieces(&settings, value)).transpose()?;
        let contact = parse_contact(&settings, last(CONTACT), last(CONTACT_THICKNESS))?;
        let others = [LIGHT_FRAMES, LIGHT_PIECES, CONTACT, CONTACT_THICKNESS];
        let others = others.iter().filter_map(|name| Some((name.to_string(), last(name)?.to_string())));
        let changed = settings.changed().map(|(name, value)| (name.to_string(), value.to_string()));
        let changed = changed.chain(others).collect();
        let registry = registry.clone();
        Ok(Self { info, settings, light_samples, light_frames, light_pieces, contact, note: None, registry, changed })
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
        let (frames, contact) = (self.light_frames, self.contact);
        if let Some(samples) = self.light_samples {
            return Ok(LightPoints { samples, frames, contact }.average(gpu, &self.settings)?);
        }
        let technique = match self.light_pieces {
            Some(pieces) => umbrage::light_pieces(gpu, &self.settings, pieces)?,
            None => self.settings.make(gpu)?,
        };
        Ok(match contact {
            Some(contact) => umbrage::contact_shadows(gpu, technique, contact)?,
            None => technique,
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
            rest.partition(|(name, _)| PSEUDO.contains(&&**name) || now.params().iter().any(|p| p.name == name));
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

fn parse_light_pieces(settings: &Settings, value: &str) -> Result<u32, Error> {
    if settings.is_hard() {
        let id = settings.info().id;
        return Err(Error::Name(format!(
            "`{id}` is a hard technique; write {LIGHT_SAMPLES}=N instead of {LIGHT_PIECES}"
        )));
    }
    let number = value.parse().ok().filter(|n| (1..=16).contains(n));
    number.ok_or_else(|| Error::Name(format!("{LIGHT_PIECES} `{value}` is not a number from 1 to 16")))
}

fn parse_contact(settings: &Settings, length: Option<&str>, thickness: Option<&str>) -> Result<Option<Contact>, Error> {
    let Some(length) = length else {
        let text = format!("{CONTACT_THICKNESS} is for {CONTACT} shadows; write {CONTACT}=LENGTH before it");
        return thickness.map_or(Ok(None), |_| Err(Error::Name(text)));
    };
    if settings.info().answer() != umbrage::Answer::Visibility {
        let text = format!("`{}` answers with radiance; leave {CONTACT} out", settings.info().id);
        return Err(Error::Name(text));
    }
    let parsed = |name: &str, text: &str| {
        text.parse().map_err(|_| Error::Name(format!("{name} `{text}` is no length, such as 0.1 (metres) or 16px")))
    };
    let contact = Contact::new(parsed(CONTACT, length)?);
    let thickness = thickness.map(|text| parsed(CONTACT_THICKNESS, text)).transpose()?;
    let contact = Contact { thickness: thickness.unwrap_or(contact.thickness), ..contact };
    contact.check()?;
    Ok(Some(contact))
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
    fn contact_shadows_are_for_all_that_answer_with_visibility() {
        let label = |text: &str| self::text(parse(text, &[]));
        for text in ["pcf:contact=0.1", "none:contact=16px:contact-thickness=0.2"] {
            assert_eq!(label(text), text);
        }
        assert_eq!(label("shadow-map:contact=0.1:light-samples=4"), "shadow-map:contact=0.1:light-samples=4");
        assert!(label("pcf:contact-thickness=1").contains("contact=LENGTH"));
        assert!(label("pcf:contact=wide").contains("16px"));
        assert!(label("pcf:contact=0").contains("over 0"));
    }

    #[test]
    fn pieces_of_the_light_are_for_soft_techniques() {
        let label = |text: &str| self::text(parse(text, &[]));
        assert_eq!(label("pcss:light-pieces=4"), "pcss:light-pieces=4");
        assert!(label("shadow-map:light-pieces=4").contains("light-samples=N"));
        assert!(label("pcss:light-pieces=17").contains("1 to 16"));
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
