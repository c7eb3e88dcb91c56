//! Many hard lights that stand for a soft one.

use super::light_sampler::LightSampler;
use super::points::symmetric_lattice;
use crate::light::LightShape;
use crate::material::Texture;
use glam::{DMat3, DVec2, DVec3, DVec4};
use std::f64::consts::{SQRT_2, TAU};

/// About `n` hard lights of equal weight that together stand for the light `shape`, whoever looks
/// at them: point lights, or directional ones for a sun. A light that is hard already stays as it
/// is, alone; `n` = 0 counts as 1, and one light is the centre. `textures` are the scene's.
///
/// Discs, rectangles, lines and suns get evenly spread points of themselves. The definition of
/// visibility shows each receiver another disc of a sphere, so its points fill the ball such that
/// they project along **every** direction to a uniform disc. That is exact for a receiver far off
/// and wrong by the order of (radius / distance)² near by.
pub fn hard_lights(shape: &LightShape, textures: &[Texture], n: usize) -> Vec<LightShape> {
    if !shape.kind().is_soft() {
        return vec![shape.clone()];
    }
    let n = n.max(1);
    match *shape {
        LightShape::Sphere { position, radius } => ball(n, position, &DMat3::from_diagonal(DVec3::splat(radius))),
        LightShape::Ellipsoid { position, radii, rotation } => {
            ball(n, position, &(rotation * DMat3::from_diagonal(radii)))
        }
        _ => even(shape, textures, n),
    }
}

/// Points of a light that looks the same to all receivers.
fn even(shape: &LightShape, textures: &[Texture], n: usize) -> Vec<LightShape> {
    let sampler = LightSampler::new(shape, textures);
    let from = sampler.at(DVec3::ZERO);
    symmetric_lattice(n)
        .map(|u| from.sample(u))
        .map(|q| match q.w {
            0.0 => LightShape::Directional { direction: -q.truncate().normalize_or(DVec3::Y), angle_deg: 0.0 },
            _ => LightShape::Point { position: q.truncate() },
        })
        .collect()
}

/// Points of the unit ball, taken to a sphere or ellipsoid.
fn ball(n: usize, position: DVec3, world_from_unit: &DMat3) -> Vec<LightShape> {
    unit_ball(n).into_iter().map(|q| LightShape::Point { position: position + *world_from_unit * q }).collect()
}

/// Points of the unit ball of density ∝ 1/√(1 − r²). By Archimedes' theorem in four dimensions, the
/// evenly covered unit 3-sphere projects to a uniform disc when two coordinates are dropped;
/// dropping one gives these points, and projecting them along any direction drops the second. They
/// come in pairs of opposite points, so that their mean is the centre, which itself makes an odd
/// `n` full.
pub(super) fn unit_ball(n: usize) -> Vec<DVec3> {
    let half = unit_3_sphere(n / 2).map(|q| q.truncate());
    half.flat_map(|q| [q, -q]).chain((n % 2 == 1).then_some(DVec3::ZERO)).collect()
}

