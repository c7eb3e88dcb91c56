//! Numbers as files show them: six significant digits, and never NaN.

use serde::Serializer;

/// `value` with six significant digits; what is not finite stays as it is.
pub(crate) fn rounded(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    // Decimal printing rounds exactly where multiplying by a power of ten would not.
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Writes six significant digits, or null for what is not finite.
pub(crate) fn six<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if value.is_finite() { serializer.serialize_f64(rounded(*value)) } else { serializer.serialize_none() }
}

/// The same for a number that may be absent.
pub(crate) fn maybe_six<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Some(v) => six(v, serializer),
        None => serializer.serialize_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_remain() {
        assert_eq!(rounded(1.0 / 3.0), 0.333333);
        assert_eq!(rounded(-123456.789), -123457.0);
        assert_eq!(rounded(1.234567e-9), 1.23457e-9);
        assert_eq!(rounded(0.0), 0.0);
    }

    #[test]
    fn nan_is_null() {
        #[derive(serde::Serialize)]
        struct Row(#[serde(serialize_with = "six")] f64);
        let text = |v| serde_json::to_string(&Row(v)).unwrap();
        assert_eq!((text(f64::NAN), text(f64::INFINITY), text(0.25)), ("null".into(), "null".into(), "0.25".into()));
    }
}
