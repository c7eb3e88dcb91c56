//! `[[model]]`: a model file or a primitive, placed.

use super::light::rotation;
use super::reader::{Table, Value, is_positive};
use crate::error::{Error, shown};
use crate::files::Files;
use crate::limits::{Budget, MOST_INSTANCES, MOST_TRIANGLES};
use crate::model::{Bases, Model, Placement};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use umbrage_core::rig::Moment;
use umbrage_core::{Instance, Material, Mesh, Scene, primitive};

const COMMON: [&str; 8] = ["path", "primitive", "translate", "rotate", "scale", "casts", "receives", "material"];

/// Keys of model files.
const OF_FILES: [&str; 2] = ["animation", "time"];

/// Every primitive with its own keys.
const PRIMITIVES: [(&str, &[&str]); 6] = [
    ("plane", &["size"]),
    ("box", &["size"]),
    ("sphere", &["radius", "segments"]),
    ("cylinder", &["radius", "height", "segments"]),
    ("cone", &["radius", "height", "segments"]),
    ("torus", &["radii", "segments"]),
];

/// Upper bound of segments: 33 million triangles.
const MOST_SEGMENTS: u32 = 4097;

/// A unit mesh; the bits of the radii of a torus, whose shape does not follow from scaling.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Shape {
    Plane,
    Box,
    Sphere([u32; 2]),
    Cylinder([u32; 2]),
    Cone([u32; 2]),
    Torus([u64; 2], [u32; 2]),
}

/// Reads models one by one, each file, unit mesh and material once.
pub(super) struct Models<'a> {
    place: Files<'a>,
    dir: &'a Path,
    files: HashMap<PathBuf, (Model, Bases)>,
    shapes: HashMap<Shape, usize>,
    /// Materials of the scene by the bits of their numbers.
    materials: HashMap<[u32; 8], usize>,
    notes: Vec<String>,
    triangles: Budget,
}

impl<'a> Models<'a> {
    /// Paths are relative to `dir` among the files of `place`.
    pub fn new(place: Files<'a>, dir: &'a Path) -> Self {
        Self {
            place,
            dir,
            files: HashMap::new(),
            shapes: HashMap::new(),
            materials: HashMap::new(),
            notes: Vec::new(),
            triangles: Budget::new(MOST_TRIANGLES),
        }
    }

    /// What the model files had to note.
    pub fn into_notes(self) -> Vec<String> {
        self.notes
    }

    /// Adds the `index`-th `[[model]]` to the scene.
    pub fn read(&mut self, scene: &mut Scene, index: usize, table: &Table<'_>) -> Result<(), Error> {
        let (path, primitive) = (table.get("path"), table.get("primitive"));
        let own_keys = match &primitive {
            Some(primitive) => primitive_keys(primitive)?,
            None => &OF_FILES[..],
        };
        table.check_keys(&[&COMMON, own_keys])?;
        let mut placement = Placement {
            model: index,
            world_from_model: transform(table)?,
            moment: None,
            casts: table.get_or("casts", true, Value::bool)?,
            receives: table.get_or("receives", true, Value::bool)?,
            material: table
                .get("material")
                .map(|v| read_material(&v.table()?))
                .transpose()?
                .map(|m| self.material(scene, m)),
        };
        if scene.instances.len() > MOST_INSTANCES {
            let error = table.error(format!("the scene has more than {MOST_INSTANCES} instances before it"));
            return Err(error.remedy("join some of them in one model"));
        }
        match (path, primitive) {
            (Some(path), None) => self.place_file(scene, &path, table, placement),
            (None, Some(primitive)) => {
                let (shape, size) = read_primitive(table, primitive.string()?)?;
                if !self.shapes.contains_key(&shape) && !self.triangles.take(shape.most_triangles()) {
                    return Err(too_many(&primitive));
                }
                placement.world_from_model *= DAffine3::from_scale(size);
                self.place_primitive(scene, shape, &placement);
                Ok(())
            }
            (Some(path), Some(_)) => Err(path.error("and `primitive` exclude each other").remedy("remove one")),
            (None, None) => Err(table.error("there is neither `path` nor `primitive`").remedy("add one of them")),
        }
    }

