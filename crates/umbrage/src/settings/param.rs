//! What the command line, the window and the tables of the READMEs know of a parameter.

use crate::registry::FilterId;
use std::fmt;

/// One parameter of a technique, made by [`settings!`](crate::settings!) from a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Param {
    /// What users type: `--set name=value`.
    pub name: &'static str,
    /// One sentence.
    pub help: &'static str,
    /// Unit for people: `texels`, `m`, or empty.
    pub unit: &'static str,
    /// Type, range and default.
    pub kind: ParamKind,
    /// A technique may take a new value over without being made anew, see
    /// [`Technique::set`](crate::Technique::set).
    pub live: bool,
}

/// Type, range and default of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamKind {
    /// A whole number.
    Int {
        /// Smallest value.
        min: i64,
        /// Largest value.
        max: i64,
        /// Value where none is set.
        default: i64,
    },
    /// A number.
    Float {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
        /// Value where none is set.
        default: f64,
    },
    /// One of several words; the first is the default.
    Choice {
        /// The words.
        values: &'static [&'static str],
    },
    /// `on` or `off`.
    Switch {
        /// Value where none is set.
        default: bool,
    },
    /// The id of a technique that looks up maps which another technique fits, see
    /// [`TechniqueInfo::filter`](crate::TechniqueInfo::filter).
    Filter {
        /// Only techniques that can look up warped maps.
        warped: bool,
        /// Value where none is set.
        default: FilterId,
    },
}

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Of [`ParamKind::Int`].
    Int(i64),
    /// Of [`ParamKind::Float`].
    Float(f64),
    /// Of [`ParamKind::Choice`].
    Choice(&'static str),
    /// Of [`ParamKind::Switch`].
    Switch(bool),
    /// Of [`ParamKind::Filter`].
    Filter(FilterId),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int(v) => write!(f, "{v}"),
            Self::Float(v) => write!(f, "{v}"),
            Self::Choice(v) => write!(f, "{v}"),
            Self::Switch(v) => write!(f, "{}", if *v { "on" } else { "off" }),
            Self::Filter(v) => write!(f, "{}", v.info().id),
        }
    }
}

impl ParamKind {
    /// The value where none is set.
    pub fn default(&self) -> Value {
        match *self {
            Self::Int { default, .. } => Value::Int(default),
            Self::Float { default, .. } => Value::Float(default),
            Self::Choice { values } => Value::Choice(values.first().copied().unwrap_or_default()),
            Self::Switch { default } => Value::Switch(default),
            Self::Filter { default, .. } => Value::Filter(default),
        }
    }

    /// The allowed values in words, such as `1 to 16`; of filters those that are built in.
    pub fn range(&self) -> String {
        self.range_of(&crate::Registry::default())
    }

    /// The allowed values in words, filters being those of `registry`.
    pub fn range_of(&self, registry: &crate::Registry) -> String {
        match *self {
            Self::Int { min, max, .. } => format!("{min} to {max}"),
            Self::Float { min, max, .. } => format!("{min} to {max}"),
            Self::Choice { .. } | Self::Filter { .. } => self.words(registry).join(", "),
            Self::Switch { .. } => "on, off".into(),
        }
    }

    /// The words of a choice or the ids of filters, the default first; empty for numbers and
    /// switches.
    pub fn words(&self, registry: &crate::Registry) -> Vec<&'static str> {
        match *self {
            Self::Choice { values } => values.to_vec(),
            Self::Filter { warped, default } => {
                let others = registry.filters(warped).filter(|info| info.id != default.info().id);
                std::iter::once(default.info()).chain(others).map(|info| info.id).collect()
            }
            Self::Int { .. } | Self::Float { .. } | Self::Switch { .. } => Vec::new(),
        }
    }

    /// Whether `value` is of this kind and in its range.
    pub fn allows(&self, value: Value) -> bool {
        match (*self, value) {
            (Self::Int { min, max, .. }, Value::Int(v)) => (min..=max).contains(&v),
            (Self::Float { min, max, .. }, Value::Float(v)) => (min..=max).contains(&v),
            (Self::Choice { values }, Value::Choice(v)) => values.contains(&v),
            (Self::Switch { .. }, Value::Switch(_)) => true,
            (Self::Filter { warped, .. }, Value::Filter(v)) => v.info().filter.is_some_and(|f| f.warped || !warped),
            _ => false,
        }
    }

    /// The value that `text` spells, where it is allowed.
    pub(super) fn parse(&self, text: &str, registry: &crate::Registry) -> Option<Value> {
        let value = match *self {
            Self::Int { .. } => Value::Int(text.parse().ok()?),
            Self::Float { .. } => Value::Float(text.parse().ok()?),
            Self::Choice { values } => Value::Choice(values.iter().find(|v| **v == text)?),
            Self::Switch { .. } => match text {
                "on" | "true" | "1" | "yes" => Value::Switch(true),
                "off" | "false" | "0" | "no" => Value::Switch(false),
                _ => return None,
            },
            Self::Filter { .. } => Value::Filter(FilterId::of(registry.find(text).ok()?)?),
        };
        self.allows(value).then_some(value)
    }
}
