//! Settings of techniques: typed where a technique reads them, by name where users write them.
//!
//! A technique declares its settings once, with [`settings!`](crate::settings!); [`Configure`]
//! makes the technique of them. [`Settings`] is any technique's settings, for the command line, the
//! window and the comparison.

#[doc(hidden)]
pub mod declare;
mod param;

use crate::depth_maps::MapSetup;
use crate::error::{Error, nearest};
use crate::registry::{Filter, Registry};
use crate::{Answer, Gpu, Technique, TechniqueInfo};
pub use declare::{Group, Setting};
pub use param::{Param, ParamKind, Value};
use std::fmt::{self, Debug};
use umbrage_core::transfer::Wanted;

/// Settings that a technique can be made of.
pub trait Configure: Group + Clone + Default + Debug + Send + Sync + 'static {
    /// What the program knows of the technique.
    const INFO: &'static TechniqueInfo;

    /// What the technique answers; as its [`Technique::answer`].
    const ANSWER: Answer = Answer::Visibility;

    /// Whether the technique [lends](Technique::lend) its maps to shaders of a host's own.
    const LENT: bool = false;

    /// Makes the technique; values are in range and the device has what [`Configure::INFO`] asks
    /// for.
    ///
    /// # Errors
    /// What the settings ask of this device in vain.
    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error>;

    /// The same as a filter for maps that another technique fits, where [`TechniqueInfo::filter`]
    /// says so.
    fn as_filter(&self) -> Option<&dyn Filter> {
        None
    }

    /// What maps the technique renders; `None` where it has none.
    fn maps(&self) -> Option<MapSetup> {
        None
    }

    /// The baked transfer that the technique works from; as its [`Technique::wants`].
    fn wants(&self) -> Option<Wanted> {
        None
    }

    /// Makes the technique.
    ///
    /// # Errors
    /// [`Error::Setting`] names a field out of its range, [`Error::Unsupported`] a feature or limit
    /// that the device lacks; [`Error::Size`] is for sizes beyond its limits.
    fn make(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        check(Self::INFO.id, Self::params(), self)?;
        Self::INFO.check(gpu)?;
        self.build(gpu)
    }
}

/// [`Configure`] for any technique, by name.
trait AnySettings: Debug + Send + Sync {
    fn get(&self, name: &str) -> Option<Value>;
    fn put(&mut self, name: &str, value: Value) -> bool;
    fn make(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error>;
    fn as_filter(&self) -> Option<&dyn Filter>;
    fn maps(&self) -> Option<MapSetup>;
    fn wants(&self) -> Option<Wanted>;
    fn copy(&self) -> Box<dyn AnySettings>;
}

impl<T: Configure> AnySettings for T {
    fn get(&self, name: &str) -> Option<Value> {
        Group::get(self, name)
    }

    fn put(&mut self, name: &str, value: Value) -> bool {
        Group::put(self, name, value)
    }

    fn make(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Configure::make(self, gpu)
    }

    fn as_filter(&self) -> Option<&dyn Filter> {
        Configure::as_filter(self)
    }

    fn maps(&self) -> Option<MapSetup> {
        Configure::maps(self)
    }

    fn wants(&self) -> Option<Wanted> {
        Configure::wants(self)
    }

    fn copy(&self) -> Box<dyn AnySettings> {
        Box::new(self.clone())
    }
}

/// A technique with settings, of any type.
pub struct Settings {
    info: &'static TechniqueInfo,
    values: Box<dyn AnySettings>,
}

impl<T: Configure> From<T> for Settings {
    fn from(values: T) -> Self {
        Self { info: T::INFO, values: Box::new(values) }
    }
}

impl Clone for Settings {
    fn clone(&self) -> Self {
        Self { info: self.info, values: self.values.copy() }
    }
}

impl PartialEq for Settings {
    fn eq(&self, other: &Self) -> bool {
        self.info.id == other.info.id && self.iter().eq(other.iter())
    }
}

impl Debug for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.values.fmt(f)
    }
}

/// `id:name=value:name=value`, only what is not at its default.
impl fmt::Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.info.id)?;
        self.changed().try_for_each(|(name, value)| write!(f, ":{name}={value}"))
    }
}

