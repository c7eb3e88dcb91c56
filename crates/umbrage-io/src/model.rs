//! A model file as data: what OBJ and glTF give, before it is placed in a scene.

use crate::error::{self, Error, shown};
use crate::files::Files;
use crate::limits::LARGEST;
use crate::{extension, gltf_file, obj};
use glam::{DAffine3, Vec2, Vec3};
use std::path::Path;
use umbrage_core::rig::{Moment, Rig};
use umbrage_core::{Camera, Instance, Light, Material, Mesh, Pose, Scene, Texture};

/// Meshes with their places in the model, and what else a model file may hold. Indices are its own.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub meshes: Vec<Mesh>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub parts: Vec<Part>,
    pub rig: Rig,
    pub camera: Option<Camera>,
    pub lights: Vec<Light>,
    /// For the user: what was left out.
    pub notes: Vec<String>,
}

/// A mesh in its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub mesh: usize,
    pub material: usize,
    pub hold: Hold,
}

/// What places a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hold {
    /// The model itself.
    Model,
    /// A node of the rig.
    Node(usize),
    /// The joints of a skin of the rig.
    Skin(usize),
}

/// How a model stands in the scene.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// Which `[[model]]` of the scene file it is.
    pub model: usize,
    pub world_from_model: DAffine3,
    /// Of one of the rig's animations; `None` at rest.
    pub moment: Option<Moment>,
    pub casts: bool,
    pub receives: bool,
    /// Index of a material of the scene instead of the model's own.
    pub material: Option<usize>,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            model: 0,
            world_from_model: DAffine3::IDENTITY,
            moment: None,
            casts: true,
            receives: true,
            material: None,
        }
    }
}

/// Where the meshes and materials of a model start in a scene, and which rig is its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bases {
    mesh: usize,
    material: usize,
    rig: usize,
}

impl Model {
    /// Reads a model by its extension.
    pub fn read(files: Files<'_>, path: &Path) -> Result<Self, Error> {
        let model = match extension(path).as_str() {
            "obj" => obj::read(files, path)?,
            "gltf" | "glb" => gltf_file::read(files, path)?,
            other => {
                return Err(Error::new(path, format!("`.{other}` is not a kind of file that can be opened"))
                    .remedy("use .toml (a scene file), .obj, .gltf or .glb"));
            }
        };
        if model.parts.iter().all(|p| model.meshes[p.mesh].indices.is_empty()) {
            return Err(Error::new(path, "there is no triangle in it").remedy("export the model with its faces"));
        }
        Ok(model)
    }

    /// Copies meshes, materials and textures into the scene.
    pub fn add_to(&self, scene: &mut Scene) -> Bases {
        let bases = Bases { mesh: scene.meshes.len(), material: scene.materials.len(), rig: scene.rigs.len() };
        let texture = scene.textures.len();
        scene.textures.extend_from_slice(&self.textures);
        scene.meshes.extend_from_slice(&self.meshes);
        if !self.rig.skins.is_empty() {
            scene.rigs.push(self.rig.clone());
        }
        scene
            .materials
            .extend(self.materials.iter().map(|m| Material { texture: m.texture.map(|t| t + texture), ..m.clone() }));
        bases
    }

    /// Makes an instance of every part of the model, which [`Model::add_to`] put into the scene at
    /// `bases`.
    pub fn place(&self, scene: &mut Scene, bases: Bases, placement: &Placement) {
        let Placement { world_from_model, moment, .. } = *placement;
        let nodes = self.rig.nodes_at(moment);
        scene.instances.extend(self.parts.iter().map(|part| Instance {
            mesh: bases.mesh + part.mesh,
            material: placement.material.unwrap_or(bases.material + part.material),
            model: placement.model,
            world_from_mesh: match part.hold {
                Hold::Node(node) => world_from_model * nodes[node],
                Hold::Model | Hold::Skin(_) => world_from_model,
            },
            pose: match part.hold {
                Hold::Skin(skin) => Some(Pose { rig: bases.rig, skin, moment }),
                Hold::Model | Hold::Node(_) => None,
            },
            casts: placement.casts,
            receives: placement.receives,
        }));
    }

    /// What to tell a user who sees the model of this file at rest.
    pub fn rest_note(&self, path: &Path) -> Option<String> {
        let names: Vec<&str> = self.rig.animations.iter().map(|a| a.name.as_str()).collect();
        let path = shown(path);
        match (names.as_slice(), self.rig.skins.is_empty()) {
            ([], true) => None,
            ([], false) => Some(format!("{path}: skinned meshes are shown in their rest pose")),
            ([first, ..], _) => Some(format!(
                "{path}: it is shown at rest; `animation = \"{}\"` in a scene file moves it (of {})",
                error::line(first),
                error::line(&names.join(", "))
            )),
        }
    }
}

/// True where a vertex can be worked with: finite, and not so large that the differences and
/// squares of `f32` arithmetic overflow.
pub(crate) fn is_usable(position: Vec3) -> bool {
    position.is_finite() && f64::from(position.abs().max_element()) <= LARGEST
}

/// True where a texture coordinate can be worked with.
pub(crate) fn is_usable_uv(uv: Vec2) -> bool {
    uv.is_finite() && f64::from(uv.abs().max_element()) <= LARGEST
}
