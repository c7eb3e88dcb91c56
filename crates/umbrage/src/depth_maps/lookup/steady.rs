//! What maps of splits that stand still share: their axes, and depth. A receiver's place in one of
//! them gives that in all others.

use super::layer::MapLayer;
use crate::depth_maps::texels::{texels_from_clip, texels_in_plane};
use umbrage_core::glam::DVec2;
use umbrage_core::light_view::LightView;

/// Makes layer 0's matrix that of the first view, whether or not layer 0 is rendered, and has the
/// texels of all others come from its texels.
pub(super) fn share_first(views: &[LightView], layers: &mut [MapLayer]) {
    let Some(first) = views.first().filter(|view| view.steady_border.is_some()) else { return };
    for layer in layers.iter_mut() {
        layer.from_first = OUTSIDE;
    }
    for view in views {
        layers[view.layer as usize].from_first = from_first(first, view);
    }
    let from_first = layers[0].from_first;
    layers[0] = MapLayer { from_first, ..layers[first.layer as usize] };
}

/// Of a layer that was not rendered: every point is outside of its map.
pub(super) const OUTSIDE: [f32; 4] = [0.0, 0.0, -1.0, -1.0];

/// See `map_layers.wgsl`.
fn from_first(first: &LightView, view: &LightView) -> [f32; 4] {
    let [(from, wide_from), (to, wide_to)] = [first, view].map(place);
    let scale = wide_from / wide_to;
    let offset = to - from * scale;
    [scale, scale.recip(), offset.x, offset.y].map(|v| v as f32)
}

/// The texel of a place that all views of a light share, straight ahead of it or the world's
/// origin, and how wide a texel is.
fn place(view: &LightView) -> (DVec2, f64) {
    let [straight, wide] = texels_in_plane(view);
    let map_from_world = texels_from_clip(view.size) * view.clip_from_world;
    let origin = DVec2::new(map_from_world.row(0).w, map_from_world.row(1).w);
    (if view.is_perspective() { straight } else { origin }, wide.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::DVec3;
    use umbrage_core::light_view::{Cascades, Cover, Fit, FitScene, Focus, Omni, fit_cascades};
    use umbrage_core::{Bounds, Camera, LightShape};

    fn steady_views(light: &LightShape) -> Vec<LightView> {
        let floor = Bounds { min: DVec3::new(-90.0, -2.0, -90.0), max: DVec3::new(90.0, -1.0, 90.0) };
        let scene = FitScene::new(vec![floor], vec![floor]);
        let cover = Cover::Steady { step_texels: 8.0 };
        let cascades = Cascades { count: 4, lambda: 0.5, overlap: 0.1, distance: 0.0, cover };
        let fit = Fit { focus: Focus::Visible, omni: Omni::Cube, size: 512, border_texels: 2.0, border_m: 0.1 };
        let camera = Camera { eye: DVec3::new(-60.0, 3.0, 9.0), target: DVec3::ZERO, ..Camera::default() }.view(64, 48);
        let (mut views, mut borders) = (Vec::new(), Vec::new());
        assert!(fit_cascades(light, &camera, &scene, &cascades, &fit, &mut views, &mut borders).is_none());
        assert!(views.len() > 2);
        views
    }

    #[test]
    fn texels_of_the_first_view_give_those_of_every_other_one() {
        let direction = DVec3::new(0.3, -0.9, 0.2).normalize();
        let sun = LightShape::Directional { direction, angle_deg: 0.0 };
        let position = DVec3::new(-20.0, 50.0, 5.0);
        let lamp = LightShape::Spot { position, direction, inner_angle_deg: 30.0, outer_angle_deg: 40.0 };
        for light in [sun, lamp] {
            let views = steady_views(&light);
            for (view, point) in views.iter().flat_map(|v| [DVec3::ZERO, DVec3::new(3.0, -1.0, -7.0)].map(|p| (v, p))) {
                let [texel_of_first, texel] = [&views[0], view].map(|v| {
                    let at = texels_from_clip(v.size) * v.project(point).unwrap().extend(1.0);
                    DVec2::new(at.x, at.y)
                });
                let [scale, inverse, x, y] = from_first(&views[0], view).map(f64::from);
                let apart = (texel_of_first * scale + DVec2::new(x, y) - texel).length();
                assert!(apart < 1e-3, "{light:?} layer {}: {apart} texels off", view.layer);
                assert!((scale * inverse - 1.0).abs() < 1e-6);
                let depth = |v: &LightView| v.project(point).unwrap().z;
                assert!((depth(view) - depth(&views[0])).abs() < 1e-12, "{light:?} layer {}", view.layer);
            }
        }
    }

    #[test]
    fn what_is_not_rendered_covers_nothing() {
        let sun = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
        let views = steady_views(&sun);
        let mut layers = [MapLayer { per_metre: 1.0, ..MapLayer::default() }; 4];
        layers[1].per_metre = 7.0;
        share_first(&views[1..3], &mut layers);
        assert_eq!([layers[0].from_first, layers[3].from_first], [OUTSIDE; 2]);
        assert_eq!(layers[0].per_metre, 7.0, "lends the first view's matrix");
        assert_eq!(layers[1].from_first, [1.0, 1.0, 0.0, 0.0]);
    }
}
