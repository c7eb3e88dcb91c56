use super::*;
use crate::{Bounds, Mesh, primitive};
use glam::{DMat3, Vec3, Vec4};
use std::f64::consts::{FRAC_PI_2, PI};

/// Two bones of 1 m along Y; the elbow is node 1.
fn arm() -> Rig {
    let up = Parts { translation: DVec3::Y, ..Parts::default() };
    let nodes = vec![
        Node { parent: None, local: Local::Parts(Parts::default()) },
        Node { parent: Some(0), local: Local::Parts(up) },
    ];
    let joint = |node, y: f64| Joint { node, node_from_mesh: DAffine3::from_translation(DVec3::new(0.0, -y, 0.0)) };
    Rig { nodes, skins: vec![Skin { joints: vec![joint(0, 0.0), joint(1, 1.0)] }], animations: Vec::new() }
}

fn channel(property: Property, interpolation: Interpolation, keys: &[(f32, &[Vec4])]) -> Channel {
    Channel {
        node: 1,
        property,
        interpolation,
        times_s: keys.iter().map(|k| k.0).collect(),
        values: keys.iter().flat_map(|k| k.1.iter().copied()).collect(),
    }
}

/// The arm with one channel for its elbow.
fn moved(channel: Channel) -> Rig {
    Rig { animations: vec![Animation { name: "move".into(), channels: vec![channel] }], ..arm() }
}

fn at(time_s: f64) -> Option<Moment> {
    Some(Moment { animation: 0, time_s })
}

/// Where the elbow is.
fn elbow(rig: &Rig, time_s: f64) -> DVec3 {
    rig.nodes_at(at(time_s))[1].translation
}

/// How far the elbow is turned about Z, radians.
fn bend(rig: &Rig, time_s: f64) -> f64 {
    let x = rig.nodes_at(at(time_s))[1].matrix3.x_axis;
    x.y.atan2(x.x)
}

fn turn(angle: f64) -> Vec4 {
    Vec4::new(0.0, 0.0, (angle / 2.0).sin() as f32, (angle / 2.0).cos() as f32)
}

/// A line of vertices along Y; the elbow's share goes from none at 0.5 m to all at 1.5 m.
fn sleeve() -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=20 {
        let y = i as f32 * 0.1;
        mesh.positions.push(Vec3::new(0.0, y, 0.0));
        mesh.normals.push(Vec3::X);
        let weight = (y - 0.5).clamp(0.0, 1.0);
        mesh.weights.push(&[Influence { joint: 0, weight: 1.0 - weight }, Influence { joint: 1, weight }]);
    }
    mesh.indices = (0..19).flat_map(|i| [i, i + 1, i + 2]).collect();
    mesh
}

fn close(a: DVec3, b: DVec3) -> bool {
    a.distance(b) < 1e-6
}

#[test]
fn an_arm_at_rest_is_as_it_was_bound() {
    let joints = arm().joints_at(0, None);
    assert_eq!(joints, [DAffine3::IDENTITY; 2]);
    assert_eq!(sleeve().posed(&joints), sleeve());
}

#[test]
fn an_arm_bent_by_90_degrees_is_where_it_must_be() {
    let rig =
        moved(channel(Property::Rotation, Interpolation::Linear, &[(0.0, &[turn(0.0)]), (1.0, &[turn(FRAC_PI_2)])]));
    let posed = sleeve().posed(&rig.joints_at(0, at(1.0)));
    let place = |i: usize| posed.positions[i].as_dvec3();
    // The forearm points to −X from the elbow at (0, 1, 0), and its normal, X, to Y.
    assert!(close(place(20), DVec3::new(-1.0, 1.0, 0.0)), "{}", place(20));
    assert!(close(place(15), DVec3::new(-0.5, 1.0, 0.0)) && close(place(5), DVec3::new(0.0, 0.5, 0.0)));
    assert!(close(posed.normals[20].as_dvec3(), DVec3::Y) && close(posed.normals[0].as_dvec3(), DVec3::X));
    // Half held by both at 1.2 m: a mean of where each would take it, weights 0.3 and 0.7.
    let mean = DVec3::new(0.0, 1.2, 0.0) * 0.3 + DVec3::new(-0.2, 1.0, 0.0) * 0.7;
    assert!(close(place(12), mean), "{}", place(12));
}

