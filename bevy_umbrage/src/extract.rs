//! What casts shadows and what they fall on: whatever has changed of it since the last frame is
//! copied to the render world, and that alone.

use crate::convert;
use bevy::asset::{AssetEvent, AssetId, Assets};
use bevy::ecs::entity::{EntityHashMap, EntityHashSet};
use bevy::ecs::system::SystemParam;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::prelude::*;
use bevy::render::Extract;
use std::collections::{HashMap, HashSet};
use umbrage::core::glam::DAffine3;
use umbrage::core::{self, Texture};

pub type MeshAsset = AssetId<Mesh>;
pub type MaterialAsset = AssetId<StandardMaterial>;

/// A placed mesh.
#[derive(Clone, Debug)]
pub struct Placed {
    pub mesh: MeshAsset,
    /// `None` for an opaque surface.
    pub material: Option<MaterialAsset>,
    pub world_from_mesh: DAffine3,
    /// What joints do to the mesh as it was bound; `None` for one without.
    pub joints: Option<Vec<DAffine3>>,
    pub casts: bool,
    pub receives: bool,
}

/// Where a surface is cut out, by which picture.
#[derive(Clone, Debug)]
pub struct Cutout {
    pub material: core::Material,
    pub texture: Option<Texture>,
}

/// What the render world has not seen yet, in the order in which it has to be done.
#[derive(Resource, Default)]
pub struct Changes {
    pub removed: EntityHashSet,
    pub meshes: Vec<(MeshAsset, core::Mesh)>,
    pub materials: Vec<(MaterialAsset, Cutout)>,
    pub placed: EntityHashMap<Placed>,
    pub moved: Vec<(Entity, DAffine3)>,
    pub bent: Vec<(Entity, Vec<DAffine3>)>,
    /// After everything that used them.
    pub dropped_meshes: Vec<MeshAsset>,
    pub dropped_materials: Vec<MaterialAsset>,
    known: Known,
}

/// What has been sent.
#[derive(Default)]
struct Known {
    meshes: HashSet<MeshAsset>,
    /// With the picture that each shows.
    materials: HashMap<MaterialAsset, Option<AssetId<Image>>>,
    placed: EntityHashSet,
    /// Whose mesh, material or picture is still being loaded.
    waiting: EntityHashSet,
}

pub(crate) type Caster<'a> = (
    &'a Mesh3d,
    Option<&'a MeshMaterial3d<StandardMaterial>>,
    &'a GlobalTransform,
    &'a InheritedVisibility,
    Has<NotShadowCaster>,
    Has<NotShadowReceiver>,
    Option<&'a SkinnedMesh>,
);

type Altered = Or<(
    Changed<Mesh3d>,
    Changed<MeshMaterial3d<StandardMaterial>>,
    Changed<InheritedVisibility>,
    Added<NotShadowCaster>,
    Added<NotShadowReceiver>,
    Changed<SkinnedMesh>,
)>;

/// Assets of the main world.
#[derive(SystemParam)]
pub struct Sources<'w, 's> {
    meshes: Extract<'w, 's, Res<'static, Assets<Mesh>>>,
    materials: Extract<'w, 's, Res<'static, Assets<StandardMaterial>>>,
    images: Extract<'w, 's, Res<'static, Assets<Image>>>,
    bind_poses: Extract<'w, 's, Res<'static, Assets<SkinnedMeshInverseBindposes>>>,
}

/// What tells that assets and components changed, or are gone.
#[derive(SystemParam)]
pub struct News<'w, 's> {
    meshes: Extract<'w, 's, MessageReader<'static, 'static, AssetEvent<Mesh>>>,
    materials: Extract<'w, 's, MessageReader<'static, 'static, AssetEvent<StandardMaterial>>>,
    images: Extract<'w, 's, MessageReader<'static, 'static, AssetEvent<Image>>>,
    altered: Extract<'w, 's, Query<'static, 'static, Entity, (With<Mesh3d>, Altered)>>,
    without_mesh: Extract<'w, 's, RemovedComponents<'static, 'static, Mesh3d>>,
    without_material: Extract<'w, 's, RemovedComponents<'static, 'static, MeshMaterial3d<StandardMaterial>>>,
    casters_again: Extract<'w, 's, RemovedComponents<'static, 'static, NotShadowCaster>>,
    receivers_again: Extract<'w, 's, RemovedComponents<'static, 'static, NotShadowReceiver>>,
    without_skin: Extract<'w, 's, RemovedComponents<'static, 'static, SkinnedMesh>>,
}

