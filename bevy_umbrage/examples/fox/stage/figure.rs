//! A fox made in code: tubes that thirteen joints bend, and a walk.

use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::DynamicSkinnedMeshBounds;
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::mesh::{Indices, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;
use std::f32::consts::{PI, TAU};

/// Has figures walk.
pub struct WalkPlugin;

impl Plugin for WalkPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, (walk, swing));
    }
}

/// The figure as a whole goes round in a circle.
#[derive(Component)]
struct Walker;

/// A joint that swings about the axis across the body: by how much, when in a step, and around
/// which angle.
#[derive(Component, Clone, Copy)]
struct Swing {
    amplitude: f32,
    phase: f32,
    middle: f32,
}

/// Steps a second.
const PACE: f32 = 1.4;

fn walk(time: Res<Time>, mut figures: Query<&mut Transform, With<Walker>>) {
    let angle = 0.5 + 0.45 * time.elapsed_secs();
    for mut place in &mut figures {
        place.translation = Vec3::new(0.1 + 0.55 * angle.cos(), 0.0, 0.35 - 0.55 * angle.sin());
        place.rotation = Quat::from_rotation_y(angle + PI / 2.0);
    }
}

fn swing(time: Res<Time>, mut joints: Query<(&Swing, &mut Transform)>) {
    for (Swing { amplitude, phase, middle }, mut joint) in &mut joints {
        let now = (time.elapsed_secs() * PACE + phase) * TAU;
        joint.rotation = Quat::from_rotation_z(middle + amplitude * now.sin());
    }
}

/// A joint: its parent's number, where it is as the mesh was made, and how it swings.
type Bone = (Option<usize>, [f32; 3], [f32; 3]);

/// The body looks along x. Four legs of two joints follow.
const SPINE: [Bone; 5] = [
    (None, [-0.35, 0.56, 0.0], [0.03, 0.0, 0.0]),
    (Some(0), [0.3, 0.58, 0.0], [0.04, 0.25, 0.0]),
    (Some(1), [0.5, 0.72, 0.0], [0.10, 0.4, 0.0]),
    (Some(0), [-0.42, 0.58, 0.0], [0.15, 0.1, -0.1]),
    (Some(3), [-0.75, 0.52, 0.0], [0.25, 0.3, -0.15]),
];

fn bones() -> Vec<Bone> {
    let mut bones = SPINE.to_vec();
    for (x, spine, phase) in [(-0.33, 0, 0.0), (0.3, 1, 0.5)] {
        for (z, turn) in [(-0.11, 0.0), (0.11, 0.5)] {
            bones.push((Some(spine), [x, 0.50, z], [0.45, phase + turn, 0.0]));
            bones.push((Some(bones.len() - 1), [x, 0.27, z], [0.35, phase + turn + 0.3, -0.3]));
        }
    }
    bones
}

/// Puts one into the world.
pub fn spawn(world: &mut World) {
    let bones = bones();
    let figure = world.spawn((Name::new("fox"), Transform::default(), Visibility::default(), Walker)).id();
    let mut joints = Vec::new();
    for (parent, place, [amplitude, phase, middle]) in &bones {
        let start = parent.map_or(Vec3::ZERO, |parent| Vec3::from_array(bones[parent].1));
        let local = Transform::from_translation(Vec3::from_array(*place) - start);
        let swing = Swing { amplitude: *amplitude, phase: *phase, middle: *middle };
        let joint = world.spawn((local, Visibility::default(), swing)).id();
        world.entity_mut(parent.map_or(figure, |parent| joints[parent])).add_child(joint);
        joints.push(joint);
    }
    let bind_poses: Vec<Mat4> = bones.iter().map(|(_, p, _)| Mat4::from_translation(-Vec3::from_array(*p))).collect();
    let inverse_bindposes =
        world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(SkinnedMeshInverseBindposes::from(bind_poses));
    let mesh = Mesh3d(world.resource_mut::<Assets<Mesh>>().add(Tubes::fox().mesh()));
    let fur =
        StandardMaterial { base_color: Color::linear_rgb(0.55, 0.20, 0.05), perceptual_roughness: 0.8, ..default() };
    let fur = MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(fur));
    let skin = SkinnedMesh { inverse_bindposes, joints };
    world.spawn((mesh, fur, skin, Transform::default(), DynamicSkinnedMeshBounds, ChildOf(figure)));
}

/// A ring of a tube: its middle, its radius, and two joints with the share of the second.
struct Ring([f32; 3], f32, [u16; 2], f32);

/// Closed tubes.
#[derive(Default)]
struct Tubes {
    positions: Vec<Vec3>,
    joints: Vec<[u16; 4]>,
    weights: Vec<[f32; 4]>,
    indices: Vec<u32>,
}

const SIDES: u32 = 14;

