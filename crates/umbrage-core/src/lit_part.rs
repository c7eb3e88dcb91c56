//! Which part of a picture a light can light: its range and cone as the camera sees them. A host
//! leaves lights out that light nothing it sees, and shades no more than a light's rectangle (PX
//! 5.4; GG 9.5.2, 9.6.2).

use crate::{
    bounds::Bounds,
    camera::CameraView,
    frustum::Frustum,
    light::Light,
    light_reach::{may_light_view, reach},
    view_body::ViewBody,
};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// A rectangle of the picture and a range of depths. Beyond either, the light lights nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitPart {
    /// The corner of the smallest x and y, normalised device coordinates (y points up).
    pub min: DVec2,
    /// The corner of the largest.
    pub max: DVec2,
    /// The smallest and the largest value that a depth buffer has there.
    pub depth: [f64; 2],
}

impl LitPart {
    /// The whole picture.
    pub const ALL: Self = Self { min: DVec2::NEG_ONE, max: DVec2::ONE, depth: [0.0, 1.0] };

    /// Its pixels in a picture of `width` × `height`: the first across and down, and how many of
    /// each. A pixel to each side is in it for rasterisers that round.
    pub fn pixels(&self, (width, height): (u32, u32)) -> [u32; 4] {
        let size = DVec2::new(width.into(), height.into());
        let at = |ndc: DVec2| (ndc * DVec2::new(0.5, -0.5) + 0.5) * size;
        let (low, high) = (at(DVec2::new(self.min.x, self.max.y)), at(DVec2::new(self.max.x, self.min.y)));
        let first = (low - 1.0).floor().clamp(DVec2::ZERO, size);
        let count = (high + 1.0).ceil().clamp(first, size) - first;
        [first.x as u32, first.y as u32, count.x as u32, count.y as u32]
    }
}

/// The part of the picture in which the light can light `receivers`, a box around all that is to be
/// lit. `None` where it lights nothing that the camera sees of them.
pub fn lit_part(light: &Light, camera: &CameraView, receivers: &Bounds) -> Option<LitPart> {
    let view = ViewBody::of(camera);
    let center = light.shape.center();
    let to_light = view.relative(center).truncate();
    if !(to_light.is_finite() && light.range.is_none_or(f64::is_finite)) {
        return Some(LitPart::ALL);
    }
    if !may_light_view(light, camera) {
        return None;
    }
    // Shaders work with single precision and with what a depth buffer holds.
    let rounding = |length: f64| 1e-4 * (length + to_light.length());
    let reached = reach(light).map(|bounds| bounds.grown(rounding(bounds.radius())));
    let margin = 1e-4 * receivers.largest_coordinate().min(receivers.radius());
    let seen = receivers.grown(margin);
    let lit =
        reached.map_or(seen, |of_light| Bounds { min: seen.min.max(of_light.min), max: seen.max.min(of_light.max) });
    let mut corners = Vec::with_capacity(64);
    Frustum::of(&view.clip_from_relative).clip_box(&view.relative_box(&lit), &mut corners);
    let part = around(&view.clip_from_relative, &corners)?;
    let Some(range) = light.range.filter(|_| reached.is_some()) else { return Some(part) };
    let range = range.max(light.shape.radius());
    let range = range + rounding(range);
    part.within(sphere(&view.clip_from_relative, to_light, range))
}

/// Around corners of a body, all before the eye.
fn around(clip_from_relative: &DMat4, corners: &[DVec3]) -> Option<LitPart> {
    let nothing = LitPart { min: DVec2::MAX, max: DVec2::MIN, depth: [f64::MAX, f64::MIN] };
    let add = |part: LitPart, corner: &DVec3| {
        let clip = *clip_from_relative * corner.extend(1.0);
        // What is in the plane of the eye is seen everywhere.
        if clip.w <= 1e-12 * corner.length() {
            return LitPart::ALL;
        }
        let ndc = clip / clip.w;
        let at = ndc.truncate().truncate().clamp(DVec2::NEG_ONE, DVec2::ONE);
        let depth = ndc.z.clamp(0.0, 1.0);
        LitPart {
            min: part.min.min(at),
            max: part.max.max(at),
            depth: [part.depth[0].min(depth), part.depth[1].max(depth)],
        }
    };
    (!corners.is_empty()).then(|| corners.iter().fold(nothing, add))
}

impl LitPart {
    /// The part of it between these places.
    fn within(self, [x, y]: [[f64; 2]; 2]) -> Option<Self> {
        let (min, max) = (self.min.max(DVec2::new(x[0], y[0])), self.max.min(DVec2::new(x[1], y[1])));
        min.cmple(max).all().then_some(Self { min, max, ..self })
    }
}

/// Between which x and which y a sphere lies: planes through the eye that touch it. Where it
/// reaches behind the eye, the whole picture.
fn sphere(clip_from_relative: &DMat4, center: DVec3, radius: f64) -> [[f64; 2]; 2] {
    let w = clip_from_relative.row(3);
    [0, 1].map(|axis| tangents(clip_from_relative.row(axis), w, center, radius).unwrap_or([-1.0, 1.0]))
}

