//! A scene: everything a picture needs.

use crate::rig::{Moment, Rig};
use crate::{
    bounds::Bounds, camera::Camera, environment::Environment, light::Light, material::Material, material::Texture,
    mesh::Mesh,
};
use glam::{DAffine3, Vec3};
use std::borrow::Cow;

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
    /// What poses meshes with joints; instances refer to them.
    pub rigs: Vec<Rig>,
    /// Placed meshes.
    pub instances: Vec<Instance>,
    /// Lights, in the order of the file.
    pub lights: Vec<Light>,
    /// The sky around it, a light that is numbered after all [`Self::lights`].
    pub environment: Option<Environment>,
}

/// A mesh placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Which `[[model]]` of the scene file it belongs to; a model file of several meshes makes
    /// several instances.
    pub model: usize,
    /// Places the mesh.
    pub world_from_mesh: DAffine3,
    /// How its joints hold it; `None` for a mesh as it is.
    pub pose: Option<Pose>,
    /// False: it casts no shadow.
    pub casts: bool,
    /// False: no shadow falls on it.
    pub receives: bool,
}

/// How the joints of an instance's mesh stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Index into [`Scene::rigs`].
    pub rig: usize,
    /// Index into [`Rig::skins`].
    pub skin: usize,
    /// Of an animation; `None` at rest.
    pub moment: Option<Moment>,
}

impl Scene {
    /// All lights by their numbers: [`Self::lights`], then the environment.
    pub fn numbered_lights(&self) -> impl Iterator<Item = Cow<'_, Light>> {
        let environment = self.environment.as_ref().map(|e| Cow::Owned(e.light()));
        self.lights.iter().map(Cow::Borrowed).chain(environment)
    }

    /// The light of a number, see [`Self::numbered_lights`].
    pub fn light(&self, number: usize) -> Option<Cow<'_, Light>> {
        self.numbered_lights().nth(number)
    }

    /// What each joint of an instance does to the vertices of its mesh; `None` for a mesh as it is.
    pub fn joints(&self, instance: &Instance) -> Option<Vec<DAffine3>> {
        let pose = instance.pose?;
        Some(self.rigs.get(pose.rig)?.joints_at(pose.skin, pose.moment))
    }

    /// An instance's mesh as its joints hold it.
    pub fn posed_mesh(&self, instance: &Instance) -> Cow<'_, Mesh> {
        let mesh = &self.meshes[instance.mesh];
        self.joints(instance).map_or(Cow::Borrowed(mesh), |joints| Cow::Owned(mesh.posed(&joints)))
    }

    /// Moves every animation on by so many seconds.
    pub fn advance(&mut self, seconds: f64) {
        let poses = self.instances.iter_mut().filter_map(|i| i.pose.as_mut());
        poses.filter_map(|pose| pose.moment.as_mut()).for_each(|moment| moment.time_s += seconds);
    }

    /// The box around an instance.
    pub fn instance_bounds(&self, instance: &Instance) -> Bounds {
        self.posed_mesh(instance).bounds().transformed(&instance.world_from_mesh)
    }

    /// The box around all instances.
    pub fn bounds(&self) -> Bounds {
        let meshes: Vec<Bounds> = self.meshes.iter().map(Mesh::bounds).collect();
        let of = |i: &Instance| match i.pose {
            Some(_) => self.instance_bounds(i),
            None => meshes[i.mesh].transformed(&i.world_from_mesh),
        };
        self.instances.iter().map(of).fold(Bounds::EMPTY, Bounds::union)
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

    /// Adds a material and returns its index. A material equal to one that is there is not added
    /// again.
    pub fn add_material(&mut self, material: Material) -> usize {
        self.materials.iter().position(|m| *m == material).unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        })
    }

    /// Places a mesh as a model of its own that casts and receives; returns the instance to change.
    pub fn place(&mut self, mesh: usize, material: usize, world_from_mesh: DAffine3) -> &mut Instance {
        let model = self.instances.last().map_or(0, |i| i.model + 1);
        let instance = Instance { mesh, material, model, world_from_mesh, pose: None, casts: true, receives: true };
        self.instances.push(instance);
        let last = self.instances.len() - 1;
        &mut self.instances[last]
    }
}
