//! The light's extent, and how far around a receiver it makes filters look.

use super::DepthMaps;
use super::uniforms::{near, texels_in_plane};
use crate::shader::shader_struct;
use umbrage_core::glam::{DMat3, DVec3};
use umbrage_core::light_view::LightView;
use umbrage_core::{Bounds, LightShape};

shader_struct! {
    /// The light as a surface, see `lookup/map_layers.wgsl`.
    pub(crate) struct LightExtent {
        right: [f32; 3],
        pad: f32,
        up: [f32; 3],
        pad_a: f32,
        ahead: [f32; 3],
        pad_b: f32,
        unit_right: [f32; 3],
        pad_c: f32,
        unit_up: [f32; 3],
        pad_d: f32,
        unit_ahead: [f32; 3],
        pad_e: f32,
    }
}

/// Narrowest half axis of a round light over its widest: what is flatter than that has no direction of its own.
const FLATTEST: f64 = 1e-4;

impl LightExtent {
    pub(super) fn of(shape: &LightShape) -> Self {
        match *shape {
            LightShape::Point { .. } | LightShape::Spot { .. } => Self::round(DMat3::IDENTITY, DVec3::ZERO),
            LightShape::Directional { direction, angle_deg } => {
                let tangent = (angle_deg * 0.5).to_radians().clamp(0.0, 1.5).tan();
                let (right, up) = direction.any_orthonormal_pair();
                Self::flat(right * tangent, up * tangent, direction)
            }
            LightShape::Sphere { radius, .. } => Self::round(DMat3::IDENTITY, DVec3::splat(radius)),
            LightShape::Ellipsoid { radii, rotation, .. } => Self::round(rotation, radii),
            LightShape::Disc { direction, radius, .. } => {
                let (right, up) = direction.any_orthonormal_pair();
                Self::flat(right * radius, up * radius, direction)
            }
            LightShape::Rect { direction, up, size, .. } => {
                Self::flat(up.cross(direction) * (size.x * 0.5), up * (size.y * 0.5), direction)
            }
            LightShape::Line { from, to } => Self::flat((to - from) * 0.5, DVec3::ZERO, DVec3::ZERO),
        }
    }

    fn round(rotation: DMat3, radii: DVec3) -> Self {
        let widest = radii.max_element();
        // To where it is a ball, times the widest radius; a light without extent is a ball too.
        let narrow = if widest > 0.0 { (radii / widest).max(DVec3::splat(FLATTEST)) } else { DVec3::ONE };
        let axis = |i: usize| (rotation.col(i) * radii[i]).as_vec3().to_array();
        let unit = |i: usize| (rotation.col(i) / narrow[i]).as_vec3().to_array();
        Self {
            right: axis(0),
            up: axis(1),
            ahead: axis(2),
            unit_right: unit(0),
            unit_up: unit(1),
            unit_ahead: unit(2),
            ..Self::default()
        }
    }

    fn flat(right: DVec3, up: DVec3, normal: DVec3) -> Self {
        let [right, up, unit_ahead] = [right, up, normal].map(|v| v.as_vec3().to_array());
        Self { right, up, unit_ahead, ..Self::default() }
    }
}

/// Widest border that a fit leaves, as a multiple of what is inside of it.
const WIDEST: f64 = 2.0;

/// How many texels around a receiver's own place may show what hides the light's rim from it: the light's size as the
/// nearest caster sees it.
pub(super) fn light_border(light: &LightShape, maps: &DepthMaps) -> f64 {
    let texels = |view: &LightView| {
        if !view.is_perspective() {
            let radius = match *light {
                LightShape::Directional { angle_deg, .. } => (angle_deg * 0.5).to_radians().clamp(0.0, 1.5).tan(),
                ref shape => shape.radius(),
            };
            let depth_per_metre = view.clip_from_world.row(2).truncate().length();
            let [_, metres] = texels_in_plane(view);
            return radius * first_depth(view, &maps.scene.casters) / (depth_per_metre * metres.min_element());
        }
        let distance = nearest_distance(&view.widened(WIDEST), &maps.scene.casters);
        turned_border(view, (light.radius() / distance).min(1.0).asin())
    };
    maps.views.iter().map(texels).fold(0.0, f64::max)
}