/// `n` evenly spread points of the unit sphere in four dimensions: Alexa, "Super-Fibonacci
/// Spirals", CVPR 2022. They are made to be even together with their opposites.
fn unit_3_sphere(n: usize) -> impl Iterator<Item = DVec4> {
    /// The positive root of ψ⁴ = ψ + 4.
    const PSI: f64 = 1.533_751_168_755_204_3;
    (0..n).map(move |i| {
        let s = i as f64 + 0.5;
        let t = s / n as f64;
        let a = DVec2::from_angle(TAU * (s / SQRT_2).fract()) * t.sqrt();
        let b = DVec2::from_angle(TAU * (s / PSI).fract()) * (1.0 - t).sqrt();
        DVec4::new(a.x, a.y, b.x, b.y)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::lattice;
    use std::slice::from_ref;

    fn positions(lights: &[LightShape]) -> Vec<DVec3> {
        lights
            .iter()
            .map(|l| match l {
                LightShape::Point { position } => *position,
                other => panic!("not a point light: {other:?}"),
            })
            .collect()
    }

    /// Directions all around.
    fn directions() -> Vec<DVec3> {
        let from_square = |u: DVec2| {
            let z = 1.0 - 2.0 * u.x;
            (DVec2::from_angle(TAU * u.y) * (1.0 - z * z).sqrt()).extend(z)
        };
        lattice(89).into_iter().map(from_square).collect()
    }

    /// Share of the unit disc beyond the line at distance `d` from its centre.
    fn segment(d: f64) -> f64 {
        (d.acos() - d * (1.0 - d * d).sqrt()) / std::f64::consts::PI
    }

    /// Over many directions and lines, the errors of the share of points beyond the line: root mean
    /// square, largest.
    fn share_errors(points: &[DVec3], along: &[DVec3]) -> (f64, f64) {
        let (mut squares, mut worst): (f64, f64) = (0.0, 0.0);
        for axis in along {
            for k in -19..20 {
                let d = (f64::from(k) + 0.01) / 20.0;
                let share = points.iter().filter(|q| q.dot(*axis) > d).count() as f64 / points.len() as f64;
                worst = worst.max((share - segment(d)).abs());
                squares += (share - segment(d)).powi(2);
            }
        }
        ((squares / (along.len() as f64 * 39.0)).sqrt(), worst)
    }

    #[test]
    fn a_sphere_projects_to_a_uniform_disc_along_every_direction() {
        // Random points would have 0.027 (root mean square) at 256.
        for (n, rms_limit, worst_limit) in [(65, 0.022, 0.09), (256, 0.0085, 0.035), (1024, 0.003, 0.014)] {
            let points = positions(&hard_lights(&LightShape::Sphere { position: DVec3::ZERO, radius: 1.0 }, &[], n));
            assert_eq!(points.len(), n);
            let (rms, worst) = share_errors(&points, &directions());
            assert!(rms < rms_limit && worst < worst_limit, "{n} points: shares are off by {rms}, at worst {worst}");
        }
    }

    #[test]
    fn an_ellipsoid_has_the_moments_of_its_discs() {
        let (position, radii) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(3.0, 1.0, 0.5));
        let rotation = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_y(2.0);
        let points = positions(&hard_lights(&LightShape::Ellipsoid { position, radii, rotation }, &[], 1024));
        let unit: Vec<DVec3> = points.iter().map(|q| rotation.transpose() * (*q - position) / radii).collect();
        assert!(unit.iter().sum::<DVec3>().length() < 1e-9, "the mean is not the centre");
        for axis in directions() {
            let second = unit.iter().map(|q| q.dot(axis).powi(2)).sum::<f64>() / 1024.0;
            assert!((second - 0.25).abs() < 2e-3, "along {axis}: {second} instead of 1/4");
        }
    }

    #[test]
    fn flat_lights_get_points_of_themselves() {
        let (position, direction, up) = (DVec3::new(0.0, 3.0, 1.0), DVec3::NEG_Y, DVec3::Z);
        let disc = LightShape::Disc { position, direction, radius: 2.0 };
        let rect = LightShape::Rect { position, direction, up, size: DVec2::new(2.0, 4.0), texture: None };
        for (shape, want) in [(disc, [1.0, 1.0]), (rect, [4.0 / 12.0, 16.0 / 12.0])] {
            let points = positions(&hard_lights(&shape, &[], 256));
            let second = points.iter().map(|q| (*q - position).powf(2.0)).sum::<DVec3>() / 256.0;
            let mean = points.iter().sum::<DVec3>() / 256.0;
            assert!(mean.distance(position) < 1e-9, "{shape:?}: mean {mean}");
            let want = DVec3::new(want[0], 0.0, want[1]);
            assert!(second.distance(want) < 0.02, "{shape:?}: second moment {second} instead of {want}");
        }
    }

    #[test]
    fn a_line_is_cut_into_equal_pieces() {
        let (from, to) = (DVec3::ZERO, DVec3::X * 8.0);
        let x: Vec<f64> = positions(&hard_lights(&LightShape::Line { from, to }, &[], 4)).iter().map(|q| q.x).collect();
        assert_eq!(x, [1.0, 3.0, 5.0, 7.0]);
    }

    #[test]
    fn a_sun_becomes_directions_within_its_cone() {
        let direction = DVec3::new(0.6, -0.8, 0.0);
        let lights = hard_lights(&LightShape::Directional { direction, angle_deg: 4.0 }, &[], 64);
        assert_eq!(lights.len(), 64);
        for light in lights {
            let LightShape::Directional { direction: d, angle_deg } = light else { panic!("{light:?}") };
            assert!(angle_deg == 0.0 && d.angle_between(direction) <= 2.0f64.to_radians() + 1e-9, "{d}");
        }
    }

    #[test]
    fn hard_lights_stay_and_one_light_is_the_centre() {
        let point = LightShape::Point { position: DVec3::ONE };
        assert_eq!(hard_lights(&point, &[], 9), from_ref(&point));
        let soft = [
            LightShape::Sphere { position: DVec3::ONE, radius: 2.0 },
            LightShape::Disc { position: DVec3::ONE, direction: DVec3::X, radius: 2.0 },
            LightShape::Line { from: DVec3::ZERO, to: DVec3::splat(2.0) },
        ];
        for shape in soft {
            for n in [0, 1] {
                assert_eq!(hard_lights(&shape, &[], n), from_ref(&point), "{shape:?}");
            }
        }
    }
}