#[test]
fn slerp_turns_at_even_speed_and_the_short_way() {
    let keys =
        |to: Vec4| moved(channel(Property::Rotation, Interpolation::Linear, &[(0.0, &[turn(0.0)]), (2.0, &[to])]));
    for to in [turn(1.2), -turn(1.2)] {
        for time in [0.0, 0.3, 1.0, 1.7, 2.0] {
            assert!((bend(&keys(to), time) - 0.6 * time).abs() < 1e-6, "{to} at {time}");
        }
    }
    assert!((bend(&keys(turn(-PI * 0.75)), 1.0) + PI * 0.375).abs() < 1e-6);
}

#[test]
fn steps_hold_and_lines_are_straight() {
    let keys: [(f32, &[Vec4]); 3] = [(1.0, &[Vec4::X]), (2.0, &[Vec4::Y * 3.0]), (4.0, &[Vec4::Z])];
    let step = moved(channel(Property::Translation, Interpolation::Step, &keys));
    let line = moved(channel(Property::Translation, Interpolation::Linear, &keys));
    for (time, held, straight) in [
        (0.0, DVec3::X, DVec3::X),
        (1.0, DVec3::X, DVec3::X),
        (1.75, DVec3::X, DVec3::new(0.25, 2.25, 0.0)),
        (2.0, DVec3::Y * 3.0, DVec3::Y * 3.0),
        (3.0, DVec3::Y * 3.0, DVec3::new(0.0, 1.5, 0.5)),
        (4.0, DVec3::Z, DVec3::Z),
    ] {
        assert!(close(elbow(&step, time), held) && close(elbow(&line, time), straight), "at {time}");
    }
}

#[test]
fn a_cubic_through_a_cubics_keys_is_that_cubic() {
    let f = |t: f64| DVec3::new(t * t * t - 2.0 * t, 1.0 - t * t, 3.0 * t);
    let slope = |t: f64| DVec3::new(3.0 * t * t - 2.0, -2.0 * t, 3.0);
    let key = |t: f64| [slope(t), f(t), slope(t)].map(|v| v.extend(0.0).as_vec4());
    let keys = [0.0, 0.5, 2.0].map(|t| (t as f32, key(t)));
    let keys: Vec<(f32, &[Vec4])> = keys.iter().map(|(t, k)| (*t, &k[..])).collect();
    let rig = moved(channel(Property::Translation, Interpolation::Cubic, &keys));
    for i in 0..=20 {
        let t = f64::from(i) * 0.1;
        assert!(elbow(&rig, t).distance(f(t)) < 1e-6, "at {t}: {} for {}", elbow(&rig, t), f(t));
    }
    let flat = [Vec4::ZERO, turn(1.0), Vec4::ZERO];
    let still = [Vec4::ZERO, turn(0.0), Vec4::ZERO];
    let rig = moved(channel(Property::Rotation, Interpolation::Cubic, &[(0.0, &still), (1.0, &flat)]));
    assert!((bend(&rig, 0.5) - 0.5).abs() < 1e-6, "the middle of a spline without slopes, made to unit length");
}

#[test]
fn times_beyond_the_ends_start_over() {
    let keys: [(f32, &[Vec4]); 2] = [(0.0, &[Vec4::ZERO]), (2.0, &[Vec4::X])];
    let rig = moved(channel(Property::Translation, Interpolation::Linear, &keys));
    for (time, x) in [(2.0, 1.0), (2.5, 0.25), (-0.5, 0.75), (20.5, 0.25), (f64::NAN, 0.0), (f64::INFINITY, 0.0)] {
        assert!((elbow(&rig, time).x - x).abs() < 1e-6, "at {time}");
    }
}

