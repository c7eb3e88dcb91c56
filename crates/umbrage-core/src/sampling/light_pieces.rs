//! Smaller soft lights that stand for a large one.

use super::hard_lights::{hard_lights, unit_ball};
use crate::light::LightShape;
use crate::material::Texture;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// About `n` soft lights of equal weight that together stand for the light `shape`. Shadows of each
/// are found by themselves, so that nearer casters hide farther ones from a piece and not from the
/// whole light. A hard light, a textured rectangle and `n` up to 1 stay as they are, alone.
///
/// Rectangles and lines are cut. Of round lights pieces are round, too, with the area of the light
/// together, and so far apart that they spread about its centre as the light does (its second
/// moment): they overlap a little, and reach a little beyond it.
pub fn light_pieces(shape: &LightShape, textures: &[Texture], n: usize) -> Vec<LightShape> {
    if !shape.kind().is_soft() || n <= 1 {
        return vec![shape.clone()];
    }
    match *shape {
        LightShape::Rect { texture: Some(_), .. } | LightShape::Environment(_) => vec![shape.clone()],
        LightShape::Rect { position, direction, up, size, texture } => {
            rects(position, [up.cross(direction), up], size, n)
                .map(|(position, size)| LightShape::Rect { position, direction, up, size, texture })
                .collect()
        }
        LightShape::Line { from, to } => {
            let at = |i: usize| from + (to - from) * (i as f64 / n as f64);
            (0..n).map(|i| LightShape::Line { from: at(i), to: at(i + 1) }).collect()
        }
        LightShape::Directional { direction, angle_deg } => {
            let radius = (0.5 * angle_deg).to_radians().tan();
            let Share { apart, radius: share } = Share::of(n);
            let angle_deg = 2.0 * (radius * share).atan().to_degrees();
            let inward = |way: DVec3| direction + (way / way.dot(direction) - direction) * apart;
            let ways = hard_lights(shape, textures, n).into_iter().filter_map(|light| match light {
                LightShape::Directional { direction, .. } => Some(inward(direction).normalize()),
                _ => None,
            });
            ways.map(|direction| LightShape::Directional { direction, angle_deg }).collect()
        }
        LightShape::Disc { position, direction, radius } => {
            let Share { apart, radius: share } = Share::of(n);
            let radius = radius * share;
            let points = hard_lights(shape, textures, n).into_iter().map(|light| light.center().truncate());
            let places = points.map(|point| position + (point - position) * apart);
            places.map(|position| LightShape::Disc { position, direction, radius }).collect()
        }
        LightShape::Sphere { position, radius } => {
            let share = Share::of(n).radius;
            let places = within_unit_ball(n).into_iter().map(|q| position + q * radius);
            places.map(|position| LightShape::Sphere { position, radius: radius * share }).collect()
        }
        LightShape::Ellipsoid { position, radii, rotation } => {
            let share = Share::of(n).radius;
            let places = within_unit_ball(n).into_iter().map(|q| position + rotation * (radii * q));
            places.map(|position| LightShape::Ellipsoid { position, radii: radii * share, rotation }).collect()
        }
        LightShape::Point { .. } | LightShape::Spot { .. } => vec![shape.clone()],
    }
}

/// What a round piece is of the light.
struct Share {
    /// Of the way from the light's centre to that of [`hard_lights`], which spread as the light
    /// does: a disc of radius r has the second moment r²/4 along each axis, and so has a sphere as
    /// a receiver sees it.
    apart: f64,
    /// Of the light's radius: all pieces have the area of the light.
    radius: f64,
}

impl Share {
    fn of(n: usize) -> Self {
        let area = 1.0 / n as f64;
        Self { apart: (1.0 - area).sqrt(), radius: area.sqrt() }
    }
}

/// Fewer pieces of a sphere than this lie on a shell, evenly all around.
const SHELL: usize = 8;

/// Centres of pieces of the unit sphere.
fn within_unit_ball(n: usize) -> Vec<DVec3> {
    // On a shell of this radius points have the sphere's second moment, as it is seen.
    let shell = 0.75_f64.sqrt();
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let on_shell = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / n as f64;
        (DVec2::from_angle(golden * i as f64) * (1.0 - z * z).sqrt()).extend(z) * shell
    };
    let points = if n < SHELL { (0..n).map(on_shell).collect() } else { unit_ball(n) };
    // An odd number has one in the middle, which spreads nothing.
    let spread = points.iter().map(|q| q.length_squared()).sum::<f64>() / n as f64;
    let apart = Share::of(n).apart * shell / spread.sqrt();
    points.into_iter().map(|q| q * apart).collect()
}