impl Settings {
    /// What they are the settings of.
    pub fn info(&self) -> &'static TechniqueInfo {
        self.info
    }

    /// All names and values, in the order of [`TechniqueInfo::params`].
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Value)> + '_ {
        self.info.params().iter().filter_map(|p| Some((p.name, self.get(p.name)?)))
    }

    /// What is not at its default.
    pub fn changed(&self) -> impl Iterator<Item = (&'static str, Value)> + '_ {
        let differs = |p: &Param| self.get(p.name).filter(|v| *v != p.kind.default()).map(|v| (p.name, v));
        self.info.params().iter().filter_map(differs)
    }

    /// The value of a parameter; `None` where the technique has none of that name.
    pub fn get(&self, name: &str) -> Option<Value> {
        self.values.get(name)
    }

    /// Changes a parameter to what `text` spells, filters being those of `registry`.
    ///
    /// # Errors
    /// [`Error::Unknown`] and [`Error::Setting`], as [`TechniqueInfo::settings`].
    pub fn set(&mut self, registry: &Registry, name: &str, text: &str) -> Result<(), Error> {
        let value = parse(registry, self.info.id, self.info.params(), name, text)?;
        self.values.put(name, value);
        Ok(())
    }

    /// Whether `other` is of the same technique and differs in [live](Param::live) parameters only,
    /// so that [`Technique::set`] may take it over.
    pub fn differs_live(&self, other: &Self) -> bool {
        let same = |p: &Param| p.live || self.get(p.name) == other.get(p.name);
        self.info.id == other.info.id && self.info.params().iter().all(same)
    }

    /// Makes the technique.
    ///
    /// # Errors
    /// As [`Configure::make`].
    pub fn make(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.values.make(gpu)
    }

    /// True where the technique, or the filter that it is set to, is [hard](TechniqueInfo::hard).
    pub fn is_hard(&self) -> bool {
        self.info.hard || self.iter().any(|(_, value)| matches!(value, Value::Filter(f) if f.info().hard))
    }

    /// As a filter for maps that another technique fits.
    pub fn as_filter(&self) -> Option<&dyn Filter> {
        self.values.as_filter()
    }

    /// What maps the technique renders; `None` where it has none.
    pub fn maps(&self) -> Option<MapSetup> {
        self.values.maps()
    }

    /// The baked transfer that the technique works from, see [`Technique::wants`].
    pub fn wants(&self) -> Option<Wanted> {
        self.values.wants()
    }
}

/// Fills `values` of the technique `id` from pairs of name and text.
///
/// # Errors
/// [`Error::Unknown`] for a name, [`Error::Setting`] for a value.
pub fn read<G: Group>(registry: &Registry, id: &str, values: &mut G, set: &[(String, String)]) -> Result<(), Error> {
    for (name, text) in set {
        let value = parse(registry, id, G::params(), name, text)?;
        values.put(name, value);
    }
    Ok(())
}

fn parse(registry: &Registry, id: &str, params: &[Param], name: &str, text: &str) -> Result<Value, Error> {
    let Some(param) = params.iter().find(|p| p.name == name) else {
        let nearest = nearest(name, params.iter().map(|p| p.name));
        return Err(Error::Unknown { what: "parameter", name: format!("{name}` of `{id}"), nearest });
    };
    param.kind.parse(text, registry).ok_or_else(|| out_of_range(registry, id, param, text))
}

fn out_of_range(registry: &Registry, id: &str, param: &Param, value: &str) -> Error {
    let expected = format!("in its range ({})", param.kind.range_of(registry));
    Error::Setting { technique: id.into(), name: param.name.into(), value: value.into(), expected }
}

/// Finds values out of range, which a struct can hold although no text can.
fn check(id: &str, params: &[Param], values: &impl Group) -> Result<(), Error> {
    for param in params {
        let value = values.get(param.name);
        if let Some(value) = value.filter(|v| !param.kind.allows(*v)) {
            return Err(out_of_range(&Registry::default(), id, param, &value.to_string()));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
