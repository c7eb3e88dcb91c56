//! The world as a scene of umbrage: to trace rays in it, or to save it.

use crate::convert;
use crate::extract::Caster;
use bevy::ecs::system::SystemState;
use bevy::mesh::skinning::SkinnedMeshInverseBindposes;
use bevy::prelude::*;
use umbrage::core::glam::DAffine3;
use umbrage::core::{Instance, Material, Scene};

/// Everything that a [`crate::UmbrageLight`] would see of the main world, each skinned mesh as its
/// joints hold it now. Lights and camera are left to the caller.
///
/// # Errors
/// The world lacks resources of Bevy's renderer.
pub fn scene(world: &mut World) -> Result<Scene> {
    let mut state: SystemState<(
        Query<Caster>,
        Query<&GlobalTransform>,
        Res<Assets<Mesh>>,
        Res<Assets<StandardMaterial>>,
        Res<Assets<Image>>,
        Res<Assets<SkinnedMeshInverseBindposes>>,
    )> = SystemState::new(world);
    let (placed, places, meshes, materials, images, bind_poses) = state.get(world)?;
    let mut scene = Scene::default();
    for (Mesh3d(mesh), surface, place, visible, no_caster, no_receiver, skin) in &placed {
        let Some(mut mesh) = meshes.get(mesh).and_then(convert::mesh).filter(|_| visible.get()) else { continue };
        let mut world_from_mesh = convert::affine(&place.affine());
        if let Some((skin, poses)) = skin.and_then(|skin| Some((skin, bind_poses.get(&skin.inverse_bindposes)?))) {
            let place_of = |joint: Entity| places.get(joint).map_or(*place, |place| *place);
            let joints = skin.joints.iter().zip(poses.iter());
            let joints: Vec<_> = joints
                .map(|(joint, pose)| convert::affine(&place_of(*joint).affine()) * convert::affine_of(pose))
                .collect();
            mesh = mesh.posed(&joints);
            world_from_mesh = DAffine3::IDENTITY;
        }
        mesh.weights = Default::default();
        let mut material = Material::default();
        if let Some(source) = surface.and_then(|surface| materials.get(&surface.0)) {
            material = convert::material(source);
            let picture = source.base_color_texture.as_ref().filter(|_| material.alpha_cutoff.is_some());
            let picture =
                picture.and_then(|handle| convert::texture(format!("{:?}", handle.id()), images.get(handle)?));
            material.texture = picture.as_ref().map(|_| scene.textures.len());
            scene.textures.extend(picture);
        }
        let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material));
        let model = scene.instances.len();
        let (casts, receives) = (!no_caster, !no_receiver);
        scene.instances.push(Instance { mesh, material, model, world_from_mesh, pose: None, casts, receives });
    }
    Ok(scene)
}
