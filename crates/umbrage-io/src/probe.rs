//! Light as spherical harmonics in the words of other software. `docs/harmonics.md` has their
//! scaling and signs, with sources.

use crate::error::{self, Error};
use crate::pictures::save_bytes;
use glam::DVec3;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path;
use std::str::FromStr;
use umbrage_core::harmonics::{Light, Order, clamped_cosine};

/// How coefficients of light are written: nine colours, order 3. Those of higher orders are left
/// out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Probe {
    /// The text of Filament's `cmgen --sh-irradiance --sh-shader`, which `cmgen --deploy` writes as
    /// `sh.txt`: irradiance over π, multiplied into the polynomials.
    Filament,
    /// JSON for `LightProbe.fromJSON` of three.js: 27 numbers, radiance.
    Three,
    /// JSON for `SphericalHarmonics.FromArray` of Babylon.js: nine triples, radiance, functions
    /// with the Condon–Shortley phase.
    Babylon,
}

impl FromStr for Probe {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "filament" => Ok(Self::Filament),
            "three" => Ok(Self::Three),
            "babylon" => Ok(Self::Babylon),
            _ => Err("write filament, three or babylon".into()),
        }
    }
}

/// Names of the functions, as `cmgen` writes them.
const NAMES: [&str; 9] = ["L00", "L1-1", "L10", "L11", "L2-2", "L2-1", "L20", "L21", "L22"];

impl Probe {
    /// The text for a light.
    pub fn text(self, light: &Light) -> String {
        let light = light.with_order(three());
        let numbered = || light.coefficients().iter().zip(0..);
        match self {
            Self::Filament => numbered()
                .zip(NAMES)
                .map(|((color, i), name)| {
                    let DVec3 { x, y, z } = *color * irradiance(i) * factor(i);
                    format!("({x:18.15}, {y:18.15}, {z:18.15}); // {name}, irradiance, pre-scaled base\n")
                })
                .collect(),
            Self::Three => {
                let numbers: Vec<f64> = numbered().flat_map(|(color, _)| color.to_array()).collect();
                format!("{}\n", json!({ "type": "LightProbe", "intensity": 1.0, "sh": numbers }))
            }
            Self::Babylon => {
                let triples: Vec<[f64; 3]> = numbered().map(|(color, i)| (*color * phase(i)).to_array()).collect();
                format!("{}\n", json!(triples))
            }
        }
    }

    /// Writes a light.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn save(self, light: &Light, path: &Path) -> Result<(), Error> {
        save_bytes(path, self.text(light).as_bytes())
    }
}

/// Reads a light from any of these texts, and from those that `cmgen` writes without `--sh-shader`:
/// irradiance of three bands, radiance of as many as there are.
///
/// # Errors
/// A file that can't be read or is none of these; numbers that are not finite.
pub fn open_probe(path: &Path) -> Result<Light, Error> {
    let text = String::from_utf8(error::read(path)?).map_err(|_| Error::new(path, "is no text"))?;
    read_probe(&text).map_err(|what| {
        Error::new(path, what)
            .remedy("write coefficients as cmgen, three.js or Babylon.js do; docs/harmonics.md has them")
    })
}

/// The same from text.
///
/// # Errors
/// What is wrong with it.
pub fn read_probe(text: &str) -> Result<Light, String> {
    let coefficients = if text.trim_start().starts_with(['{', '[']) { json_probe(text) } else { cmgen(text) }?;
    if !coefficients.iter().all(|color| color.is_finite()) {
        return Err("has coefficients that are no finite numbers".into());
    }
    let count = coefficients.len();
    Light::new(coefficients).ok_or_else(|| format!("has {count} coefficients, and an order n from 1 to 10 has n²"))
}

fn json_probe(text: &str) -> Result<Vec<DVec3>, String> {
    let value: Value = serde_json::from_str(text).map_err(|e| format!("is no JSON: {e}"))?;
    let object = value.get("object").unwrap_or(&value);
    if let Some(numbers) = object.get("sh") {
        let intensity = object.get("intensity").map_or(Some(1.0), Value::as_f64).ok_or("`intensity` is no number")?;
        return Ok(colors(&numbers_of(numbers)?).map(|color| color * intensity).collect());
    }
    let numbers = numbers_of(&value)?;
    // Nine triples are Babylon's, a flat list is that of three.js.
    let is_babylon = value.get(0).is_some_and(Value::is_array);
    Ok(colors(&numbers).zip(0..).map(|(color, i)| if is_babylon { color * phase(i) } else { color }).collect())
}