    fn material(&mut self, scene: &mut Scene, material: Material) -> usize {
        let ([r, g, b, _], emissive) = (material.base_color.to_array(), material.emissive);
        let key = [r, g, b, material.specular, material.shininess, emissive.x, emissive.y, emissive.z];
        *self.materials.entry(key.map(f32::to_bits)).or_insert_with(|| {
            scene.materials.push(material);
            scene.materials.len() - 1
        })
    }

    fn place_primitive(&mut self, scene: &mut Scene, shape: Shape, placement: &Placement) {
        let material = placement.material.unwrap_or_else(|| self.material(scene, Material::default()));
        let mesh = *self.shapes.entry(shape).or_insert_with(|| {
            scene.meshes.push(shape.mesh());
            scene.meshes.len() - 1
        });
        scene.instances.push(Instance {
            mesh,
            material,
            model: placement.model,
            world_from_mesh: placement.world_from_model,
            pose: None,
            casts: placement.casts,
            receives: placement.receives,
        });
    }

    fn place_file(
        &mut self,
        scene: &mut Scene,
        path: &Value<'_>,
        table: &Table<'_>,
        mut placement: Placement,
    ) -> Result<(), Error> {
        let file = self.dir.join(path.string()?);
        // The same file may be named in several ways.
        let key = self.place.one_name(&file);
        if !self.files.contains_key(&key) {
            let model = Model::read(self.place, &file).map_err(|e| path.error("names").passing_on(&e))?;
            let count = model.meshes.iter().map(|m| m.triangle_count() as u64).sum();
            if !self.triangles.take(count) {
                return Err(too_many(path));
            }
            let bases = model.add_to(scene);
            self.notes.extend_from_slice(&model.notes);
            if model.camera.is_some() || !model.lights.is_empty() {
                let title = shown(&file);
                self.notes.push(format!("{title}: its camera and lights are not used: the scene file says both"));
            }
            self.files.insert(key.clone(), (model, bases));
        }
        if let Some((model, bases)) = self.files.get(&key) {
            placement.moment = read_moment(table, model)?;
            if placement.moment.is_none() {
                self.notes.extend(model.rest_note(&file).filter(|note| !self.notes.contains(note)));
            }
            model.place(scene, *bases, &placement);
        }
        Ok(())
    }
}

/// The moment of an animation that a model is frozen in.
fn read_moment(table: &Table<'_>, model: &Model) -> Result<Option<Moment>, Error> {
    let Some(chosen) = table.get("animation") else {
        return match table.get("time") {
            None => Ok(None),
            Some(time) => Err(time.error("is that of an animation").remedy("choose one with `animation`")),
        };
    };
    let name = chosen.string()?;
    let animations = &model.rig.animations;
    let Some(animation) = animations.iter().position(|a| a.name == name) else {
        let error = chosen.error(format!("`{name}` is not in the model"));
        return Err(match animations[..] {
            [] => error.remedy("there is no animation in it: remove the key"),
            _ => error.did_you_mean(name, animations.iter().map(|a| a.name.as_str())),
        });
    };
    Ok(Some(Moment { animation, time_s: table.get_or("time", 0.0, Value::number)? }))
}

fn too_many(value: &Value<'_>) -> Error {
    let error = value.error(format!("brings the scene to more than {MOST_TRIANGLES} triangles of its own"));
    error.remedy("lower its segments or detail; the same file or shape may be placed many times")
}

impl Shape {
    fn most_triangles(self) -> u64 {
        match self {
            Self::Plane | Self::Box => 12,
            Self::Sphere([a, b]) | Self::Torus(_, [a, b]) => 2 * u64::from(a) * u64::from(b),
            Self::Cylinder([a, b]) | Self::Cone([a, b]) => 2 * u64::from(a) * (u64::from(b) + 1),
        }
    }

