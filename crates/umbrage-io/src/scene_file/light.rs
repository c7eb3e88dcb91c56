//! `[[light]]`.

use super::reader::{Table, Value, is_positive};
use crate::files::Files;
use crate::limits::{Budget, MOST_PIXELS_IN_ALL};
use crate::{Error, pictures};
use glam::{DMat3, DVec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use umbrage_core::{Light, LightShape, Scene};

const COMMON: [&str; 6] = ["kind", "color", "intensity", "attenuation", "range", "casts"];

/// Every kind with its own keys.
const KINDS: [(&str, &[&str]); 8] = [
    ("point", &["position"]),
    ("spot", &["position", "direction", "inner_angle", "outer_angle"]),
    ("directional", &["direction", "angle"]),
    ("sphere", &["position", "radius"]),
    ("ellipsoid", &["position", "radii", "rotate"]),
    ("disc", &["position", "direction", "radius"]),
    ("rect", &["position", "direction", "up", "size", "texture"]),
    ("line", &["from", "to"]),
];

/// Reads lights; the textures of rects go into the scene, each once.
pub(super) struct Lights<'a> {
    files: Files<'a>,
    /// What paths are relative to.
    dir: &'a Path,
    /// Index into the scene's textures by file.
    textures: HashMap<PathBuf, usize>,
    pixels: Budget,
}

impl<'a> Lights<'a> {
    /// Paths are relative to `dir` among `files`.
    pub fn new(files: Files<'a>, dir: &'a Path) -> Self {
        Self { files, dir, textures: HashMap::new(), pixels: Budget::new(MOST_PIXELS_IN_ALL) }
    }

    /// The light of a table.
    pub fn read(&mut self, scene: &mut Scene, table: &Table<'_>) -> Result<Light, Error> {
        self.read_with(scene, table, &[])
    }

    /// The same, where the table has these keys, too.
    pub fn read_with(&mut self, scene: &mut Scene, table: &Table<'_>, more: &[&str]) -> Result<Light, Error> {
        read(self, scene, table, more)
    }

    fn texture(&mut self, scene: &mut Scene, path: &Value<'_>) -> Result<usize, Error> {
        let file = self.dir.join(path.string()?);
        if let Some(known) = self.textures.get(&file) {
            return Ok(*known);
        }
        let texture = pictures::load_within(self.files, &file, &mut self.pixels)
            .map_err(|e| path.error("names").passing_on(&e))?;
        scene.textures.push(texture);
        self.textures.insert(file, scene.textures.len() - 1);
        Ok(scene.textures.len() - 1)
    }
}

fn read(lights: &mut Lights<'_>, scene: &mut Scene, table: &Table<'_>, more: &[&str]) -> Result<Light, Error> {
    let kind = table.require("kind")?;
    let name = kind.string()?;
    let Some((_, keys)) = KINDS.iter().find(|(k, _)| *k == name) else {
        return Err(kind.error(format!("`{name}` is unknown")).did_you_mean(name, KINDS.map(|(k, _)| k)));
    };
    table.check_keys(&[&COMMON, keys, more])?;
    let default = Light::new(read_shape(lights, scene, table, name)?);
    Ok(Light {
        color: table.get_or("color", default.color, Value::color)?,
        intensity: table.get_or("intensity", default.intensity, |v| v.not_negative().map(|i| i as f32))?,
        attenuation: table.get_or("attenuation", default.attenuation, |v| {
            let attenuation = v.color()?;
            let falls = is_positive(attenuation.max_element().into());
            let error =
                || v.error("must not be all 0: the light would be infinite").remedy("[1, 0, 0] is no falling off");
            if falls { Ok(attenuation) } else { Err(error()) }
        })?,
        range: table.get("range").map(|v| v.positive()).transpose()?,
        casts: table.get_or("casts", default.casts, Value::bool)?,
        shape: default.shape,
    })
}

fn read_shape(lights: &mut Lights<'_>, scene: &mut Scene, table: &Table<'_>, kind: &str) -> Result<LightShape, Error> {
    let position = || table.require("position")?.vec3();
    let direction = || table.require("direction")?.direction();
    let radius = || table.require("radius")?.not_negative();
    Ok(match kind {
        "point" => LightShape::Point { position: position()? },
        "spot" => {
            let [inner_angle_deg, outer_angle_deg] = read_cone(table)?;
            LightShape::Spot { position: position()?, direction: direction()?, inner_angle_deg, outer_angle_deg }
        }
        "directional" => {
            let angle_deg = table.get_or("angle", 0.0, |v| {
                let angle = v.not_negative()?;
                if angle < 180.0 { Ok(angle) } else { Err(v.error(format!("must be below 180, not {angle}"))) }
            })?;
            LightShape::Directional { direction: direction()?, angle_deg }
        }
        "sphere" => LightShape::Sphere { position: position()?, radius: radius()? },
        "ellipsoid" => LightShape::Ellipsoid {
            position: position()?,
            radii: table.require("radii")?.positive3()?,
            rotation: rotation(table.get_or("rotate", DVec3::ZERO, Value::vec3)?),
        },
        "disc" => LightShape::Disc { position: position()?, direction: direction()?, radius: radius()? },
        "rect" => {
            let direction = direction()?;
            let up = table.require("up")?;
            let Some(up) = across(up.direction()?, direction) else {
                return Err(up.error("lies along `direction`").remedy("give another one"));
            };
            let texture = table.get("texture").map(|v| lights.texture(scene, &v)).transpose()?;
            let size = table.require("size")?.positive2()?;
            LightShape::Rect { position: position()?, direction, up, size, texture }
        }
        _ => {
            let (from, to) = (table.require("from")?.vec3()?, table.require("to")?);
            if to.vec3()? == from {
                return Err(to.error("is where `from` is").remedy("a light without length is a `point`"));
            }
            LightShape::Line { from, to: to.vec3()? }
        }
    })
}

/// `up` made perpendicular to `direction`, both of unit length; one that is so stays as it is.
fn across(up: DVec3, direction: DVec3) -> Option<DVec3> {
    if up.dot(direction).abs() < 1e-15 { Some(up) } else { up.reject_from_normalized(direction).try_normalize() }
}

/// Inner and outer half angle of a spot, degrees.
fn read_cone(table: &Table<'_>) -> Result<[f64; 2], Error> {
    let (inner, outer) = (table.require("inner_angle")?, table.require("outer_angle")?);
    let (inner_deg, outer_deg) = (inner.not_negative()?, outer.positive()?);
    if outer_deg >= 90.0 {
        return Err(outer.error(format!("is half the cone and must be below 90, not {outer_deg}")));
    }
    if inner_deg > outer_deg {
        return Err(inner.error(format!("is {inner_deg}, larger than `outer_angle`, {outer_deg}")));
    }
    Ok([inner_deg, outer_deg])
}

/// Rz · Ry · Rx of angles in degrees.
pub(super) fn rotation(angles_deg: DVec3) -> DMat3 {
    let a = DVec3::from(angles_deg.to_array().map(f64::to_radians));
    DMat3::from_rotation_z(a.z) * DMat3::from_rotation_y(a.y) * DMat3::from_rotation_x(a.x)
}