impl News<'_, '_> {
    fn entities(&mut self, waiting: &mut EntityHashSet) -> EntityHashSet {
        let mut all = std::mem::take(waiting);
        all.extend(self.altered.iter());
        all.extend(self.without_mesh.read());
        all.extend(self.without_material.read());
        all.extend(self.casters_again.read());
        all.extend(self.receivers_again.read());
        all.extend(self.without_skin.read());
        all
    }
}

/// Copies what has changed.
pub fn casters(
    mut changes: ResMut<Changes>,
    mut news: News,
    sources: Sources,
    all: Extract<Query<Caster>>,
    moved: Extract<Query<(Entity, &GlobalTransform), (With<Mesh3d>, Without<SkinnedMesh>, Changed<GlobalTransform>)>>,
    skinned: Extract<Query<(Entity, Ref<GlobalTransform>, &SkinnedMesh)>>,
    joints: Extract<Query<Ref<GlobalTransform>>>,
) {
    let changes = &mut *changes;
    follow_assets(changes, &mut news, &sources);
    for entity in news.entities(&mut changes.known.waiting) {
        let Some(caster) = all.get(entity).ok().filter(|(.., visible, _, _, _)| visible.get()) else {
            changes.remove(entity);
            continue;
        };
        let (Mesh3d(mesh), material, place, _, no_caster, no_receiver, skin) = caster;
        let material = material.map(|MeshMaterial3d(handle)| handle.id());
        let is_there = changes.known.mesh(mesh.id(), &sources, &mut changes.meshes)
            && material.is_none_or(|id| changes.known.material(id, &sources, &mut changes.materials));
        if !is_there {
            changes.remove(entity);
            changes.known.waiting.insert(entity);
            continue;
        }
        let world_from_mesh = convert::affine(&place.affine());
        let place_of = |joint: Entity| joints.get(joint).ok().map(|place| place.affine());
        let joints = skin.and_then(|skin| bend(skin, &world_from_mesh, &sources, place_of));
        let (casts, receives, mesh) = (!no_caster, !no_receiver, mesh.id());
        let placed = Placed { mesh, material, world_from_mesh, joints, casts, receives };
        changes.known.placed.insert(entity);
        changes.placed.insert(entity, placed);
    }
    let Changes { known, placed, moved: new, bent, .. } = changes;
    let is_old = |entity: &Entity| known.placed.contains(entity) && !placed.contains_key(entity);
    new.extend(moved.iter().filter(|(e, _)| is_old(e)).map(|(e, place)| (e, convert::affine(&place.affine()))));
    for (entity, place, skin) in skinned.iter().filter(|(e, ..)| is_old(e)) {
        let has_moved = |joint: &Entity| joints.get(*joint).is_ok_and(|place| place.is_changed());
        if !place.is_changed() && !skin.joints.iter().any(has_moved) {
            continue;
        }
        let world_from_mesh = convert::affine(&place.affine());
        let place_of = |joint: Entity| joints.get(joint).ok().map(|place| place.affine());
        new.push((entity, world_from_mesh));
        bent.extend(bend(skin, &world_from_mesh, &sources, place_of).map(|joints| (entity, joints)));
    }
}

/// What each joint does to the mesh as it was bound. Bevy's joints place vertices in the world,
/// those of umbrage in the mesh's space.
fn bend(
    skin: &SkinnedMesh,
    world_from_mesh: &DAffine3,
    sources: &Sources,
    place_of: impl Fn(Entity) -> Option<bevy::math::Affine3A>,
) -> Option<Vec<DAffine3>> {
    let bind_poses = sources.bind_poses.get(&skin.inverse_bindposes)?;
    let mesh_from_world = world_from_mesh.inverse();
    let joint = |(joint, bind_pose): (&Entity, &Mat4)| {
        let world_from_joint = place_of(*joint).map_or(*world_from_mesh, |place| convert::affine(&place));
        mesh_from_world * world_from_joint * convert::affine_of(bind_pose)
    };
    Some(skin.joints.iter().zip(bind_poses.iter()).map(joint).collect())
}