#[test]
fn what_is_missing_stays_at_rest() {
    let rest = arm().nodes_at(None);
    let empty = Rig { animations: vec![Animation::default()], ..arm() };
    assert_eq!((empty.nodes_at(at(3.0)), empty.animations[0].duration_s()), (rest.clone(), 0.0));
    assert_eq!(arm().nodes_at(at(1.0)), rest, "an animation that is not there");
    let no_keys = moved(channel(Property::Scale, Interpolation::Linear, &[]));
    assert_eq!(no_keys.nodes_at(at(1.0)), rest);
    let cut_off = moved(Channel {
        values: vec![Vec4::X],
        ..channel(Property::Translation, Interpolation::Cubic, &[(0.0, &[]), (1.0, &[])])
    });
    assert_eq!(cut_off.nodes_at(at(0.5)), rest);
    let elsewhere = moved(Channel { node: 7, ..channel(Property::Scale, Interpolation::Step, &[(0.0, &[Vec4::ONE])]) });
    assert_eq!(elsewhere.nodes_at(at(0.0)), rest);
    let mut matrix = moved(channel(Property::Translation, Interpolation::Step, &[(0.0, &[Vec4::X])]));
    matrix.nodes[1].local = Local::Matrix(rest[1]);
    assert_eq!(matrix.nodes_at(at(0.0)), rest, "matrices do not move");
    assert!(arm().joints_at(4, None).is_empty());
    let one_key = moved(channel(Property::Translation, Interpolation::Linear, &[(5.0, &[Vec4::X])]));
    assert!([0.0, 5.0, 9.0].iter().all(|t| close(elbow(&one_key, *t), DVec3::X)));
}

#[test]
fn weights_are_brought_to_a_sum_of_one() {
    let mut weights = Weights::default();
    let given =
        |list: &[(u32, f32)]| list.iter().map(|&(joint, weight)| Influence { joint, weight }).collect::<Vec<_>>();
    for list in [&[(1, 6.0), (0, 2.0)][..], &[(3, 0.0), (1, -1.0), (2, f32::NAN)], &[(5, 0.25), (4, 0.0), (5, 0.5)]] {
        weights.push(&given(list));
    }
    assert_eq!(weights.of(0), given(&[(0, 0.25), (1, 0.75)]));
    assert!(weights.of(1).is_empty() && weights.of(9).is_empty());
    assert_eq!((weights.of(2), weights.len()), (&given(&[(5, 1.0)])[..], 3));
    let mesh = Mesh { positions: vec![Vec3::ONE; 3], weights, ..Mesh::default() };
    let shift = [DVec3::ZERO, DVec3::X * 4.0].map(DAffine3::from_translation);
    // A joint that is not there does nothing, and neither does none.
    assert_eq!(mesh.posed(&shift).positions, [Vec3::new(4.0, 1.0, 1.0), Vec3::ONE, Vec3::ONE]);
}

#[test]
fn normals_stay_perpendicular_when_stretched_and_mirrored() {
    let m = DMat3::from_diagonal(DVec3::new(3.0, -1.0, 0.5)) * DMat3::from_rotation_z(0.4);
    let normal = Vec3::new(-1.0, 1.0, 0.0).normalize();
    let mut mesh = Mesh { positions: vec![Vec3::ZERO], normals: vec![normal], ..Mesh::default() };
    mesh.weights.push(&[Influence { joint: 0, weight: 1.0 }]);
    let moved = mesh.posed(&[DAffine3::from_mat3(m)]).normals[0].as_dvec3();
    assert!((m * DVec3::new(1.0, 1.0, 0.0)).dot(moved).abs() < 1e-6 && (m * normal.as_dvec3()).dot(moved) > 0.0);
}

#[test]
fn boxes_of_joints_hold_every_pose() {
    let rig = moved(channel(
        Property::Rotation,
        Interpolation::Linear,
        &[(0.0, &[turn(-2.5)]), (1.0, &[turn(0.0)]), (2.0, &[turn(2.5)])],
    ));
    let mut mesh = sleeve();
    mesh.append(&primitive::cube());
    let boxes = JointBoxes::of(&mesh);
    for i in 0..=40 {
        let joints = rig.joints_at(0, at(f64::from(i) * 0.05));
        let (around, exact) = (boxes.posed(&joints), mesh.posed(&joints).bounds());
        assert_eq!(around.union(exact), around, "pose {i}");
        assert!(around.size().length() < 1.8 * exact.size().length(), "pose {i}: {around:?} for {exact:?}");
    }
    assert_eq!(JointBoxes::of(&Mesh::default()).posed(&[]), Bounds::EMPTY);
}
