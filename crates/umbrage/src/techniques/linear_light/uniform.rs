//! What shaders read.

use crate::shader::shader_struct;
use umbrage_core::Bounds;
use umbrage_core::glam::{DMat3, DMat4, DVec3};
use umbrage_core::light_view::LightView;

/// Views of a point: faces of a cube.
pub(super) const VIEWS: usize = 6;

shader_struct! {
    /// See `skin.wgsl`.
    pub(super) struct PointView {
        light_from_texel: [[f32; 4]; 3],
        clip_from_light: [[f32; 4]; 3],
        near: f32,
        pad_a: f32,
        pad_b: [f32; 2],
    }
}

shader_struct! {
    /// See `skin.wgsl`.
    pub(super) struct LightPoint {
        views: [PointView; VIEWS],
        position: [f32; 3],
        size: f32,
        lowest: [f32; 3],
        pad_a: f32,
        highest: [f32; 3],
        pad_b: f32,
    }
}

shader_struct! {
    /// See `find_steps.wgsl`.
    pub(super) struct FindSteps {
        layers: [[u32; 4]; 2],
        threshold: f32,
        room: u32,
        pad: [u32; 2],
    }
}

shader_struct! {
    /// See `skin.wgsl`.
    pub(super) struct SkinLayer {
        to_other: [f32; 3],
        layer: u32,
    }
}

shader_struct! {
    /// See `linear_light.wgsl`.
    pub(super) struct PointLookup {
        here: [f32; 3],
        layers: u32,
        neighbours: [[f32; 4]; 2],
    }
}

impl PointView {
    fn of(view: &LightView) -> Self {
        let rows = [0, 1, 3].map(|i| view.clip_from_world.row(i).truncate());
        let clip_from_light = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        // Row 0 of a map is at the top.
        let per_texel = 2.0 / f64::from(view.size);
        let clip_from_texel = DMat3::from_cols(
            DVec3::new(per_texel, 0.0, 0.0),
            DVec3::new(0.0, -per_texel, 0.0),
            DVec3::new(-1.0, 1.0, 1.0),
        );
        Self {
            light_from_texel: columns(&(clip_from_light.inverse() * clip_from_texel)),
            clip_from_light: columns(&clip_from_light),
            near: view.clip_from_world.row(2).w as f32,
            ..Self::default()
        }
    }
}

impl LightPoint {
    /// Of a point at `place` in a world of casters around `origin`, with a box around all
    /// receivers.
    pub(super) fn of(views: &[LightView], size: u32, place: DVec3, origin: DVec3, receivers: &Bounds) -> Self {
        let mut point = Self {
            position: (place - origin).as_vec3().to_array(),
            size: size as f32,
            lowest: (receivers.min - place).as_vec3().to_array(),
            highest: (receivers.max - place).as_vec3().to_array(),
            ..Self::default()
        };
        for view in views {
            if let Some(of) = point.views.get_mut(view.layer as usize) {
                *of = PointView::of(view);
            }
        }
        point
    }
}

fn columns(m: &DMat3) -> [[f32; 4]; 3] {
    let m = DMat4::from_mat3(*m).as_mat4().to_cols_array_2d();
    [m[0], m[1], m[2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::light_view::{Fit, FitScene, Focus, Omni, fit};
    use umbrage_core::{Camera, LightShape};

    #[test]
    fn texels_and_depths_give_places_back() {
        let floor = Bounds { min: DVec3::new(-9.0, -2.0, -9.0), max: DVec3::new(9.0, -1.0, 9.0) };
        let scene = FitScene::new(vec![floor], vec![floor]);
        let position = DVec3::new(0.3, 2.0, -0.4);
        let light = LightShape::Point { position };
        let to_fit = Fit { focus: Focus::Visible, omni: Omni::Cube, size: 512, border_texels: 1.5, border_m: 0.0 };
        let mut views = Vec::new();
        fit(&light, &Camera::default().view(4, 3).frustum(), &scene, &to_fit, &mut views);
        let place = DVec3::new(0.5, -1.0, -0.2);
        let (view, at) = views.iter().find_map(|v| Some((v, v.project(place)?))).unwrap();
        let of = PointView::of(view);
        let texel = DVec3::new((at.x + 1.0) * 256.0, (1.0 - at.y) * 256.0, 1.0);
        let [x, y, z] = of.light_from_texel.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
        let ray = DMat3::from_cols(x, y, z) * texel;
        let back = ray * (f64::from(of.near) / at.z);
        assert!(back.distance(place - position) < 1e-5, "{back} instead of {}", place - position);
    }
}
