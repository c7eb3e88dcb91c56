//! Texels of a light's views, and matrices as shaders read them.

use crate::view::View;
use umbrage_core::glam::{DMat4, DVec2, DVec3, DVec4};
use umbrage_core::light_view::{LightView, Paraboloid};

/// Where a paraboloid's plane is in its map.
#[derive(Clone, Copy)]
pub(super) struct InTexels {
    /// The texel of the axis.
    pub axis: DVec2,
    /// Texels per unit of the plane, across and down.
    pub per_unit: DVec2,
}

impl InTexels {
    pub fn of(size: u32, paraboloid: &Paraboloid) -> Self {
        let half = f64::from(size) * 0.5;
        let down = DVec2::new(1.0, -1.0);
        Self { axis: (DVec2::ONE + paraboloid.axis * down) * half, per_unit: paraboloid.scale * half }
    }
}

/// Of a view from a point: the texel straight ahead, and what a texel spans of the plane, that at
/// distance 1 ahead or a paraboloid's.
pub(super) fn texels_in_plane(view: &LightView) -> [DVec2; 2] {
    match &view.paraboloid {
        Some(paraboloid) => {
            let InTexels { axis, per_unit } = InTexels::of(view.size, paraboloid);
            [axis, per_unit.recip()]
        }
        None => {
            let axis = axis(&(texels_from_clip(view.size) * view.clip_from_world));
            [axis.truncate().truncate(), DVec2::new(axis.z, axis.w)]
        }
    }
}

/// Of a perspective view the texel straight ahead and the tangent that a texel spans, of a parallel
/// one the metres it spans.
pub(super) fn axis(map_from_world: &DMat4) -> DVec4 {
    let [across, down, ahead] = [0, 1, 3].map(|i| map_from_world.row(i).truncate());
    let straight = DVec2::new(across.dot(ahead), down.dot(ahead));
    let per_texel = |row: DVec3, straight: f64| 1.0 / (row - ahead * straight).length().max(f64::MIN_POSITIVE);
    straight.extend(per_texel(across, straight.x)).extend(per_texel(down, straight.y))
}

/// Clip space to texels across and down, row 0 at the top.
pub(super) fn texels_from_clip(size: u32) -> DMat4 {
    let half = f64::from(size) * 0.5;
    DMat4::from_cols(
        DVec4::new(half, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -half, 0.0, 0.0),
        DVec4::Z,
        DVec4::new(half, half, 0.0, 1.0),
    )
}

/// Takes normalised device coordinates to the distance along the view, times w.
pub(super) fn view_distance(view: &View<'_>, eye_from_ndc: &DMat4) -> [f32; 4] {
    (eye_from_ndc.transpose() * view.camera.forward().extend(0.0)).as_vec4().to_array()
}

pub(super) fn matrix(m: &DMat4) -> [[f32; 4]; 4] {
    m.as_mat4().to_cols_array_2d()
}

/// Of a perspective view: the distance of depth 1.
pub(super) fn near(view: &LightView) -> f64 {
    view.clip_from_world.row(2).w
}