/// All numbers of a list, or of a list of triples.
fn numbers_of(value: &Value) -> Result<Vec<f64>, String> {
    let list = value.as_array().ok_or("has no list `sh` of coefficients")?;
    let mut numbers = Vec::new();
    for entry in list {
        match entry.as_array() {
            Some(triple) if triple.len() == 3 => numbers.extend(triple.iter().map(Value::as_f64)),
            Some(triple) => return Err(format!("has a coefficient of {} numbers instead of 3", triple.len())),
            None => numbers.push(entry.as_f64()),
        }
    }
    let numbers: Option<Vec<f64>> = numbers.into_iter().collect();
    let numbers = numbers.ok_or("has coefficients that are no numbers")?;
    if numbers.len() % 3 == 0 {
        Ok(numbers)
    } else {
        Err(format!("has {} numbers, not three a coefficient", numbers.len()))
    }
}

fn colors(numbers: &[f64]) -> impl Iterator<Item = DVec3> {
    numbers.as_chunks::<3>().0.iter().map(|color| DVec3::from_array(*color))
}

/// Lines `(r, g, b); // L00, irradiance, pre-scaled base`.
fn cmgen(text: &str) -> Result<Vec<DVec3>, String> {
    let mut coefficients = Vec::new();
    for (line, number) in text.lines().zip(1..).filter(|(line, _)| line.contains('(')) {
        let inner = line.split_once('(').and_then(|(_, rest)| rest.split_once(')')).map(|(inner, _)| inner);
        let numbers: Vec<f64> = inner.unwrap_or_default().split(',').filter_map(|n| n.trim().parse().ok()).collect();
        let [r, g, b] = numbers[..] else { return Err(format!("has no three numbers in brackets in line {number}")) };
        let i = coefficients.len();
        let scale = match (line.contains("irradiance"), line.contains("pre-scaled")) {
            (true, _) if i >= 9 => {
                return Err("has irradiance of more than three bands, which says nothing of light".into());
            }
            (true, true) => irradiance(i) * factor(i),
            (true, false) => irradiance(i) * phase(i),
            (false, true) => return Err(format!("is scaled in line {number} for something that is no irradiance")),
            (false, false) => phase(i),
        };
        coefficients.push(DVec3::new(r, g, b) / scale);
    }
    if coefficients.is_empty() { Err("has no coefficients".into()) } else { Ok(coefficients) }
}

/// Degree and m of a function.
fn degree(i: usize) -> (usize, isize) {
    let l = i.isqrt();
    (l, i as isize - (l * (l + 1)) as isize)
}

/// −1 where the Condon–Shortley phase turns a function round.
fn phase(i: usize) -> f64 {
    if degree(i).1 % 2 == 0 { 1.0 } else { -1.0 }
}

/// A_l / π: what makes radiance what a white diffuse surface sends out.
fn irradiance(i: usize) -> f64 {
    clamped_cosine(degree(i).0) / PI
}

/// What the first nine functions multiply their polynomials 1, y, z, x, xy, yz, 3z² − 1, xz and
/// x² − y² with.
fn factor(i: usize) -> f64 {
    let square: f64 = match i {
        0 => 1.0 / 4.0,
        1..=3 => 3.0 / 4.0,
        6 => 5.0 / 16.0,
        8 => 15.0 / 16.0,
        _ => 15.0 / 4.0,
    };
    (square / PI).sqrt()
}

