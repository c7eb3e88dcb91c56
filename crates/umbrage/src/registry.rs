//! Which techniques there are: those that are built in, and those that a host adds.

use crate::depth_maps::MapSetup;
use crate::error::{Error, nearest};
use crate::settings::{ParamKind, Setting, Settings, Value};
use crate::technique::{Technique, TechniqueInfo};
use crate::{Answer, Gpu, techniques as built_in};
use std::fmt;

/// Techniques by id, in the order in which they are best explained. The default are those that are
/// built in.
#[derive(Clone, Debug)]
pub struct Registry {
    techniques: Vec<&'static TechniqueInfo>,
    of_radiance: Vec<&'static TechniqueInfo>,
}

impl Default for Registry {
    fn default() -> Self {
        Self { techniques: built_in::BUILT_IN.to_vec(), of_radiance: built_in::OF_RADIANCE.to_vec() }
    }
}

impl Registry {
    /// Adds a technique from outside of the library, last; one of the same id gives its place up to
    /// it.
    #[must_use]
    pub fn with(mut self, info: &'static TechniqueInfo) -> Self {
        let (own, others) = match info.answer() {
            Answer::Visibility => (&mut self.techniques, &mut self.of_radiance),
            Answer::Radiance => (&mut self.of_radiance, &mut self.techniques),
        };
        others.retain(|t| t.id != info.id);
        match own.iter_mut().find(|t| t.id == info.id) {
            Some(old) => *old = info,
            None => own.push(info),
        }
        self
    }

    /// All techniques that answer with visibility.
    pub fn techniques(&self) -> &[&'static TechniqueInfo] {
        &self.techniques
    }

    /// All techniques that answer with [radiance](Answer::Radiance), for the light of a sky.
    pub fn of_radiance(&self) -> &[&'static TechniqueInfo] {
        &self.of_radiance
    }

    /// Both, those that answer with visibility first.
    pub fn all(&self) -> impl Iterator<Item = &'static TechniqueInfo> + '_ {
        self.techniques.iter().chain(&self.of_radiance).copied()
    }

    /// The technique that users call `id`.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest id.
    pub fn find(&self, id: &str) -> Result<&'static TechniqueInfo, Error> {
        self.all().find(|t| t.id == id).ok_or_else(|| self.unknown(id))
    }

    fn unknown(&self, id: &str) -> Error {
        let what = "technique";
        match built_in::LEFT_OUT.iter().find(|(module, _)| *module == id.replace('-', "_")) {
            Some((_, feature)) => {
                Error::Unknown { what, name: format!("{id}` without the feature `{feature}"), nearest: None }
            }
            None => {
                let nearest = nearest(id, self.all().map(|t| t.id));
                Error::Unknown { what, name: id.into(), nearest }
            }
        }
    }

    /// Techniques that look up maps which others fit; with `warped` those that can do so where
    /// texels differ in size.
    pub fn filters(&self, warped: bool) -> impl Iterator<Item = &'static TechniqueInfo> + '_ {
        self.techniques.iter().copied().filter(move |t| t.filter.is_some_and(|f| f.warped || !warped))
    }

    /// Settings of the technique `id` from pairs of name and value; what is not named keeps its
    /// default.
    ///
    /// # Errors
    /// [`Error::Unknown`] for an id or a name, [`Error::Setting`] for a value.
    pub fn settings(&self, id: &str, set: &[(String, String)]) -> Result<Settings, Error> {
        let mut settings = self.find(id)?.default_settings();
        for (name, value) in set {
            settings.set(self, name, value).map_err(|error| self.naming_others(error))?;
        }
        Ok(settings)
    }

    /// Reads `id:name=value:name=value`.
    ///
    /// # Errors
    /// As [`Registry::settings`]; a part without `=` is [`Error::Unknown`].
    pub fn parse(&self, text: &str) -> Result<Settings, Error> {
        let (id, rest) = text.split_once(':').unwrap_or((text, ""));
        let pair = |part: &str| {
            let (name, value) = part.split_once('=').ok_or_else(|| Error::Unknown {
                what: "setting",
                name: format!("{part}` in `{text}`; write `id:name=value:name=value"),
                nearest: None,
            })?;
            Ok((name.to_string(), value.to_string()))
        };
        let set: Vec<_> = rest.split(':').filter(|part| !part.is_empty()).map(pair).collect::<Result<_, Error>>()?;
        self.settings(id, &set)
    }

    /// A word that other techniques know for the same parameter: their names are the remedy.
    fn naming_others(&self, mut error: Error) -> Error {
        if let Error::Setting { name, value, expected, .. } = &mut error {
            let knows = |t: &&&TechniqueInfo| {
                t.params().iter().any(|p| p.name == name && p.kind.words(self).contains(&value.as_str()))
            };
            let others: Vec<_> = self.all().filter(|t| knows(&t)).map(|t| t.id).collect();
            if !others.is_empty() {
                expected.push_str(&format!(
                    "; choose one of these, or a technique that can do `{value}`: {}",
                    others.join(", ")
                ));
            }
        }
        error
    }
}

