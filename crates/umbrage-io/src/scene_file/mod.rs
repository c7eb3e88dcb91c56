//! Scene files: camera, models and lights in one TOML text.

mod change;
mod environment;
mod light;
mod model;
mod reader;

pub use change::{change, changes};

use crate::files::Files;
use crate::{Error, Opened, defaults, finish, title};
use light::Lights;
use model::Models;
use reader::{Source, Table, Value};
use std::path::Path;
use toml::de::DeTable;
use umbrage_core::{Camera, Scene};

/// Reads the text of a scene file. Paths in it are relative to `dir` among `files`; errors call it
/// `file`.
pub(crate) fn read(files: Files<'_>, text: &str, dir: &Path, file: &Path) -> Result<Opened, Error> {
    let source = Source { file, text };
    let document = DeTable::parse(text).map_err(|e| {
        let end = text.len()..text.len();
        source.error(e.span().unwrap_or(end), format!("is not valid TOML: {}", e.message()))
    })?;
    let root = Table::new(source, "scene", 0..0, document.get_ref());
    root.check_keys(&[&["name", "camera", "ambient", "environment", "model", "light"]])?;

    let mut scene =
        Scene { name: root.get_or("name", title(file), |v| v.string().map(str::to_owned))?, ..Scene::default() };
    if let Some(ambient) = root.get("ambient") {
        let ambient = ambient.table()?;
        ambient.check_keys(&[&["color"]])?;
        scene.ambient = ambient.get_or("color", scene.ambient, Value::color)?;
    }
    if let Some(table) = root.get("environment") {
        scene.environment = Some(environment::read(files, dir, &table.table()?)?);
    }
    let camera = root.get("camera").map(|c| read_camera(&c.table()?)).transpose()?;
    let mut models = Models::new(files, dir);
    if let Some(tables) = root.get("model") {
        for (index, table) in tables.tables()?.iter().enumerate() {
            models.read(&mut scene, index, table)?;
        }
    }
    if let Some(tables) = root.get("light") {
        let mut lights = Lights::new(files, dir);
        for table in tables.tables()? {
            let light = lights.read(&mut scene, &table)?;
            scene.lights.push(light);
        }
    }

    let mut notes = models.into_notes();
    match camera {
        Some(camera) => scene.camera = camera,
        None => defaults::add_camera(&mut scene, &mut notes),
    }
    finish(file, scene, notes)
}

fn read_camera(table: &Table<'_>) -> Result<Camera, Error> {
    table.check_keys(&[&["eye", "target", "up", "fov_y", "height", "near", "far"]])?;
    let (eye, target) = (table.require("eye")?.vec3()?, table.require("target")?);
    let view = target.vec3()? - eye;
    let Some(forward) = view.try_normalize() else {
        return Err(target.error("is where `eye` is: the camera looks nowhere").remedy("move one of them"));
    };
    let default = Camera::default();
    let up = table.get_or("up", default.up, Value::direction)?;
    if forward.cross(up).length() < 1e-6 {
        let what = "`up` lies along the line of sight";
        let error = table.get("up").map_or_else(|| table.error(what), |v| v.error("lies along the line of sight"));
        return Err(error.remedy("give another `up`, such as [0.0, 0.0, -1.0]"));
    }
    let camera = Camera { eye, target: target.vec3()?, up, ..default };
    if let Some(height) = table.get("height") {
        return read_parallel(table, camera, &height);
    }
    if let Some(far) = table.get("far") {
        let error = far.error("is for cameras with parallel lines of sight, which have a `height`");
        return Err(error.remedy("leave it out: the far plane is at infinity"));
    }
    let fov_y = table.require("fov_y")?;
    let fov_y_deg = fov_y.number()?;
    if !(0.0 < fov_y_deg && fov_y_deg < 180.0) {
        return Err(fov_y.error(format!("must be over 0 and below 180 degrees, not {fov_y_deg}")));
    }
    let near = table.get_or("near", camera.near, Value::positive)?;
    Ok(Camera { fov_y_deg, near, ..camera })
}

/// A camera with parallel lines of sight; `near` and `far` may be behind `eye`.
fn read_parallel(table: &Table<'_>, camera: Camera, height: &Value<'_>) -> Result<Camera, Error> {
    if let Some(fov_y) = table.get("fov_y") {
        let error = fov_y.error("and `height` are both given: lines of sight meet in the eye or are parallel");
        return Err(error.remedy("leave one of them out"));
    }
    let near = table.get_or("near", camera.near, Value::number)?;
    let far = table.require("far")?;
    if far.number()? <= near {
        return Err(far.error(format!("must be over `near`, which is {near}")));
    }
    Ok(camera.with_parallel(height.positive()?, near, far.number()?))
}