fn three() -> Order {
    Order::of_functions(9).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use umbrage_core::harmonics::{project, unshadowed};

    /// Another colour from each side, none even in any axis.
    fn light() -> Light {
        let lobe = |s: DVec3, axis: DVec3| (2.0 * (s.dot(axis.normalize()) - 1.0)).exp();
        project(three(), 30, |s| {
            let (r, g) = (lobe(s, DVec3::new(1.0, 0.3, 0.2)), lobe(s, DVec3::new(-0.2, 1.0, 0.5)));
            DVec3::new(r, g, 0.3 + lobe(s, DVec3::new(0.1, -0.4, 1.0))).as_vec3()
        })
    }

    fn off(a: &Light, b: &Light) -> f64 {
        assert_eq!(a.order(), b.order());
        a.coefficients().iter().zip(b.coefficients()).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max)
    }

    #[test]
    fn what_is_written_is_read_again() {
        for probe in [Probe::Filament, Probe::Three, Probe::Babylon] {
            let again = read_probe(&probe.text(&light())).unwrap();
            assert!(off(&again, &light()) < 1e-12, "{probe:?}: {again:?}");
        }
    }

    #[test]
    fn a_cube_of_six_colours_is_what_cmgen_makes_of_it() {
        // Red from −x, +y and +z. In closed form the coefficient of y is ∫∫ (1 + u² + v²)⁻² du dv
        // over [−1, 1]², over 2π. The published numbers are cmgen's own for this cube, of PLATEAU
        // VIEW 3.0; its window against ringing makes the first band weaker.
        let sides = |s: DVec3| {
            let large = s.abs().max_element();
            let is_red = -s.x == large || s.y == large || s.z == large;
            Vec3::new(f32::from(u8::from(is_red)), 0.0, 0.0)
        };
        let text = Probe::Filament.text(&project(three(), 400, sides));
        let red: Vec<f64> = text.lines().map(|l| l[1..19].trim().parse().unwrap()).collect();
        for (i, exact, published) in [(0, 0.5, 0.4997), (1, 0.27706, 0.2658), (3, -0.27706, -0.2669)] {
            assert!((red[i] - exact).abs() < 2e-3, "{i}: {} against {exact}\n{text}", red[i]);
            assert!((published / red[i] - 0.97_f64).abs() < 0.035, "{i}: {} against {published}", red[i]);
        }
        assert!(
            text.starts_with("( ") && text.lines().nth(1).unwrap().ends_with("; // L1-1, irradiance, pre-scaled base")
        );
    }

    #[test]
    fn polynomials_of_the_texts_are_what_a_white_surface_sends_out() {
        // Filament's shader, three.js' getIrradianceAt over π and the functions of Babylon.js, each
        // for a normal.
        let DVec3 { x, y, z } = DVec3::new(0.36, 0.48, -0.8);
        let mut transfer = [0.0; 9];
        unshadowed(three(), DVec3::new(x, y, z), &mut transfer);
        let wanted: DVec3 = light().coefficients().iter().zip(transfer).map(|(l, t)| *l * t).sum();
        let basis = [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y];

        let text = Probe::Filament.text(&light());
        let numbers = |text: &str| -> Vec<f64> {
            text.split(|c: char| !c.is_ascii_digit() && !"+-.e".contains(c)).filter_map(|n| n.parse().ok()).collect()
        };
        let first: Vec<f64> = text.lines().flat_map(|l| numbers(l.split("//").next().unwrap())).collect();
        let filament: DVec3 = colors(&first).zip(basis).map(|(c, b)| c * b).sum();
        assert!((filament - wanted).length() < 1e-9, "{filament} for {wanted}");

        let three = [0.886227, 1.023328, 1.023328, 1.023328, 0.858086, 0.858086, 0.247708, 0.858086, 0.429043];
        let text = Probe::Three.text(&light());
        let list = &text[text.find("\"sh\":").unwrap() + 5..];
        let sum: DVec3 = colors(&numbers(list)).zip(basis).zip(three).map(|((c, b), k)| c * b * k / PI).sum();
        assert!((sum - wanted).length() < 1e-5, "{sum} for {wanted}");

        let signs = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0];
        let text = Probe::Babylon.text(&light());
        let all = numbers(&text);
        let scaled = colors(&all).zip(basis).zip(three).zip(signs).map(|(((c, b), k), s)| c * b * k * s / PI);
        let sum: DVec3 = scaled.sum();
        assert!((sum - wanted).length() < 1e-5, "{sum} for {wanted}");
    }

    #[test]
    fn radiance_of_any_order_and_irradiance_are_read_as_cmgen_has_them() {
        let lines = |scale: &dyn Fn(usize) -> f64, label: &str| -> String {
            let line = |(c, i): (&DVec3, usize)| {
                format!("({}, {}, {}); // L{label}\n", c.x * scale(i), c.y * scale(i), c.z * scale(i))
            };
            light().coefficients().iter().zip(0..).map(line).collect()
        };
        let radiance = read_probe(&lines(&phase, "")).unwrap();
        let irradiance = read_probe(&lines(&|i| phase(i) * irradiance(i), ", irradiance")).unwrap();
        assert!(off(&radiance, &light()) < 1e-12 && off(&irradiance, &light()) < 1e-12);
    }

    #[test]
    fn what_is_no_light_is_named() {
        for (text, word) in [
            ("", "no coefficients"),
            ("(1, 2); // L00", "line 1"),
            ("(1, 2, 3);\n(1, 2, 3);\n", "2 coefficients"),
            ("(1, NaN, 3); // L00", "finite"),
            ("{}", "no list"),
            ("{\"sh\": [1, 2]}", "2 numbers"),
            ("[[1, 2]]", "2 numbers"),
            ("[\"a\"]", "no numbers"),
            ("[1, 2,", "no JSON"),
        ] {
            let error = read_probe(text).unwrap_err();
            assert!(error.contains(word), "{text}: {error}");
        }
    }
}
