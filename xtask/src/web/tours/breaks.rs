//! Ways to break a technique: settings at which something that it needs is taken away.

use super::text;
use serde_json::Value;

/// A parameter, the value that breaks, and what is to be seen then. Which of them a technique has,
/// the registry says.
const BREAKS: [(&str, &str, &str); 10] = [
    ("bias", "0", "No bias: what is left of it lets surfaces shadow themselves."),
    ("bias", "20", "Twenty times the bias: light leaks in at contacts."),
    ("size", "64", "A map of 64²: its texels are seen as stairs."),
    ("taps", "1", "A single tap: no edge can be soft."),
    ("kernel", "1", "A kernel of one tap: bands, or a hard edge."),
    ("search", "1", "A search of one tap: penumbras of the wrong width."),
    ("samples", "32", "Few samples of the light: the penumbra falls into steps."),
    ("bleeding", "0", "Nothing is taken off the bound: light bleeds through."),
    ("omni", "dual-paraboloid", "Two paraboloids: long edges of coarse triangles bend."),
    ("planes", "1", "One plane only: the other receivers get no shadow."),
];

/// A setting that breaks, and what is seen then.
pub struct Break {
    pub setting: String,
    pub text: &'static str,
}

/// Those that a technique has.
pub fn of(technique: &Value) -> Vec<Break> {
    let params = technique["params"].as_array().cloned().unwrap_or_default();
    let allows = |name: &str, value: &str| {
        params.iter().any(|p| p["name"] == name && p["default"] != value && is_within(text(p, "range"), value))
    };
    let known = BREAKS.iter().filter(|(name, value, _)| allows(name, value));
    known.map(|(name, value, text)| Break { setting: format!("{name}={value}"), text }).collect()
}

/// True where a range, `0 to 100` or `front, back`, has the value.
fn is_within(range: &str, value: &str) -> bool {
    match range.split_once(" to ") {
        None => range.split(", ").any(|one| one == value),
        Some((low, high)) => match (low.parse::<f64>(), high.parse::<f64>(), value.parse::<f64>()) {
            (Ok(low), Ok(high), Ok(value)) => (low..=high).contains(&value),
            _ => false,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_technique_breaks_by_what_it_has_alone() {
        let param =
            |name: &str, range: &str, default: &str| json!({ "name": name, "range": range, "default": default });
        let params = [param("bias", "0 to 10", "1"), param("kernel", "3, 2x2", "3"), param("taps", "1 to 8", "1")];
        let found: Vec<String> = of(&json!({ "params": params })).into_iter().map(|b| b.setting).collect();
        assert_eq!(found, ["bias=0"]);
        assert!(of(&json!({})).is_empty());
    }
}