    fn mesh(self) -> Mesh {
        match self {
            Self::Plane => primitive::plane(),
            Self::Box => primitive::cube(),
            Self::Sphere([columns, rows]) => primitive::sphere(columns, rows),
            Self::Cylinder([columns, rows]) => primitive::cylinder(columns, rows),
            Self::Cone([columns, rows]) => primitive::cone(columns, rows),
            Self::Torus(radii, [columns, rows]) => {
                let [major, minor] = radii.map(f64::from_bits);
                primitive::torus(major, minor, columns, rows)
            }
        }
    }
}

fn primitive_keys(primitive: &Value<'_>) -> Result<&'static [&'static str], Error> {
    let name = primitive.string()?;
    match PRIMITIVES.iter().find(|(p, _)| *p == name) {
        Some((_, keys)) => Ok(keys),
        None => Err(primitive.error(format!("`{name}` is unknown")).did_you_mean(name, PRIMITIVES.map(|(p, _)| p))),
    }
}

/// The unit mesh of a primitive and its size.
fn read_primitive(table: &Table<'_>, name: &str) -> Result<(Shape, DVec3), Error> {
    let segments = |default: [u32; 2], fewest_rows: u32| {
        table.get_or("segments", default, |v| v.counts([3..MOST_SEGMENTS, fewest_rows..MOST_SEGMENTS]))
    };
    let radius = || table.require("radius")?.positive();
    let around_y = || {
        let radius = radius()?;
        Ok(DVec3::new(radius, table.require("height")?.positive()?, radius))
    };
    Ok(match name {
        "plane" => {
            let size = table.require("size")?.positive2()?;
            (Shape::Plane, DVec3::new(size.x, 1.0, size.y))
        }
        "box" => (Shape::Box, table.require("size")?.positive3()?),
        "sphere" => (Shape::Sphere(segments([64, 32], 2)?), DVec3::splat(radius()?)),
        "cylinder" => (Shape::Cylinder(segments([32, 1], 1)?), around_y()?),
        "cone" => (Shape::Cone(segments([32, 1], 1)?), around_y()?),
        _ => {
            let radii = table.require("radii")?.positive2()?.to_array();
            (Shape::Torus(radii.map(f64::to_bits), segments([64, 32], 3)?), DVec3::ONE)
        }
    })
}

/// `M = T · Rz · Ry · Rx · S`.
fn transform(table: &Table<'_>) -> Result<DAffine3, Error> {
    let translate = table.get_or("translate", DVec3::ZERO, Value::vec3)?;
    let rotate = table.get_or("rotate", DVec3::ZERO, Value::vec3)?;
    let scale = table.get_or("scale", DVec3::ONE, |v| {
        let scale = if v.is_list() { v.vec3()? } else { DVec3::splat(v.number()?) };
        let flat = !is_positive(scale.abs().min_element());
        if flat { Err(v.error(format!("must not be 0: {scale}")).remedy("remove it, or the model")) } else { Ok(scale) }
    })?;
    Ok(DAffine3::from_mat3_translation(rotation(rotate) * DMat3::from_diagonal(scale), translate))
}

fn read_material(table: &Table<'_>) -> Result<Material, Error> {
    table.check_keys(&[&["base_color", "specular", "shininess", "emissive"]])?;
    let default = Material::default();
    let base_color = table.get_or("base_color", default.base_color.truncate(), Value::color)?;
    Ok(Material {
        base_color: base_color.extend(1.0),
        specular: table.get_or("specular", default.specular, |v| v.not_negative().map(|s| s as f32))?,
        shininess: table.get_or("shininess", default.shininess, |v| v.positive().map(|s| s as f32))?,
        emissive: table.get_or("emissive", default.emissive, Value::color)?,
        ..default
    })
}
