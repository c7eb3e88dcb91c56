//! What the shaders that draw a map need to know of a view.

use crate::depth_maps::texels::{InTexels, matrix, near};
use crate::shader::{Shared, shader_struct};
use umbrage_core::glam::{DMat4, DVec2, DVec3};
use umbrage_core::light_view::{FARTHEST, LightView};

shader_struct! {
    /// What the shaders that draw a map need, see `map_view.wgsl`.
    pub(crate) struct MapView {
        clip_from_world: [[f32; 4]; 4],
        clip_from_plane: [f32; 4],
        plane_from_texel: [f32; 4],
        same: [f32; 2],
        farthest: f32,
        near: f32,
        least_w: f32,
        size: f32,
        pad_a: f32,
        pad_b: f32,
    }
}

/// What the host has to agree on with `map_view.wgsl`.
pub(in crate::depth_maps) const SHARED: Shared =
    Shared { module: "map_view", layouts: &[MapView::LAYOUT], constants: &[] };

impl MapView {
    /// For casters relative to `origin`.
    pub(super) fn new(view: &LightView, origin: DVec3, linear: bool) -> Self {
        let plane = view.paraboloid.as_ref().map(|p| (p, InTexels::of(view.size, p)));
        let four = |a: DVec2, b: DVec2| a.extend(b.x).extend(b.y).as_vec4().to_array();
        Self {
            clip_from_world: matrix(&(view.clip_from_world * DMat4::from_translation(origin))),
            clip_from_plane: plane.map_or([0.0; 4], |(p, _)| four(p.scale, p.axis)),
            // Up in the plane is up in the picture, texels go down.
            plane_from_texel: plane.map_or([0.0; 4], |(_, texels)| {
                let scale = DVec2::new(1.0, -1.0) / texels.per_unit;
                four(scale, -texels.axis * scale)
            }),
            same: match (view.is_perspective(), linear, plane.is_some()) {
                (false, ..) => [0.0, 1e-7],
                (true, true, _) => [0.0, 1e-6],
                (true, false, false) => [1e-5, 0.0],
                (true, false, true) => [4e-5, 0.0],
            },
            farthest: FARTHEST as f32,
            near: near(view) as f32,
            least_w: least_w(view),
            size: view.size as f32,
            ..Self::default()
        }
    }
}

/// Texels from the map's middle that a rasteriser surely holds: 32 bits with four behind the point,
/// and two to spare.
const FARTHEST_TEXEL: f64 = (1 << 25) as f64;

/// The least |w| of a corner as a share of its |x| or |y|. A corner level with the light has w = 0,
/// and stands infinitely far away in the map.
fn least_w(view: &LightView) -> f32 {
    let is_divided = view.paraboloid.is_none() && view.clip_from_world.row(3).truncate() != DVec3::ZERO;
    if is_divided { (f64::from(view.size) * 0.5 / FARTHEST_TEXEL) as f32 } else { 0.0 }
}
