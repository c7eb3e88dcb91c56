//! The two macros that declare settings, and the traits that they implement.

use super::{Param, ParamKind, Value};
use std::fmt::Debug;

/// The type of a field in [`settings!`](crate::settings!): numbers, switches, the enums of
/// [`choices!`](crate::choices!) and [`FilterId`](crate::FilterId).
pub trait Setting: Copy + PartialEq + Debug + Send + Sync + 'static {
    /// What users may write for it.
    fn kind(default: Self, range: Option<(Self, Self)>) -> ParamKind;

    /// As a [`Value`] of that kind.
    fn value(self) -> Value;

    /// From a [`Value`] of that kind; `None` for values of others.
    fn from_value(value: Value) -> Option<Self>;
}

/// Settings by name: what [`settings!`](crate::settings!) makes of a struct.
pub trait Group {
    /// Every parameter, those of flattened groups among them.
    fn params() -> &'static [Param]
    where
        Self: Sized;

    /// The value of a parameter; `None` where there is none of that name.
    fn get(&self, name: &str) -> Option<Value>;

    /// Changes a parameter; false where there is none of that name, or it is of another kind.
    fn put(&mut self, name: &str, value: Value) -> bool;
}

impl Setting for u32 {
    fn kind(default: Self, range: Option<(Self, Self)>) -> ParamKind {
        let (min, max) = range.unwrap_or((0, Self::MAX));
        ParamKind::Int { min: min.into(), max: max.into(), default: default.into() }
    }

    fn value(self) -> Value {
        Value::Int(self.into())
    }

    fn from_value(value: Value) -> Option<Self> {
        if let Value::Int(v) = value { v.try_into().ok() } else { None }
    }
}

impl Setting for f64 {
    fn kind(default: Self, range: Option<(Self, Self)>) -> ParamKind {
        let (min, max) = range.unwrap_or((Self::MIN, Self::MAX));
        ParamKind::Float { min, max, default }
    }

    fn value(self) -> Value {
        Value::Float(self)
    }

    fn from_value(value: Value) -> Option<Self> {
        if let Value::Float(v) = value { Some(v) } else { None }
    }
}

impl Setting for bool {
    fn kind(default: Self, _: Option<(Self, Self)>) -> ParamKind {
        ParamKind::Switch { default }
    }

    fn value(self) -> Value {
        Value::Switch(self)
    }

    fn from_value(value: Value) -> Option<Self> {
        if let Value::Switch(v) = value { Some(v) } else { None }
    }
}

/// A choice between `words`, the default first. Called once a parameter, which lives as long as the
/// program.
#[doc(hidden)]
pub fn choice(default: &'static str, words: &[&'static str]) -> ParamKind {
    let others = words.iter().copied().filter(|word| *word != default);
    ParamKind::Choice { values: std::iter::once(default).chain(others).collect::<Vec<_>>().leak() }
}

/// The name of a field as users write it: `radius_m` is `radius-m`.
#[doc(hidden)]
pub fn named(field: &str, name: &str) -> bool {
    let as_written = field.bytes().map(|b| if b == b'_' { b'-' } else { b });
    field.len() == name.len() && as_written.eq(name.bytes())
}

/// A parameter from the parts of its declaration. Called once a parameter, which lives as long as
/// the program.
#[doc(hidden)]
pub fn param(field: &str, help: &[&str], unit: &'static str, kind: ParamKind, live: bool) -> Param {
    let lines: Vec<&str> = help.iter().map(|line| line.trim()).collect();
    Param { name: field.replace('_', "-").leak(), help: lines.join(" ").leak(), unit, kind, live }
}

/// Parameters in the order of their weight: what the first group declares first (a map's size),
/// what the technique declares itself, then what it shares with others.
#[doc(hidden)]
pub fn ordered(own: Vec<Param>, groups: &[&[Param]]) -> Vec<Param> {
    let shared: Vec<Param> = groups.concat();
    let (first, rest) = shared.split_at(shared.len().min(1));
    [first, &own, rest].concat()
}