impl Tubes {
    fn fox() -> Self {
        let mut fox = Self::default();
        fox.tube(&[
            Ring([-0.46, 0.57, 0.0], 0.03, [0, 0], 0.0),
            Ring([-0.42, 0.57, 0.0], 0.11, [0, 0], 0.0),
            Ring([-0.25, 0.57, 0.0], 0.145, [0, 1], 0.1),
            Ring([0.0, 0.57, 0.0], 0.13, [0, 1], 0.5),
            Ring([0.25, 0.58, 0.0], 0.15, [0, 1], 0.9),
            Ring([0.38, 0.62, 0.0], 0.12, [1, 2], 0.2),
            Ring([0.47, 0.70, 0.0], 0.085, [1, 2], 0.8),
            Ring([0.54, 0.78, 0.0], 0.105, [2, 2], 0.0),
            Ring([0.64, 0.80, 0.0], 0.09, [2, 2], 0.0),
            Ring([0.72, 0.77, 0.0], 0.045, [2, 2], 0.0),
            Ring([0.84, 0.74, 0.0], 0.02, [2, 2], 0.0),
        ]);
        for z in [-0.055, 0.055] {
            let ear = [([0.52, 0.85], 0.035), ([0.51, 0.92], 0.025), ([0.50, 0.98], 0.004)];
            fox.tube(&ear.map(|([x, y], radius)| Ring([x, y, z], radius, [2, 2], 0.0)));
        }
        fox.tube(&[
            Ring([-0.40, 0.59, 0.0], 0.03, [0, 3], 0.5),
            Ring([-0.52, 0.57, 0.0], 0.055, [3, 3], 0.0),
            Ring([-0.66, 0.54, 0.0], 0.075, [3, 4], 0.3),
            Ring([-0.82, 0.51, 0.0], 0.08, [3, 4], 0.8),
            Ring([-0.97, 0.49, 0.0], 0.05, [4, 4], 0.0),
            Ring([-1.05, 0.48, 0.0], 0.01, [4, 4], 0.0),
        ]);
        for (leg, (x, z)) in (0..).zip([(-0.33, -0.11), (-0.33, 0.11), (0.3, -0.11), (0.3, 0.11)]) {
            let (hip, knee) = (5 + 2 * leg, 6 + 2 * leg);
            fox.tube(&[
                Ring([x, 0.56, z], 0.06, [hip, hip], 0.0),
                Ring([x, 0.42, z], 0.055, [hip, knee], 0.0),
                Ring([x, 0.30, z], 0.04, [hip, knee], 0.3),
                Ring([x, 0.24, z], 0.036, [hip, knee], 0.7),
                Ring([x, 0.10, z], 0.03, [hip, knee], 1.0),
                Ring([x + 0.02, 0.03, z], 0.036, [knee, knee], 0.0),
            ]);
        }
        fox
    }

    fn vertex(&mut self, place: Vec3, Ring(_, _, [a, b], share): &Ring) -> u32 {
        self.positions.push(place);
        self.joints.push([*a, *b, 0, 0]);
        self.weights.push([1.0 - share, *share, 0.0, 0.0]);
        self.positions.len() as u32 - 1
    }

    fn tube(&mut self, rings: &[Ring]) {
        let middle = |i: usize| Vec3::from_array(rings[i].0);
        let mut last: Option<u32> = None;
        for (i, ring) in rings.iter().enumerate() {
            let along = (middle((i + 1).min(rings.len() - 1)) - middle(i.saturating_sub(1))).normalize();
            // z is across every tube here.
            let across = Vec3::Z;
            let up = across.cross(along);
            let first = self.positions.len() as u32;
            for side in 0..SIDES {
                let (sin, cos) = (TAU * side as f32 / SIDES as f32).sin_cos();
                self.vertex(middle(i) + (across * cos + up * sin) * ring.1, ring);
            }
            for side in 0..SIDES {
                let next = (side + 1) % SIDES;
                if let Some(last) = last {
                    let quad = [last + side, first + side, first + next, last + side, first + next, last + next];
                    self.indices.extend(quad);
                }
            }
            last = Some(first);
        }
        let ends =
            [(0, self.positions.len() as u32 - SIDES * rings.len() as u32), (rings.len() - 1, last.unwrap_or(0))];
        for (i, first) in ends {
            let tip = self.vertex(middle(i), &rings[i]);
            for side in 0..SIDES {
                let (a, b) = (first + side, first + (side + 1) % SIDES);
                self.indices.extend(if i == 0 { [tip, a, b] } else { [tip, b, a] });
            }
        }
    }

    fn mesh(self) -> Mesh {
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(self.joints))
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, self.weights)
            .with_inserted_indices(Indices::U32(self.indices))
            .with_computed_smooth_normals()
            .with_generated_skinned_mesh_bounds()
            .expect("it has joints and weights")
    }
}