/// Sends again what was changed of what has been sent.
fn follow_assets(changes: &mut Changes, news: &mut News, sources: &Sources) {
    for event in news.meshes.read() {
        match *event {
            AssetEvent::Modified { id } if changes.known.meshes.remove(&id) => {
                changes.known.mesh(id, sources, &mut changes.meshes);
            }
            AssetEvent::Removed { id } if changes.known.meshes.remove(&id) => changes.dropped_meshes.push(id),
            _ => {}
        }
    }
    let mut again: Vec<MaterialAsset> = Vec::new();
    for event in news.images.read() {
        if let AssetEvent::Modified { id } = *event {
            let shows = |(_, image): &(_, &Option<AssetId<Image>>)| **image == Some(id);
            again.extend(changes.known.materials.iter().filter(shows).map(|(material, _)| *material));
        }
    }
    for event in news.materials.read() {
        match *event {
            AssetEvent::Modified { id } => again.push(id),
            AssetEvent::Removed { id } if changes.known.materials.remove(&id).is_some() => {
                changes.dropped_materials.push(id);
            }
            _ => {}
        }
    }
    for id in again {
        if changes.known.materials.remove(&id).is_some() {
            changes.known.material(id, sources, &mut changes.materials);
        }
    }
}

impl Changes {
    fn remove(&mut self, entity: Entity) {
        if self.known.placed.remove(&entity) {
            self.placed.remove(&entity);
            self.removed.insert(entity);
        }
    }

    /// True where the render world has nothing to do.
    pub fn is_empty(&self) -> bool {
        let lists = [self.moved.len(), self.bent.len(), self.dropped_meshes.len(), self.dropped_materials.len()];
        let sets = [self.removed.len(), self.meshes.len(), self.materials.len(), self.placed.len()];
        lists.into_iter().chain(sets).all(|len| len == 0)
    }

    /// For a render world that knows nothing yet: everything is sent, in the next frame.
    pub fn send_again(&mut self) {
        let Known { placed, waiting, .. } = std::mem::take(self).known;
        self.known.waiting = placed.into_iter().chain(waiting).collect();
    }

    /// What there is to do, and remembers that it is done.
    pub fn take(&mut self) -> Self {
        let known = std::mem::take(&mut self.known);
        let taken = std::mem::take(self);
        self.known = known;
        taken
    }
}

impl Known {
    /// Sends a mesh where it was not; false where there is none yet, or none of triangles.
    fn mesh(&mut self, id: MeshAsset, sources: &Sources, to: &mut Vec<(MeshAsset, core::Mesh)>) -> bool {
        if self.meshes.contains(&id) {
            return true;
        }
        let Some(source) = sources.meshes.get(id) else { return false };
        let Some(mesh) = convert::mesh(source) else {
            warn_once!("umbrage: a mesh without triangles, or with data on the GPU alone, casts no shadow");
            return false;
        };
        to.push((id, mesh));
        self.meshes.insert(id)
    }

    /// The same for a material.
    fn material(&mut self, id: MaterialAsset, sources: &Sources, to: &mut Vec<(MaterialAsset, Cutout)>) -> bool {
        if self.materials.contains_key(&id) {
            return true;
        }
        let Some(source) = sources.materials.get(id) else { return false };
        let material = convert::material(source);
        let shows = source.base_color_texture.as_ref().filter(|_| material.alpha_cutoff.is_some());
        let mut texture = None;
        if let Some(handle) = shows {
            let Some(image) = sources.images.get(handle) else { return false };
            texture = convert::texture(format!("{:?}", handle.id()), image);
            if texture.is_none() {
                warn_once!("umbrage: a picture in a format that the CPU can't read cuts nothing out of shadows");
            }
        }
        to.push((id, Cutout { material, texture }));
        self.materials.insert(id, shows.map(Handle::id));
        true
    }
}