/// About `n` rectangles as square as can be, each with its centre and size, of one with these axes.
fn rects(center: DVec3, axes: [DVec3; 2], size: DVec2, n: usize) -> impl Iterator<Item = (DVec3, DVec2)> {
    let across = ((n as f64 * size.x / size.y).sqrt().round() as usize).clamp(1, n);
    let down = (n as f64 / across as f64).round().max(1.0) as usize;
    let piece = size / DVec2::new(across as f64, down as f64);
    let place = move |i: usize, count: usize| (i as f64 + 0.5) / count as f64 - 0.5;
    (0..across * down).map(move |i| {
        let (x, y) = (place(i % across, across) * size.x, place(i / across, down) * size.y);
        (center + axes[0] * x + axes[1] * y, piece)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::slice::from_ref;

    /// Mean and spread of the pieces of a round light along an axis, its own radius counted.
    fn moments(pieces: &[LightShape], axis: DVec3) -> (f64, f64) {
        let of = |piece: &LightShape| match *piece {
            LightShape::Sphere { position, radius } | LightShape::Disc { position, radius, .. } => (position, radius),
            _ => panic!("{piece:?}"),
        };
        let n = pieces.len() as f64;
        let mean = pieces.iter().map(|p| of(p).0.dot(axis)).sum::<f64>() / n;
        let spread = |p: &LightShape| (of(p).0.dot(axis) - mean).powi(2) + of(p).1.powi(2) / 4.0;
        (mean, pieces.iter().map(spread).sum::<f64>() / n)
    }

    #[test]
    fn pieces_of_round_lights_spread_as_the_light_does() {
        let position = DVec3::new(1.0, 3.0, -2.0);
        let sphere = LightShape::Sphere { position, radius: 0.6 };
        let disc = LightShape::Disc { position, direction: DVec3::NEG_Y, radius: 0.6 };
        for n in [4, 9, 16] {
            for (shape, axes) in [(&sphere, &[DVec3::X, DVec3::Y, DVec3::Z][..]), (&disc, &[DVec3::X, DVec3::Z])] {
                let pieces = light_pieces(shape, &[], n);
                assert_eq!(pieces.len(), n);
                let found: Vec<_> = axes.iter().map(|axis| moments(&pieces, *axis)).collect();
                for (axis, (mean, _)) in axes.iter().zip(&found) {
                    assert!((mean - position.dot(*axis)).abs() < 0.08, "{n} pieces lie about {mean} along {axis}");
                }
                let spread = found.iter().map(|(_, spread)| spread).sum::<f64>() / found.len() as f64;
                assert!((spread - 0.09).abs() < 0.006, "{n} pieces of {shape:?}: {spread} instead of 0.09");
            }
        }
    }

    #[test]
    fn rectangles_and_lines_are_cut() {
        let (position, direction, up) = (DVec3::Y, DVec3::NEG_Y, DVec3::Z);
        let rect = LightShape::Rect { position, direction, up, size: DVec2::new(3.0, 1.0), texture: None };
        let pieces = light_pieces(&rect, &[], 3);
        let wide = |piece: &LightShape| matches!(*piece, LightShape::Rect { size, .. } if size == DVec2::ONE);
        assert!(pieces.len() == 3 && pieces.iter().all(wide), "{pieces:?}");
        let line = LightShape::Line { from: DVec3::ZERO, to: DVec3::X * 4.0 };
        let half = LightShape::Line { from: DVec3::X * 2.0, to: DVec3::X * 4.0 };
        assert_eq!(light_pieces(&line, &[], 2)[1], half);
    }

    #[test]
    fn a_sun_becomes_smaller_suns() {
        let direction = DVec3::new(0.6, -0.8, 0.0);
        let pieces = light_pieces(&LightShape::Directional { direction, angle_deg: 20.0 }, &[], 4);
        assert_eq!(pieces.len(), 4);
        for piece in pieces {
            let LightShape::Directional { direction: way, angle_deg } = piece else { panic!("{piece:?}") };
            assert!((6.0..14.0).contains(&angle_deg) && way.angle_between(direction) < 10.0_f64.to_radians());
            assert!((way.length() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn hard_lights_and_whole_ones_stay() {
        let point = LightShape::Point { position: DVec3::ONE };
        let sphere = LightShape::Sphere { position: DVec3::ONE, radius: 1.0 };
        assert_eq!(light_pieces(&point, &[], 9), from_ref(&point));
        assert_eq!(light_pieces(&sphere, &[], 1), from_ref(&sphere));
        assert_eq!(light_pieces(&sphere, &[], 0), from_ref(&sphere));
    }
}
