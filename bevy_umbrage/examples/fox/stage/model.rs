//! A model from a file, and its animation.

use bevy::animation::graph::AnimationGraph;
use bevy::animation::{AnimatedBy, AnimationTargetId};
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{DynamicSkinnedMeshBounds, VisibilityClass};
use bevy::ecs::reflect::AppTypeRegistry;
use bevy::gltf::{GltfAssetLabel, GltfExtras, GltfMaterialName, GltfMeshName, GltfSceneName};
use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy::transform::components::TransformTreeChanged;
use bevy::world_serialization::WorldInstanceReady;
use std::path::PathBuf;

/// The model of a file is there, and its animation plays.
#[derive(Component)]
pub struct Ready;

/// What it is to play.
#[derive(Component)]
struct Plays(Handle<AnimationGraph>, AnimationNodeIndex);

/// Loads it; once it is there it is [`Ready`].
pub fn spawn(world: &mut World, path: PathBuf) -> Entity {
    register(world);
    let server = world.resource::<AssetServer>();
    let walk = server.load(GltfAssetLabel::Animation(1).from_asset(path.clone()));
    let model = server.load(GltfAssetLabel::Scene(0).from_asset(path));
    let (graph, index) = AnimationGraph::from_clip(walk);
    let graph = world.resource_mut::<Assets<AnimationGraph>>().add(graph);
    // The sample fox is as many units long as a fox is centimetres.
    let place =
        Transform::from_xyz(0.1, 0.0, 0.5).with_scale(Vec3::splat(0.01)).with_rotation(Quat::from_rotation_y(2.0));
    world.spawn((WorldAssetRoot(model), Plays(graph, index), place)).observe(start).id()
}

/// What models are made of. Bevy does this itself with its feature `reflect_auto_register`.
fn register(world: &World) {
    let mut types = world.resource::<AppTypeRegistry>().write();
    macro_rules! register {
        ($($component:ty),*) => { $(types.register::<$component>();)* };
    }
    register!(Transform, GlobalTransform, TransformTreeChanged, Visibility, InheritedVisibility, ViewVisibility);
    register!(VisibilityClass, Name, ChildOf, Children, Aabb, Mesh3d, MeshMaterial3d<StandardMaterial>);
    register!(SkinnedMesh, DynamicSkinnedMeshBounds, AnimationPlayer, AnimationTargetId, AnimatedBy);
    register!(GltfExtras, GltfMaterialName, GltfMeshName, GltfSceneName);
}

fn start(
    ready: On<WorldInstanceReady>,
    mut commands: Commands,
    children: Query<&Children>,
    plays: Query<&Plays>,
    mut players: Query<&mut AnimationPlayer>,
) {
    let Ok(Plays(graph, index)) = plays.get(ready.entity) else { return };
    for child in children.iter_descendants(ready.entity) {
        if let Ok(mut player) = players.get_mut(child) {
            player.play(*index).repeat();
            commands.entity(child).insert(AnimationGraphHandle(graph.clone()));
        }
    }
    commands.entity(ready.entity).insert(Ready);
}
