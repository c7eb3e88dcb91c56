//! One view of the light as the look-up reads it.

use crate::depth_maps::nearest::nearest;
use crate::depth_maps::texels::{InTexels, axis, matrix, near, texels_from_clip};
use crate::shader::shader_struct;
use umbrage_core::Bounds;
use umbrage_core::glam::{DMat3, DMat4, DVec3, DVec4};
use umbrage_core::light_view::{LightView, Paraboloid};

shader_struct! {
    /// One view of the light, see `map_layers.wgsl`.
    pub(crate) struct MapLayer {
        map_from_place: [[f32; 4]; 4],
        slope_right: [f32; 3],
        per_metre: f32,
        slope_down: [f32; 3],
        nearest: f32,
        slope_axis: [f32; 3],
        border: f32,
        texel_right: [f32; 3],
        pad_d: f32,
        texel_down: [f32; 3],
        pad_e: f32,
        texel_w: [f32; 3],
        pad_f: f32,
        axis: [f32; 4],
        from_first: [f32; 4],
    }
}

impl MapLayer {
    pub fn of(view: &LightView, world_from_place: &DMat4, casters: &[Bounds]) -> Self {
        let border = view.steady_border.unwrap_or(0.0) as f32;
        Self { nearest: nearest(view, casters), border, ..Self::new(view, world_from_place) }
    }

    fn new(view: &LightView, world_from_place: &DMat4) -> Self {
        match &view.paraboloid {
            Some(paraboloid) => Self::paraboloid(view, paraboloid, world_from_place),
            None => Self::matrix(view, world_from_place),
        }
    }

    fn matrix(view: &LightView, world_from_place: &DMat4) -> Self {
        let map_from_world = texels_from_clip(view.size) * view.clip_from_world;
        let slopes = Slopes::of(&map_from_world, view.is_perspective());
        let axis = if view.is_warped() { warp(&map_from_world) } else { axis(&map_from_world) };
        let row = |i| map_from_world.row(i).truncate().as_vec3().to_array();
        Self {
            map_from_place: matrix(&(map_from_world * world_from_place)),
            slope_right: slopes.right.as_vec3().to_array(),
            slope_down: slopes.down.as_vec3().to_array(),
            slope_axis: slopes.axis.as_vec3().to_array(),
            texel_right: row(0),
            texel_down: row(1),
            texel_w: row(3),
            axis: axis.as_vec4().to_array(),
            per_metre: per_metre(view),
            ..Self::default()
        }
    }

    fn paraboloid(view: &LightView, paraboloid: &Paraboloid, world_from_place: &DMat4) -> Self {
        let axes = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * view.clip_from_world;
        let [right, down, ahead] = [0, 1, 3].map(|i| axes.row(i).truncate());
        let InTexels { axis, per_unit } = InTexels::of(view.size, paraboloid);
        let floats = |v: DVec3| v.as_vec3().to_array();
        Self {
            map_from_place: matrix(&(axes * world_from_place)),
            slope_right: floats(right),
            slope_down: floats(down),
            slope_axis: floats(ahead),
            texel_right: floats(right * per_unit.x + ahead * axis.x),
            texel_down: floats(down * per_unit.y + ahead * axis.y),
            texel_w: floats(ahead),
            axis: axis.extend(1.0 / per_unit.x).extend(1.0 / per_unit.y).as_vec4().to_array(),
            per_metre: per_metre(view),
            ..Self::default()
        }
    }
}

/// Of a warped view of parallel light: how w changes with texels times w, across and down.
fn warp(map_from_world: &DMat4) -> DVec4 {
    let [across, down, depth, w] = [0, 1, 2, 3].map(|i| map_from_world.row(i).truncate());
    let inverse = DMat3::from_cols(across, down, depth).inverse();
    (inverse * w).truncate().extend(0.0).extend(0.0)
}

/// What a plane's normal has to do with the slope of its stored depth, see `plane_through` in
/// `map_lookup.wgsl`.
struct Slopes {
    right: DVec3,
    down: DVec3,
    axis: DVec3,
}

impl Slopes {
    fn of(map_from_world: &DMat4, perspective: bool) -> Self {
        let rows = [0, 1, 2, 3].map(|i| map_from_world.row(i).truncate());
        // In perspective texels times w, and w, are linear in p − light; for parallel light texels
        // and depth are in p.
        let last = if perspective { rows[3] } else { rows[2] };
        let inverse = DMat3::from_cols(rows[0], rows[1], last).inverse();
        let axis = inverse.row(2);
        // Any common factor will do: it cancels. Its sign makes n · axis positive for a plane that
        // faces the light.
        let scale = 1.0 / axis.length().max(f64::MIN_POSITIVE);
        let toward_light = if perspective { -scale } else { scale };
        Self { right: inverse.row(0) * -scale, down: inverse.row(1) * -scale, axis: axis * toward_light }
    }
}

/// How depth changes per metre along the light: perspective depth is near / distance, so its
/// derivative is depth² / near; that of parallel depth is constant, in warped views times w.
fn per_metre(view: &LightView) -> f32 {
    if view.is_perspective() {
        return (1.0 / near(view)) as f32;
    }
    let [across, up, depth] = [0, 1, 2].map(|i| view.clip_from_world.row(i).truncate());
    depth.dot(across.cross(up).normalize_or_zero()).abs() as f32
}
