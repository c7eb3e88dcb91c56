//! How far around a receiver a light's extent makes filters look.

use crate::depth_maps::nearest::{first_depth, nearest_distance};
use crate::depth_maps::texels::texels_in_plane;
use umbrage_core::light_view::LightView;
use umbrage_core::{Bounds, LightShape};

/// Widest border that a fit leaves, as a multiple of what is inside of it.
const WIDEST: f64 = 2.0;

/// How many texels around a receiver's own place may show what hides the light's rim from it: the
/// light's size as the nearest caster sees it.
pub(super) fn light_border(views: &[LightView], casters: &[Bounds], light: &LightShape) -> f64 {
    let texels = |view: &LightView| {
        if !view.is_perspective() {
            let radius = match *light {
                LightShape::Directional { angle_deg, .. } => (angle_deg * 0.5).to_radians().clamp(0.0, 1.5).tan(),
                ref shape => shape.radius(),
            };
            let depth_per_metre = view.clip_from_world.row(2).truncate().length();
            let [_, metres] = texels_in_plane(view);
            return radius * first_depth(view, casters) / (depth_per_metre * metres.min_element());
        }
        let distance = nearest_distance(&view.widened(WIDEST), casters);
        turned_border(view, (light.radius() / distance).min(1.0).asin())
    };
    views.iter().map(texels).fold(0.0, f64::max)
}

/// Texels that a view from a point needs around it to show what is `angle` radians outside of its
/// sides.
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

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::Camera;
    use umbrage_core::glam::DVec3;
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
