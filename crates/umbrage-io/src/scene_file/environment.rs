//! `[environment]`.

use super::reader::{Table, Value};
use crate::error::Error;
use crate::files::Files;
use crate::pictures;
use std::path::Path;
use umbrage_core::environment::{Daylight, Gradient, SkyPicture};
use umbrage_core::glam::Vec3;
use umbrage_core::{Environment, Sky};

/// What the sky can be, one of these.
const SKIES: [&str; 4] = ["path", "color", "gradient", "sun-and-sky"];

/// How a picture lays out the sky; without the key its form tells.
const LAYOUTS: [&str; 2] = ["equirectangular", "cross"];

/// How hazy the air is where a file does not say.
const TURBIDITY: f64 = 3.0;

/// Reflectance of the ground where a file does not say.
const GROUND: Vec3 = Vec3::splat(0.2);

/// The environment of a table; its paths are relative to `dir` among `files`.
pub(super) fn read(files: Files<'_>, dir: &Path, table: &Table<'_>) -> Result<Environment, Error> {
    table.check_keys(&[&SKIES, &["layout", "rotate", "intensity"]])?;
    let given: Vec<(&str, Value<'_>)> = SKIES.into_iter().filter_map(|key| Some((key, table.get(key)?))).collect();
    let [(key, value)] = given.as_slice() else {
        let remedy = format!("give exactly one of: {}", SKIES.join(", "));
        return Err(match given.as_slice() {
            [] => table.error("it does not say what the sky is").remedy(remedy),
            [_, (second, _), ..] | [(second, _)] => {
                let value = table.require(second)?;
                value.error(format!("and `{}` are both given", given[0].0)).remedy(remedy)
            }
        });
    };
    if let Some(layout) = table.get("layout").filter(|_| *key != "path") {
        return Err(layout.error("is for pictures").remedy("leave it out, or name a picture with `path`"));
    }
    let sky = match *key {
        "path" => Sky::Picture(read_picture(files, dir, table, value)?),
        "color" => Sky::Constant(value.color()?),
        "gradient" => Sky::Gradient(read_gradient(&value.table()?)?),
        _ => Sky::Daylight(read_daylight(value)?),
    };
    with_turn(table, Environment::new(sky))
}

/// The same sky with what the table says about turn and intensity.
fn with_turn(table: &Table<'_>, environment: Environment) -> Result<Environment, Error> {
    Ok(Environment {
        rotate_deg: table.get_or("rotate", environment.rotate_deg, Value::number)?,
        intensity: table.get_or("intensity", environment.intensity, |v| v.not_negative().map(|i| i as f32))?,
        ..environment
    })
}

/// What a change of the scene makes of its environment: only turn and intensity can be other.
pub(super) fn change(environment: Option<&Environment>, table: &Table<'_>) -> Result<Environment, Error> {
    table.check_keys(&[&["rotate", "intensity"]])?;
    let error = || table.error("the scene has no environment").remedy("add one to the scene file");
    with_turn(table, environment.ok_or_else(error)?.clone())
}

fn read_picture(files: Files<'_>, dir: &Path, table: &Table<'_>, path: &Value<'_>) -> Result<SkyPicture, Error> {
    let file = dir.join(path.string()?);
    let names = |e: &Error| path.error("names").passing_on(e);
    let image = files.read(&file).and_then(|bytes| pictures::rgb_from_bytes(&file, &bytes)).map_err(|e| names(&e))?;
    let layout = table.get("layout");
    let layout = match &layout {
        Some(value) => {
            let name = value.string()?;
            if !LAYOUTS.contains(&name) {
                return Err(value.error(format!("`{name}` is unknown")).did_you_mean(name, LAYOUTS));
            }
            name
        }
        None if pictures::side_of_cross(image.size()).is_some() => "cross",
        None => "equirectangular",
    };
    let size = image.size();
    let image = if layout == "cross" {
        let error = || {
            let what = format!("is {} × {} pixels large, no cross of a cube's faces", size.0, size.1);
            names(&Error::new(&file, what).remedy("a cross is four faces by three, or three by four"))
        };
        pictures::equirectangular_of_cross(&image).ok_or_else(error)?
    } else {
        image
    };
    SkyPicture::new(image).map_err(|what| names(&Error::new(&file, what)))
}

fn read_gradient(table: &Table<'_>) -> Result<Gradient, Error> {
    table.check_keys(&[&["zenith", "horizon", "nadir"]])?;
    let color = |key| table.require(key)?.color();
    Ok(Gradient { zenith: color("zenith")?, horizon: color("horizon")?, nadir: color("nadir")? })
}

fn read_daylight(value: &Value<'_>) -> Result<Daylight, Error> {
    let table = value.table()?;
    table.check_keys(&[&["sun", "turbidity", "ground", "angle"]])?;
    let sun = table.require("sun")?.direction()?;
    let turbidity = table.get_or("turbidity", TURBIDITY, Value::number)?;
    let ground = table.get_or("ground", GROUND, Value::color)?;
    let angle = table.get_or("angle", Daylight::SUN_ANGLE_DEG, Value::number)?;
    Daylight::new(sun, turbidity, ground, angle).map_err(|what| value.error(what))
}
