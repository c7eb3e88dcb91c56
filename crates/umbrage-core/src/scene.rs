//! A scene: everything a picture needs.

use crate::{bounds::Bounds, camera::Camera, light::Light, material::Material, material::Texture, mesh::Mesh};
use glam::{DAffine3, Vec3};

/// Meshes placed in the world, lights and a camera.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// For titles.
    pub name: String,
    /// Where it is seen from.
    pub camera: Camera,
    /// Light that comes from everywhere, linear RGB.
    pub ambient: Vec3,
    /// Shapes; instances refer to them, so that a city of boxes holds one box.
    pub meshes: Vec<Mesh>,
    /// Appearances; instances refer to them.
    pub materials: Vec<Material>,
    /// Pictures; materials and lights refer to them.
    pub textures: Vec<Texture>,
    /// Placed meshes.
    pub instances: Vec<Instance>,
    /// Lights, in the order of the file.
    pub lights: Vec<Light>,
}

/// A mesh placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Which `[[model]]` of the scene file it belongs to; a model file of several meshes makes several instances.
    pub model: usize,
    /// Places the mesh.
    pub world_from_mesh: DAffine3,
    /// False: it throws no shadow.
    pub casts: bool,
    /// False: no shadow falls on it.
    pub receives: bool,
}

impl Scene {
    /// The box around an instance.
    pub fn instance_bounds(&self, instance: &Instance) -> Bounds {
        self.meshes[instance.mesh].bounds().transformed(&instance.world_from_mesh)
    }

    /// The box around all instances.
    pub fn bounds(&self) -> Bounds {
        let meshes: Vec<Bounds> = self.meshes.iter().map(Mesh::bounds).collect();
        self.instances.iter().fold(Bounds::EMPTY, |b, i| b.union(meshes[i.mesh].transformed(&i.world_from_mesh)))
    }

    /// Number of triangles, each instance counted.
    pub fn triangle_count(&self) -> usize {
        self.instances.iter().map(|i| self.meshes[i.mesh].triangle_count()).sum()
    }

    /// Adds a mesh and returns its index. A mesh equal to one that is there is not added again.
    pub fn add_mesh(&mut self, mesh: Mesh) -> usize {
        let same = |m: &Mesh| m.indices == mesh.indices && m.positions == mesh.positions && *m == mesh;
        self.meshes.iter().position(same).unwrap_or_else(|| {
            self.meshes.push(mesh);
            self.meshes.len() - 1
        })
    }

    /// Adds a material and returns its index. A material equal to one that is there is not added again.
    pub fn add_material(&mut self, material: Material) -> usize {
        self.materials.iter().position(|m| *m == material).unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        })
    }

    /// Places a mesh as a model of its own that casts and receives; returns the instance to change.
    pub fn place(&mut self, mesh: usize, material: usize, world_from_mesh: DAffine3) -> &mut Instance {
        let model = self.instances.last().map_or(0, |i| i.model + 1);
        self.instances.push(Instance { mesh, material, model, world_from_mesh, casts: true, receives: true });
        let last = self.instances.len() - 1;
        &mut self.instances[last]
    }
}
