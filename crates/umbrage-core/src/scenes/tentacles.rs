//! Casters that bend.

use super::{DETAIL, SceneEntry, kit::*, shapes};
use crate::rig::{Animation, Channel, Influence, Interpolation, Joint, Local, Moment, Node, Parts, Property, Skin};
use crate::{Camera, LightShape, Mesh, Pose, Rig, Scene, primitive};
use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3};
use std::f64::consts::TAU;

pub const ENTRY: SceneEntry = SceneEntry {
    id: "tentacles",
    title: "Swaying tentacles",
    about: "Meshes on joints, each in a pose of its own, shadow the floor, each other and themselves. `bench --moving casters` sets \
            them swaying. Lights: 0 point, 1 sphere at the same place.",
    build,
};

/// Of a tentacle, metres.
const HEIGHT: f64 = 2.4;
const RADIUS: f64 = 0.17;

/// Bones, one on the other.
const BONES: usize = 12;
const BONE: f64 = HEIGHT / BONES as f64;

/// Of the animation: seconds, and keys.
const PERIOD_S: f64 = 4.0;
const KEYS: usize = 16;

fn build(detail: f32) -> Scene {
    let detail = Detail::within(detail, DETAIL);
    let mut scene = Scene {
        name: ENTRY.title.into(),
        camera: Camera {
            eye: DVec3::new(-2.6, 3.4, 6.4),
            target: DVec3::new(0.3, 0.8, -0.1),
            fov_y_deg: 40.0,
            ..Camera::default()
        },
        ambient: Vec3::new(0.07, 0.08, 0.12),
        rigs: vec![rig()],
        ..Scene::default()
    };
    let plane = scene.add_mesh(primitive::plane());
    let cube = scene.add_mesh(primitive::cube());
    let tentacle = scene.add_mesh(tentacle(detail.segments(20, 6), detail.segments(36, BONES as u32)));
    let floor = scene.add_material(matte(0.74, 0.72, 0.66));
    let stone = scene.add_material(matte(0.45, 0.47, 0.5));
    let skins =
        [(0.6, 0.22, 0.3), (0.2, 0.45, 0.42), (0.55, 0.42, 0.15)].map(|(r, g, b)| scene.add_material(glossy(r, g, b)));
    scene.place(plane, floor, sized(DVec3::ZERO, DVec3::new(14.0, 1.0, 14.0), 0.0));
    scene.place(cube, stone, standing(DVec3::new(1.7, 0.0, -1.2), DVec3::new(0.9, 0.6, 0.9), 30.0));
    for (i, (x, z)) in [(-1.3, 0.2), (0.1, -0.9), (0.9, 0.8)].into_iter().enumerate() {
        let turned = DAffine3::from_rotation_y(i as f64 * 2.1);
        let moment = Some(Moment { animation: 0, time_s: 0.4 + 1.3 * i as f64 });
        let instance = scene.place(tentacle, skins[i], at(x, 0.0, z) * turned);
        instance.pose = Some(Pose { rig: 0, skin: 0, moment });
    }
    let position = DVec3::new(-2.2, 5.2, 2.4);
    let warm = [1.0, 0.93, 0.82];
    scene.lights = vec![
        light(LightShape::Point { position }, warm, 0.8),
        light(LightShape::Sphere { position, radius: 0.35 }, warm, 0.8),
    ];
    scene
}

/// A tapering, closed tentacle that stands upright, each height held by the two joints next to it.
fn tentacle(columns: u32, rows: u32) -> Mesh {
    let tip = RADIUS * 0.25;
    let round = shapes::arc(DVec2::new(0.0, HEIGHT - tip), tip, 90.0, 15.0, 5);
    let side = (1..=rows).map(|row| {
        let share = f64::from(row) / f64::from(rows);
        DVec2::new(tip + (RADIUS - tip) * share, (HEIGHT - tip) * (1.0 - share))
    });
    let top = DVec2::new(0.0, HEIGHT);
    let profile: Vec<DVec2> =
        [top].into_iter().chain(round.into_iter().skip(1)).chain(side).chain([DVec2::ZERO]).collect();
    let mut mesh = shapes::lathe("tentacle", columns, &profile);
    for position in &mesh.positions {
        let bone = (f64::from(position.y) / BONE - 0.5).clamp(0.0, (BONES - 1) as f64);
        let (lower, share) = (bone.floor() as u32, bone.fract() as f32);
        mesh.weights
            .push(&[Influence { joint: lower, weight: 1.0 - share }, Influence { joint: lower + 1, weight: share }]);
    }
    mesh
}

/// A chain of bones, and a wave that runs up and around it.
fn rig() -> Rig {
    let step = |i: usize| Parts { translation: DVec3::Y * if i == 0 { 0.0 } else { BONE }, ..Parts::default() };
    let node = |i: usize| Node { parent: i.checked_sub(1), local: Local::Parts(step(i)) };
    let joint = |i: usize| Joint { node: i, node_from_mesh: at(0.0, -BONE * i as f64, 0.0) };
    Rig {
        nodes: (0..BONES).map(node).collect(),
        skins: vec![Skin { joints: (0..BONES).map(joint).collect() }],
        animations: vec![Animation { name: "sway".into(), channels: (0..BONES).map(bend).collect() }],
    }
}

/// How a bone leans against the one below, over time: this way and that about two axes.
fn bend(bone: usize) -> Channel {
    let times = (0..=KEYS).map(|key| PERIOD_S * key as f64 / KEYS as f64);
    let rotation = |time_s: f64| {
        let turn = TAU * time_s / PERIOD_S - 0.35 * bone as f64;
        let lean = if bone == 0 { 0.05 } else { 0.17 };
        DQuat::from_rotation_x(lean * turn.sin()) * DQuat::from_rotation_z(0.8 * lean * turn.cos() + 0.03)
    };
    Channel {
        node: bone,
        property: Property::Rotation,
        interpolation: Interpolation::Linear,
        times_s: times.clone().map(|t| t as f32).collect(),
        values: times.map(|t| glam::DVec4::from(rotation(t)).as_vec4()).collect(),
    }
}
