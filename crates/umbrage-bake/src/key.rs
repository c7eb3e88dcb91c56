//! Names of bakes: what determines them.

use crate::Settings;
use std::fmt;
use umbrage_core::{Fnv, Mesh, Scene};

/// Changes with every change of what a bake computes from the same scene and settings.
const VERSION: &str = "umbrage bake 1";

/// What determines a transfer: meshes, places, materials, pictures and settings. Cameras, lights
/// and names make no difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key(u128);

impl Key {
    /// Of a scene, as its animations stand, baked with these settings.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        let mut hash = Fnv::default();
        hash.text(format_args!("{VERSION} {settings:?} "));
        for instance in &scene.instances {
            hash.text(format_args!("{:?} {} ", instance.world_from_mesh, instance.casts));
            hash.text(format_args!("{:?} ", scene.materials.get(instance.material)));
            if instance.mesh < scene.meshes.len() {
                add_mesh(&mut hash, &scene.posed_mesh(instance));
            }
        }
        for texture in &scene.textures {
            hash.text(format_args!("{} {} {:?} ", texture.width, texture.height, texture.sampling));
            hash.add(texture.rgba.as_flattened());
        }
        Self(hash.value())
    }

    /// The number itself.
    pub fn value(self) -> u128 {
        self.0
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

fn add_mesh(hash: &mut Fnv, mesh: &Mesh) {
    let counts = [mesh.positions.len(), mesh.normals.len(), mesh.uvs.len(), mesh.opacities.len(), mesh.indices.len()];
    hash.text(format_args!("{counts:?} "));
    hash.add(bytemuck::cast_slice(&mesh.positions));
    hash.add(bytemuck::cast_slice(&mesh.normals));
    hash.add(bytemuck::cast_slice(&mesh.uvs));
    hash.add(bytemuck::cast_slice(&mesh.opacities));
    hash.add(bytemuck::cast_slice(&mesh.indices));
}
