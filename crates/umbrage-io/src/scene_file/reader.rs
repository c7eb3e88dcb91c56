//! Typed access to TOML that knows where everything stands, so that every error names line and key.

use crate::error::{Error, Place};
use crate::limits::{LARGEST, SMALLEST};
use glam::{DVec2, DVec3, Vec3};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text of a scene file and its name.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl Source<'_> {
    /// An error at a byte range of the text.
    pub fn error(&self, span: Range<usize>, what: impl std::fmt::Display) -> Error {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        Error::new(self.file, what).at(Place::Line(line, Some(column))).remedy("mend this line")
    }
}

/// A table such as `[camera]` or one `[[light]]`.
pub(super) struct Table<'a> {
    source: Source<'a>,
    /// As users know it, for messages: `[[light]]`.
    name: String,
    span: Range<usize>,
    entries: &'a DeTable<'a>,
}

/// A value and the key it stands under.
pub(super) struct Value<'a> {
    source: Source<'a>,
    key: &'a str,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Table<'a> {
    pub fn new(source: Source<'a>, name: &str, span: Range<usize>, entries: &'a DeTable<'a>) -> Self {
        Self { source, name: name.to_owned(), span, entries }
    }

    /// An error about the table as a whole.
    pub fn error(&self, what: impl std::fmt::Display) -> Error {
        self.source.error(self.span.clone(), format!("{}: {what}", self.name))
    }

    /// Allows these keys only.
    pub fn check_keys(&self, known: &[&[&str]]) -> Result<(), Error> {
        let known = known.concat();
        match self.entries.keys().find(|key| !known.contains(&key.get_ref().as_ref())) {
            None => Ok(()),
            Some(key) => {
                let name = key.get_ref().as_ref();
                let error = self.source.error(key.span(), format!("{}: unknown key `{name}`", self.name));
                Err(error.did_you_mean(name, known))
            }
        }
    }

    /// The value of a key that may be absent.
    pub fn get(&self, key: &'a str) -> Option<Value<'a>> {
        self.entries.get(key).map(|value| Value { source: self.source, key, value })
    }

    /// The value of a key that must be there.
    pub fn require(&self, key: &'a str) -> Result<Value<'a>, Error> {
        self.get(key).ok_or_else(|| self.error(format!("the key `{key}` is missing")).remedy("add it"))
    }

    /// What `read` makes of a key, or `default` where it is absent.
    pub fn get_or<T>(
        &self,
        key: &'a str,
        default: T,
        read: impl FnOnce(&Value<'a>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.get(key).map_or(Ok(default), |value| read(&value))
    }
}

impl<'a> Value<'a> {
    /// An error about this value.
    pub fn error(&self, what: impl std::fmt::Display) -> Error {
        self.source.error(self.value.span(), format!("`{}` {what}", self.key))
    }

    fn wrong_type(&self, wanted: &str) -> Error {
        self.error(format!("must be {wanted}, not {}", kind_of(self.value.get_ref())))
    }

    pub fn string(&self) -> Result<&'a str, Error> {
        self.value.get_ref().as_str().ok_or_else(|| self.wrong_type("a text in quotes"))
    }

    pub fn bool(&self) -> Result<bool, Error> {
        self.value.get_ref().as_bool().ok_or_else(|| self.wrong_type("true or false"))
    }

    pub fn table(&self) -> Result<Table<'a>, Error> {
        let entries = self.value.get_ref().as_table().ok_or_else(|| self.wrong_type("a table"))?;
        Ok(Table::new(self.source, self.key, self.value.span(), entries))
    }

    /// The tables of `[[key]]`.
    pub fn tables(&self) -> Result<Vec<Table<'a>>, Error> {
        let wrong = || self.wrong_type("a list of tables").remedy(format!("write [[{}]]", self.key));
        let name = format!("[[{}]]", self.key);
        let elements = self.value.get_ref().as_array().ok_or_else(wrong)?;
        elements
            .iter()
            .map(|e| Ok(Table::new(self.source, &name, e.span(), e.get_ref().as_table().ok_or_else(wrong)?)))
            .collect()
    }

    pub fn is_list(&self) -> bool {
        self.value.get_ref().is_array()
    }

    /// A finite number; whole numbers are fine.
    pub fn number(&self) -> Result<f64, Error> {
        self.number_in(self.value, "a number")
    }

    fn number_in(&self, value: &Spanned<DeValue<'_>>, wanted: &str) -> Result<f64, Error> {
        let number = match value.get_ref() {
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok().map(|i| i as f64),
            DeValue::Float(f) => f.as_str().parse().ok(),
            other => return Err(self.error(format!("must be {wanted}, not {}", kind_of(other)))),
        };
        number.filter(|n: &f64| n.abs() <= LARGEST).ok_or_else(|| {
            let what = format!("`{}` must be finite and at most {LARGEST:e}", self.key);
            self.source.error(value.span(), what)
        })
    }

    /// A list of `N` finite numbers.
    pub fn numbers<const N: usize>(&self) -> Result<[f64; N], Error> {
        let wanted = format!("a list of {N} numbers");
        let elements = self.value.get_ref().as_array().ok_or_else(|| self.wrong_type(&wanted))?;
        if elements.len() != N {
            return Err(self.error(format!("must be {wanted}, not of {}", elements.len())));
        }
        let mut numbers = [0.0; N];
        for (number, element) in numbers.iter_mut().zip(elements.iter()) {
            *number = self.number_in(element, &wanted)?;
        }
        Ok(numbers)
    }

    pub fn vec3(&self) -> Result<DVec3, Error> {
        self.numbers().map(DVec3::from)
    }

    /// A number over 0.
    pub fn positive(&self) -> Result<f64, Error> {
        let n = self.number()?;
        if is_positive(n) { Ok(n) } else { Err(self.not_positive(format!("{n:e}"))) }
    }

    fn not_positive(&self, found: impl std::fmt::Display) -> Error {
        self.error(format!("must be over 0, not {found}")).remedy(format!("the least is {SMALLEST:e}"))
    }

    /// A number of 0 and up.
    pub fn not_negative(&self) -> Result<f64, Error> {
        let n = self.number()?;
        if n >= 0.0 { Ok(n) } else { Err(self.error(format!("must not be negative, and is {n}"))) }
    }

    /// Lengths over 0.
    pub fn positive2(&self) -> Result<DVec2, Error> {
        let v = DVec2::from(self.numbers::<2>()?);
        if is_positive(v.min_element()) { Ok(v) } else { Err(self.not_positive(v)) }
    }

    /// Lengths over 0.
    pub fn positive3(&self) -> Result<DVec3, Error> {
        let v = self.vec3()?;
        if is_positive(v.min_element()) { Ok(v) } else { Err(self.not_positive(v)) }
    }

    /// A linear colour, or other numbers of 0 and up.
    pub fn color(&self) -> Result<Vec3, Error> {
        let v = self.vec3()?;
        if v.min_element() >= 0.0 { Ok(v.as_vec3()) } else { Err(self.error(format!("must not be negative: {v}"))) }
    }

    /// A direction, made to unit length; one that has it stays as it is.
    pub fn direction(&self) -> Result<DVec3, Error> {
        let v = self.vec3()?;
        let unit = if is_unit(v) { Some(v) } else { v.try_normalize() };
        unit.ok_or_else(|| self.error("has no length: it is no direction").remedy("give it one"))
    }

    /// Two whole numbers, each in its range.
    pub fn counts(&self, ranges: [Range<u32>; 2]) -> Result<[u32; 2], Error> {
        let numbers = self.numbers::<2>()?;
        let mut counts = [0; 2];
        for ((count, number), range) in counts.iter_mut().zip(numbers).zip(&ranges) {
            *count = number as u32;
            if f64::from(*count) != number || !range.contains(count) {
                let [a, b] = &ranges;
                let allowed = format!("{} to {}, and {} to {}", a.start, a.end - 1, b.start, b.end - 1);
                return Err(self.error(format!("must be two whole numbers, {allowed}; one is {number}")));
            }
        }
        Ok(counts)
    }
}

/// True for numbers that stay over 0 as `f32`, and whose squares do.
pub(super) fn is_positive(number: f64) -> bool {
    number >= SMALLEST
}

/// What a value is, for messages.
fn kind_of(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// Of unit length, but for rounding.
pub(super) fn is_unit(v: DVec3) -> bool {
    (v.length_squared() - 1.0).abs() < 1e-15
}