/// The techniques that are built in and answer with visibility, in the order in which they are best
/// explained; [`Registry::of_radiance`] has the others.
pub fn techniques() -> &'static [&'static TechniqueInfo] {
    built_in::BUILT_IN
}

/// The technique that is built in and that users call `id`.
///
/// # Errors
/// [`Error::Unknown`] with the nearest id.
pub fn find(id: &str) -> Result<&'static TechniqueInfo, Error> {
    Registry::default().find(id)
}

/// Reads `id:name=value:name=value` of a technique that is built in.
///
/// ```no_run
/// # fn main() -> Result<(), umbrage::Error> {
/// let gpu = umbrage::Gpu::request(None)?;
/// let technique = umbrage::parse("pcf:kernel=7")?.make(&gpu)?;
/// # Ok(()) }
/// ```
///
/// # Errors
/// As [`Registry::parse`].
pub fn parse(text: &str) -> Result<Settings, Error> {
    Registry::default().parse(text)
}

/// A technique that looks up maps which another technique fits: splits or a warp.
pub trait Filter {
    /// Makes the technique for these maps in place of its own.
    ///
    /// # Errors
    /// As [`Configure::make`](crate::Configure::make).
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error>;
}

/// What a filter can look up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilterUse {
    /// Also maps whose texels differ in size.
    pub warped: bool,
}

/// A technique that is a [`Filter`], as the value of a setting.
#[derive(Clone, Copy)]
pub struct FilterId<const WARPED: bool = false>(&'static TechniqueInfo);

impl<const WARPED: bool> FilterId<WARPED> {
    /// The technique, where it is a filter that fits.
    pub fn of(info: &'static TechniqueInfo) -> Option<Self> {
        info.filter.filter(|f| f.warped || !WARPED).map(|_| Self(info))
    }

    /// Which technique it is.
    pub fn info(self) -> &'static TechniqueInfo {
        self.0
    }

    /// Makes the filter with its own default settings for these maps.
    pub(crate) fn make_on(self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        self.0.check(gpu)?;
        let settings = self.0.default_settings();
        let filter = settings.as_filter().ok_or_else(|| Error::Unsupported {
            technique: self.0.id.into(),
            what: "maps that another technique fits".into(),
        })?;
        filter.make_on(gpu, maps)
    }
}

impl FilterId {
    /// What finds hard shadows in maps.
    pub(crate) fn hard() -> Self {
        Self(built_in::HARD_FILTER)
    }

    /// What finds the penumbras of a light in maps.
    pub(crate) fn soft() -> Self {
        Self(built_in::SOFT_FILTER)
    }
}

impl<const WARPED: bool> Default for FilterId<WARPED> {
    fn default() -> Self {
        Self(built_in::DEFAULT_FILTER)
    }
}

impl<const WARPED: bool> PartialEq for FilterId<WARPED> {
    fn eq(&self, other: &Self) -> bool {
        self.0.id == other.0.id
    }
}

impl<const WARPED: bool> fmt::Debug for FilterId<WARPED> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.id)
    }
}

impl<const WARPED: bool> Setting for FilterId<WARPED> {
    fn kind(default: Self, _: Option<(Self, Self)>) -> ParamKind {
        ParamKind::Filter { warped: WARPED, default: FilterId(default.0) }
    }

    fn value(self) -> Value {
        Value::Filter(FilterId(self.0))
    }

    fn from_value(value: Value) -> Option<Self> {
        if let Value::Filter(id) = value { Self::of(id.0) } else { None }
    }
}
