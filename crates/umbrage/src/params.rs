//! Parameters of techniques, declared once: the command line, the window and the README table come from here.

use crate::error::{Error, nearest};
use std::fmt;

/// One parameter of a technique.
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
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int(v) => write!(f, "{v}"),
            Self::Float(v) => write!(f, "{v}"),
            Self::Choice(v) => write!(f, "{v}"),
            Self::Switch(v) => write!(f, "{}", if *v { "on" } else { "off" }),
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
        }
    }

    /// The allowed values in words, such as `1 to 16`.
    pub fn range(&self) -> String {
        match *self {
            Self::Int { min, max, .. } => format!("{min} to {max}"),
            Self::Float { min, max, .. } => format!("{min} to {max}"),
            Self::Choice { values } => values.join(", "),
            Self::Switch { .. } => "on, off".into(),
        }
    }

    fn parse(&self, text: &str) -> Option<Value> {
        match *self {
            Self::Int { min, max, .. } => text.parse().ok().filter(|v| (min..=max).contains(v)).map(Value::Int),
            Self::Float { min, max, .. } => text.parse().ok().filter(|v| (min..=max).contains(v)).map(Value::Float),
            Self::Choice { values } => values.iter().find(|v| **v == text).map(|v| Value::Choice(v)),
            Self::Switch { .. } => match text {
                "on" | "true" | "1" | "yes" => Some(Value::Switch(true)),
                "off" | "false" | "0" | "no" => Some(Value::Switch(false)),
                _ => None,
            },
        }
    }
}

/// Checked values for all parameters of one technique.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    values: Vec<(&'static str, Value)>,
}

impl Settings {
    /// The defaults of `params`, changed by `set` (pairs of name and value).
    ///
    /// # Errors
    /// [`Error::Unknown`] for a name, [`Error::Setting`] for a value.
    pub fn parse(technique: &str, params: &[Param], set: &[(String, String)]) -> Result<Self, Error> {
        let mut values: Vec<_> = params.iter().map(|p| (p.name, p.kind.default())).collect();
        for (name, text) in set {
            let Some(at) = params.iter().position(|p| p.name == name) else {
                let nearest = nearest(name, params.iter().map(|p| p.name));
                return Err(Error::Unknown { what: "parameter", name: format!("{name}` of `{technique}"), nearest });
            };
            let Some(value) = params[at].kind.parse(text) else {
                let expected = format!("in its range ({})", params[at].kind.range());
                let (technique, value) = (technique.to_string(), text.clone());
                return Err(Error::Setting { technique, name: name.clone(), value, expected });
            };
            values[at].1 = value;
        }
        Ok(Self { values })
    }

    /// Values for `params`, from here where one of the same name and kind is set, else their defaults; and all that is set here
    /// besides: for a technique that makes another one.
    pub(crate) fn with_defaults_of(&self, params: &[Param]) -> Self {
        let fits = |p: &Param| self.get(p.name).filter(|v| p.kind.parse(&v.to_string()).as_ref() == Some(v));
        let mut values: Vec<_> = params.iter().map(|p| (p.name, fits(p).unwrap_or_else(|| p.kind.default()))).collect();
        values.extend(self.iter().filter(|(name, _)| !params.iter().any(|p| p.name == *name)));
        Self { values }
    }

    /// All names and values, in the order of declaration.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Value)> + '_ {
        self.values.iter().copied()
    }

    /// Whether there is such a parameter.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    fn get(&self, name: &str) -> Option<Value> {
        self.values.iter().find(|(n, _)| *n == name).map(|(_, v)| *v)
    }

    /// A whole number; 0 where the parameter is not declared as one (a test of the registry rules that out).
    pub fn int(&self, name: &str) -> i64 {
        if let Some(Value::Int(v)) = self.get(name) { v } else { 0 }
    }

    /// A number; 0 where the parameter is not declared as one.
    pub fn float(&self, name: &str) -> f64 {
        if let Some(Value::Float(v)) = self.get(name) { v } else { 0.0 }
    }

    /// A word; empty where the parameter is not declared as one.
    pub fn choice(&self, name: &str) -> &'static str {
        if let Some(Value::Choice(v)) = self.get(name) { v } else { "" }
    }

    /// A switch; off where the parameter is not declared as one.
    pub fn switch(&self, name: &str) -> bool {
        matches!(self.get(name), Some(Value::Switch(true)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMS: &[Param] = &[
        Param { name: "size", help: "", unit: "texels", kind: ParamKind::Int { min: 1, max: 16, default: 4 } },
        Param { name: "faces", help: "", unit: "", kind: ParamKind::Choice { values: &["front", "back"] } },
        Param { name: "bias", help: "", unit: "", kind: ParamKind::Float { min: 0.0, max: 2.0, default: 1.0 } },
    ];

    fn parse(name: &str, value: &str) -> Result<Settings, Error> {
        Settings::parse("t", PARAMS, &[(name.into(), value.into())])
    }

    #[test]
    fn defaults_hold_until_set() {
        let s = parse("faces", "back").unwrap();
        assert_eq!((s.int("size"), s.choice("faces"), s.float("bias")), (4, "back", 1.0));
    }

    #[test]
    fn another_technique_gets_what_fits_it() {
        let others = &[
            Param { name: "size", help: "", unit: "", kind: ParamKind::Int { min: 1, max: 9, default: 2 } },
            Param { name: "faces", help: "", unit: "", kind: ParamKind::Int { min: 1, max: 9, default: 3 } },
            Param { name: "taps", help: "", unit: "", kind: ParamKind::Int { min: 1, max: 9, default: 5 } },
        ];
        let s = parse("size", "8").unwrap().with_defaults_of(others);
        assert_eq!((s.int("size"), s.int("faces"), s.int("taps"), s.float("bias")), (8, 3, 5, 1.0));
    }

    #[test]
    fn wrong_names_and_values_are_named() {
        let text = |r: Result<Settings, Error>| r.unwrap_err().to_string();
        assert!(text(parse("siez", "1")).contains("did you mean `size`"));
        assert!(text(parse("size", "17")).contains("1 to 16"));
        assert!(text(parse("bias", "NaN")).contains("0 to 2"));
        assert!(text(parse("faces", "side")).contains("front, back"));
    }
}