/// The t for which the plane a − t·w = 0 touches the sphere.
fn tangents(a: DVec4, w: DVec4, center: DVec3, radius: f64) -> Option<[f64; 2]> {
    let at = center.extend(1.0);
    let (height, depth) = (a.dot(at), w.dot(at));
    let (a, w) = (a.truncate(), w.truncate());
    if depth <= radius * w.length() {
        return None;
    }
    let squared = radius * radius;
    let of_square = depth * depth - squared * w.length_squared();
    let middle = height * depth - squared * a.dot(w);
    let rest = height * height - squared * a.length_squared();
    let root = (middle * middle - of_square * rest).max(0.0).sqrt();
    Some([(middle - root) / of_square, (middle + root) / of_square])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, LightShape};

    const PICTURE: (u32, u32) = (160, 120);

    fn camera() -> CameraView {
        Camera { eye: DVec3::new(0.0, 0.0, 10.0), ..Camera::default() }.view(PICTURE.0, PICTURE.1)
    }

    fn lamp(position: DVec3, range: f64) -> Light {
        Light { range: Some(range), ..Light::new(LightShape::Point { position }) }
    }

    fn everything() -> Bounds {
        Bounds { min: DVec3::splat(-1e3), max: DVec3::splat(1e3) }
    }

    /// Points on and in the sphere that the camera sees are in the part, and it is not much larger.
    #[test]
    fn a_lamp_lights_its_sphere_as_the_camera_sees_it() {
        for (x, y, range) in [(0.0, 0.0, 1.0), (2.0, 1.0, 2.0), (-4.0, 2.0, 3.0), (0.3, 0.2, 9.5), (1.0, 1.0, 12.0)] {
            let (center, camera) = (DVec3::new(x, y, 0.0), camera());
            let part = lit_part(&lamp(center, range), &camera, &everything()).unwrap();
            let (mut min, mut max) = (DVec2::ONE, DVec2::NEG_ONE);
            for i in 0..40_000 {
                // A spiral over the sphere.
                let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 40_000.0;
                let turn = DVec2::from_angle(2.4 * f64::from(i)) * (1.0 - z * z).sqrt();
                let clip = camera.clip_from_world() * (center + range * DVec3::new(turn.x, turn.y, z)).extend(1.0);
                let ndc = clip / clip.w;
                let is_seen = clip.w > 0.0 && ndc.x.abs() <= 1.0 && ndc.y.abs() <= 1.0 && (0.0..=1.0).contains(&ndc.z);
                if is_seen {
                    let at = ndc.truncate().truncate();
                    (min, max) = (min.min(at), max.max(at));
                    assert!(at.cmpge(part.min).all() && at.cmple(part.max).all(), "{at} is not in {part:?}");
                    assert!((part.depth[0]..=part.depth[1]).contains(&ndc.z), "{ndc} is not in {part:?}");
                }
            }
            let off = (part.min - min).abs().max((part.max - max).abs()).max_element();
            assert!(off < 0.02 || range > 9.0, "{x} {y} {range}: {part:?}, where points are in {min} to {max}");
        }
    }

    #[test]
    fn what_lights_nothing_that_is_seen_has_no_part() {
        let behind = lamp(DVec3::new(0.0, 0.0, 70.0), 5.0);
        assert_eq!(lit_part(&behind, &camera(), &everything()), None);
        let beside = lamp(DVec3::new(60.0, 0.0, 0.0), 5.0);
        assert_eq!(lit_part(&beside, &camera(), &everything()), None);
        let far_from_all = Bounds { min: DVec3::splat(-9.0), max: DVec3::splat(-6.0) };
        assert_eq!(lit_part(&lamp(DVec3::ZERO, 5.0), &camera(), &far_from_all), None);
        assert_eq!(lit_part(&lamp(DVec3::ZERO, 5.0), &camera(), &Bounds::EMPTY), None);
    }

    #[test]
    fn light_without_limits_lights_all_receivers() {
        let sun = Light::new(LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.5 });
        let endless = Light::new(LightShape::Point { position: DVec3::new(0.0, 0.0, 99.0) });
        for light in [sun, endless] {
            assert_eq!(lit_part(&light, &camera(), &everything()).unwrap().pixels(PICTURE), [0, 0, 160, 120]);
            let small = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
            let [x, y, width, height] = lit_part(&light, &camera(), &small).unwrap().pixels(PICTURE);
            assert!(x > 40 && y > 30 && width < 60 && height < 60, "{x} {y} {width} {height}");
        }
    }

    #[test]
    fn a_spot_lights_no_more_than_its_cone() {
        let position = DVec3::new(-3.0, 0.0, 0.0);
        let spot = |direction| {
            let shape = LightShape::Spot { position, direction, inner_angle_deg: 5.0, outer_angle_deg: 10.0 };
            lit_part(&Light { range: Some(6.0), ..Light::new(shape) }, &camera(), &everything()).unwrap()
        };
        let (right, left) = (spot(DVec3::X), spot(DVec3::NEG_X));
        assert!(right.min.x > -0.7 && right.max.x > 0.5, "{right:?}");
        assert!(left.max.x < -0.4 && left.min.x == -1.0, "{left:?}");
        assert!(right.max.y < 0.4 && right.min.y > -0.4, "{right:?}");
    }

    #[test]
    fn what_is_no_number_is_left_to_others() {
        for light in [lamp(DVec3::NAN, 1.0), lamp(DVec3::ZERO, f64::NAN), lamp(DVec3::ZERO, f64::INFINITY)] {
            assert_eq!(lit_part(&light, &camera(), &everything()), Some(LitPart::ALL));
        }
    }

    #[test]
    fn pixels_stay_in_the_picture() {
        assert_eq!(LitPart::ALL.pixels((7, 5)), [0, 0, 7, 5]);
        let corner = LitPart { min: DVec2::new(0.5, 0.5), max: DVec2::ONE, ..LitPart::ALL };
        assert_eq!(corner.pixels((8, 8)), [5, 0, 3, 3]);
        assert_eq!(LitPart::ALL.pixels((0, 0)), [0, 0, 0, 0]);
    }
}
