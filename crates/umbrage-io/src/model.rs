//! A model file as data: what OBJ and glTF come to, before it is placed in a scene.

use crate::{Error, extension, gltf_file, obj};
use glam::{DAffine3, Vec2, Vec3};
use std::path::Path;
use umbrage_core::{Camera, Instance, Light, Material, Mesh, Scene, Texture};

/// Meshes with their places in the model, and what else a model file may hold. Indices are its own.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub meshes: Vec<Mesh>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub parts: Vec<Part>,
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
    pub model_from_mesh: DAffine3,
}

/// How a model stands in the scene.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// Which `[[model]]` of the scene file it is.
    pub model: usize,
    pub world_from_model: DAffine3,
    pub casts: bool,
    pub receives: bool,
    /// Index of a material of the scene instead of the model's own.
    pub material: Option<usize>,
}

impl Default for Placement {
    fn default() -> Self {
        Self { model: 0, world_from_model: DAffine3::IDENTITY, casts: true, receives: true, material: None }
    }
}

/// Where the meshes and materials of a model start in a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bases {
    mesh: usize,
    material: usize,
}

impl Model {
    /// Reads a model by its extension.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let model = match extension(path).as_str() {
            "obj" => obj::read(path)?,
            "gltf" | "glb" => gltf_file::read(path)?,
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
        let bases = Bases { mesh: scene.meshes.len(), material: scene.materials.len() };
        let texture = scene.textures.len();
        scene.textures.extend_from_slice(&self.textures);
        scene.meshes.extend_from_slice(&self.meshes);
        scene
            .materials
            .extend(self.materials.iter().map(|m| Material { texture: m.texture.map(|t| t + texture), ..m.clone() }));
        bases
    }

    /// Makes an instance of every part of the model, which [`Model::add_to`] put into the scene at `bases`.
    pub fn place(&self, scene: &mut Scene, bases: Bases, placement: &Placement) {
        scene.instances.extend(self.parts.iter().map(|part| Instance {
            mesh: bases.mesh + part.mesh,
            material: placement.material.unwrap_or(bases.material + part.material),
            model: placement.model,
            world_from_mesh: placement.world_from_model * part.model_from_mesh,
            casts: placement.casts,
            receives: placement.receives,
        }));
    }
}

/// True where a vertex can be worked with: finite, and not so large that the differences and squares of `f32`
/// arithmetic overflow.
pub(crate) fn is_usable(position: Vec3) -> bool {
    position.is_finite() && position.abs().max_element() <= 1e15
}

/// True where a texture coordinate can be worked with.
pub(crate) fn is_usable_uv(uv: Vec2) -> bool {
    uv.is_finite() && uv.abs().max_element() <= 1e15
}