/// Texels that a view from a point needs around it to show what is `angle` radians outside of its sides.
fn turned_border(view: &LightView, angle: f64) -> f64 {
    let half = 0.5 * f64::from(view.size);
    let [axis, per_texel] = texels_in_plane(view);
    // A paraboloid's plane has tangents of half angles.
    let share = if view.paraboloid.is_some() { 0.5 } else { 1.0 };
    let along = |axis: f64, per_texel: f64| {
        let side = per_texel * axis.abs().max((2.0 * half - axis).abs());
        let farthest = side.atan() + share * angle;
        let more = farthest.min(std::f64::consts::FRAC_PI_2).tan() - side;
        half * more / (half * per_texel + more)
    };
    along(axis.x, per_texel.x).max(along(axis.y, per_texel.y))
}

/// The largest depth that the map of a view can hold, from the boxes around the casters. Of views from a point: near / distance, not
/// along the axis.
pub(super) fn nearest(view: &LightView, casters: &[Bounds]) -> f32 {
    let deepest = match view.is_perspective() {
        true => near(view) / nearest_distance(view, casters),
        false => first_depth(view, casters),
    };
    deepest.clamp(0.0, 1.0) as f32
}

/// From the light to the nearest caster that the view may show, at least that of the near plane; infinity without any.
fn nearest_distance(view: &LightView, casters: &[Bounds]) -> f64 {
    let (frustum, light) = (view.frustum(), view.eye());
    let seen = casters.iter().filter(|b| frustum.may_see(b));
    let distances = seen.map(|b| light.distance(light.clamp(b.min, b.max)));
    distances.fold(f64::INFINITY, f64::min).max(near(view))
}

/// The largest depth in a parallel view.
fn first_depth(view: &LightView, casters: &[Bounds]) -> f64 {
    let depth = view.clip_from_world.row(2);
    let corners = casters.iter().flat_map(Bounds::corners);
    corners.map(|c: DVec3| depth.dot(c.extend(1.0))).fold(0.0, f64::max).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::Camera;
    use umbrage_core::light_view::{Fit, FitScene, Focus, Omni, fit};

    #[test]
    fn a_turned_border_shows_what_is_so_many_degrees_outside() {
        let floor = Bounds { min: DVec3::new(-9.0, -2.0, -9.0), max: DVec3::new(9.0, -1.0, 9.0) };
        let scene = FitScene::new(vec![floor], vec![floor]);
        let light = LightShape::Point { position: DVec3::ZERO };
        for (omni, side) in [(Omni::Cube, 45.0_f64), (Omni::DualParaboloid, 90.0)] {
            let mut to_fit = Fit { focus: Focus::Light, omni, size: 1000, border_texels: 0.0, border_m: 0.0 };
            let mut views = Vec::new();
            let camera = Camera::default().view(4, 3).frustum();
            let mut down = |border_texels| {
                to_fit.border_texels = border_texels;
                fit(&light, &camera, &scene, &to_fit, &mut views);
                views.iter().find(|v| v.frustum().may_see(&Bounds::of([DVec3::NEG_Y]))).cloned().unwrap()
            };
            for degrees in [1.0_f64, 8.0, 15.0] {
                let border = turned_border(&down(0.0), degrees.to_radians());
                let (sin, cos) = (side + degrees).to_radians().sin_cos();
                let at = down(border).project(DVec3::new(sin, -cos, 0.0)).unwrap();
                assert!((at.x.abs().max(at.y.abs()) - 1.0).abs() < 1e-9, "{omni:?} {degrees}: {at}");
            }
        }
    }
}
