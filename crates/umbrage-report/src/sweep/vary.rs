//! Sweeps as users write them: `pcf:kernel=3|5|7,size=512|1024`, and ranges:
//! `cascaded:lambda=0..1`.

use crate::{error::Error, round::rounded};

/// Most settings that one sweep may have.
const MOST: usize = 1000;

/// Values of a range that does not say how many.
const USUAL: usize = 5;

/// Values to try for some parameters of one technique: all combinations of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Vary {
    /// Id of the technique.
    pub technique: String,
    /// Names and values. Of the parameters with several values, the last is the one that curves run
    /// along.
    params: Vec<(String, Vec<String>)>,
}

impl Vary {
    /// Reads `id:name=value|value,name=value|value`. In place of a value may be a range,
    /// `from..to/count`: so many numbers in equal steps, 5 where no count is given. Names and
    /// values are looked up later, by [`crate::Choice`].
    ///
    /// # Errors
    /// What is not of this form; a parameter that comes twice; more than 1000 combinations.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let form = || Error::Name(format!("`{text}` is no sweep; write technique:name=value|value,name=value|value"));
        let (technique, rest) = text.split_once(':').ok_or_else(form)?;
        let mut params: Vec<(String, Vec<String>)> = Vec::new();
        for part in rest.split(',') {
            let (name, values) = part.split_once('=').ok_or_else(form)?;
            let name = name.trim();
            if params.iter().any(|(other, _)| other == name) {
                return Err(Error::Name(format!("`{name}` comes twice in `{text}`; put all its values together")));
            }
            let values = values.split('|').map(|value| range(value.trim())).collect::<Result<Vec<_>, _>>()?;
            params.push((name.into(), values.into_iter().flatten().collect()));
        }
        let count = params.iter().fold(1usize, |count, (_, values)| count.saturating_mul(values.len()));
        if count > MOST {
            return Err(Error::Name(format!("`{text}` makes {count} settings, more than {MOST}: leave values out")));
        }
        params.sort_by_key(|(_, values)| values.len() > 1);
        Ok(Self { technique: technique.trim().into(), params })
    }

    /// All combinations, the last parameter changing fastest.
    pub(crate) fn combinations(&self) -> Vec<Vec<(String, String)>> {
        let mut all = vec![Vec::new()];
        for (name, values) in &self.params {
            let with = |one: &Vec<(String, String)>, value: &String| {
                one.iter().cloned().chain([(name.clone(), value.clone())]).collect()
            };
            all = all.iter().flat_map(|one| values.iter().map(move |value| with(one, value))).collect();
        }
        all
    }

    /// The parameter that curves run along, and how many values it has.
    pub(crate) fn along(&self) -> Option<(&str, usize)> {
        self.params.last().map(|(name, values)| (name.as_str(), values.len()))
    }
}

/// The values of `from..to/count`; anything else is a value itself.
fn range(text: &str) -> Result<Vec<String>, Error> {
    let Some((from, rest)) = text.split_once("..") else { return Ok(vec![text.into()]) };
    let (to, count) = rest.split_once('/').map_or((rest, None), |(to, count)| (to, Some(count)));
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let count = count.map_or(Some(USUAL), |count| count.trim().parse().ok().filter(|n| (2..=MOST).contains(n)));
    let (Some(from), Some(to), Some(count)) = (number(from), number(to), count) else {
        let text =
            format!("`{text}` is no range; write from..to or from..to/count, such as 0..1/11, with 2 to {MOST} values");
        return Err(Error::Name(text));
    };
    let at = |i: usize| rounded(from + (to - from) * i as f64 / (count - 1) as f64).to_string();
    Ok((0..count).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn combinations(text: &str) -> Vec<String> {
        let words = |one: Vec<(String, String)>| one.iter().map(|(n, v)| format!("{n}={v}")).collect::<Vec<_>>();
        Vary::parse(text).unwrap().combinations().into_iter().map(|one| words(one).join(" ")).collect()
    }

    #[test]
    fn all_combinations_come_with_the_last_parameter_fastest() {
        assert_eq!(
            combinations("pcf: kernel=3|5, size = 512 | 1024"),
            ["kernel=3 size=512", "kernel=3 size=1024", "kernel=5 size=512", "kernel=5 size=1024"]
        );
        assert_eq!(Vary::parse("pcf:kernel=3|5,size=1|2|4").unwrap().along(), Some(("size", 3)));
    }

    #[test]
    fn curves_run_along_a_parameter_that_has_several_values() {
        let vary = Vary::parse("pcf:size=512|1024,kernel=disc").unwrap();
        assert_eq!((vary.technique.as_str(), vary.along()), ("pcf", Some(("size", 2))));
        assert_eq!(combinations("pcf:size=512|1024,kernel=disc"), ["kernel=disc size=512", "kernel=disc size=1024"]);
    }

    #[test]
    fn ranges_are_equal_steps() {
        let values = |text: &str| combinations(text).into_iter().map(|v| v.replace("a=", "")).collect::<Vec<_>>();
        assert_eq!(values("t:a=0..1"), ["0", "0.25", "0.5", "0.75", "1"]);
        assert_eq!(values("t:a=0 .. 1 / 11|2")[3..], ["0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1", "2"]);
        assert_eq!(values("t:a=512..2048/4"), ["512", "1024", "1536", "2048"]);
        assert_eq!(values("t:a=1..-1/3"), ["1", "0", "-1"]);
        for wrong in ["t:a=0..", "t:a=..1", "t:a=0..x", "t:a=0..1/1", "t:a=0..1/x", "t:a=0..inf", "t:a=0..1/9999"] {
            let text = Vary::parse(wrong).map(|v| v.combinations()).unwrap_err().to_string();
            assert!(text.contains("from..to/count"), "{wrong}: {text}");
        }
    }

    #[test]
    fn mistakes_are_named() {
        let text = |text: &str| Vary::parse(text).unwrap_err().to_string();
        for wrong in ["pcf", "pcf:", "pcf:size", "pcf:size=1,kernel", ""] {
            assert!(text(wrong).contains("technique:name=value|value"), "{wrong}");
        }
        assert!(text("pcf:size=1|2,size=3").contains("`size` comes twice"));
        let many = (0..40).map(|v| v.to_string()).collect::<Vec<_>>().join("|");
        assert!(text(&format!("pcf:size={many},taps={many}")).contains("1600 settings, more than 1000"));
    }
}