/// Declares settings once: struct, defaults, ranges, units, help, reading and writing by name.
///
/// The doc comment of a field is its help. `#[flatten]` fields come first and are groups declared
/// elsewhere. `live` says that a technique may take a new value over without being made anew.
///
/// ```
/// umbrage::settings! {
///     /// Settings of a lamp.
///     pub struct Lamp {
///         /// How bright it is.
///         power: f64 = 40.0, in 0.0..=100.0, unit "W", live true,
///         /// Whether it is on.
///         on: bool = true,
///     }
/// }
/// use umbrage::Group;
/// assert_eq!(Lamp::params()[0].kind.range(), "0 to 100");
/// assert_eq!(Lamp::default().power, 40.0);
/// ```
#[macro_export]
macro_rules! settings {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident {
            $(#[flatten] $group:ident : $group_type:ty,)*
            $(
                $(#[doc = $help:literal])+
                $field:ident : $type:ty = $default:expr
                    $(, in $min:literal ..= $max:literal)? $(, unit $unit:literal)? $(, live $live:literal)?
            ),* $(,)?
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        $vis struct $name {
            $(
                #[doc = concat!("Shared settings: `", stringify!($group_type), "`.")]
                pub $group: $group_type,
            )*
            $($(#[doc = $help])+ pub $field: $type,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($group: Default::default(),)* $($field: $default,)* }
            }
        }

        impl $crate::Group for $name {
            fn params() -> &'static [$crate::Param] {
                static PARAMS: std::sync::LazyLock<Vec<$crate::Param>> = std::sync::LazyLock::new(|| {
                    let own = vec![$({
                        let range: Option<($type, $type)> = None $(.or(Some(($min, $max))))?;
                        let kind = <$type as $crate::Setting>::kind($default, range);
                        let live: &[bool] = &[$($live)?];
                        let unit = concat!("" $(, $unit)?);
                        $crate::declare::param(stringify!($field), &[$($help),+], unit, kind, live.contains(&true))
                    }),*];
                    $crate::declare::ordered(own, &[$(<$group_type as $crate::Group>::params()),*])
                });
                &PARAMS
            }

            fn get(&self, name: &str) -> Option<$crate::Value> {
                let _ = name;
                $(if $crate::declare::named(stringify!($field), name) {
                    return Some($crate::Setting::value(self.$field));
                })*
                $(if let Some(value) = $crate::Group::get(&self.$group, name) {
                    return Some(value);
                })*
                None
            }

            fn put(&mut self, name: &str, value: $crate::Value) -> bool {
                // Where there is nothing to set, neither is used.
                let _ = (name, value);
                $(if $crate::declare::named(stringify!($field), name) {
                    let new = $crate::Setting::from_value(value);
                    new.into_iter().for_each(|new| self.$field = new);
                    return new.is_some();
                })*
                $(if $crate::Group::put(&mut self.$group, name, value) {
                    return true;
                })*
                false
            }
        }
    };
}

/// Declares an enum for a field of [`settings!`](crate::settings!), with the word that users write
/// for each variant.
#[macro_export]
macro_rules! choices {
    (
        $(#[$meta:meta])*
        $vis:vis enum $name:ident { $($(#[$variant_meta:meta])* $variant:ident = $word:literal),* $(,)? }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $vis enum $name {
            $($(#[$variant_meta])* $variant,)*
        }

        impl $name {
            const WORDS: &'static [(Self, &'static str)] = &[$((Self::$variant, $word)),*];

            /// What users write for it.
            $vis fn word(self) -> &'static str {
                match self { $(Self::$variant => $word),* }
            }
        }

        impl $crate::Setting for $name {
            fn kind(default: Self, _: Option<(Self, Self)>) -> $crate::ParamKind {
                $crate::declare::choice(default.word(), &[$($word),*])
            }

            fn value(self) -> $crate::Value {
                $crate::Value::Choice(self.word())
            }

            fn from_value(value: $crate::Value) -> Option<Self> {
                let $crate::Value::Choice(word) = value else { return None };
                Self::WORDS.iter().find(|(_, w)| *w == word).map(|(variant, _)| *variant)
            }
        }
    };
}
