//! What the shader that looks maps up has to know: the eye, the views and the light's extent.

use super::extent::{LightExtent, nearest};
use super::views::LAYER_CONSTANTS;
use super::{DepthMaps, MOST_LAYERS};
use crate::{receivers::Eye, shader::Shared, shader::shader_struct, view::View};
use umbrage_core::Bounds;
use umbrage_core::glam::{DMat3, DMat4, DVec2, DVec3, DVec4};
use umbrage_core::light_view::{FARTHEST, LightView, Paraboloid};

shader_struct! {
    /// What the shaders that draw a map need, see `draw/map_depth.wgsl`.
    pub(crate) struct MapView {
        clip_from_world: [[f32; 4]; 4],
        clip_from_plane: [f32; 4],
        plane_from_texel: [f32; 4],
        same: [f32; 2],
        farthest: f32,
        near: f32,
    }
}

shader_struct! {
    /// One view of the light, see `lookup/map_layers.wgsl`.
    pub(crate) struct MapLayer {
        map_from_ndc: [[f32; 4]; 4],
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

shader_struct! {
    /// See `lookup/map_layers.wgsl`.
    pub(crate) struct MapLookup {
        eye: Eye,
        layers: [MapLayer; MOST_LAYERS],
        from_light: [[f32; 4]; 4],
        rounding: [f32; 2],
        size: f32,
        bias: f32,
        caster_rounding: f32,
        farthest: f32,
        last_split: f32,
        softness: f32,
        view_distance: [f32; 4],
        splits: [[f32; 4]; 2],
        blends: [[f32; 4]; 2],
        light: LightExtent,
    }
}

/// What the host has to agree on with `map_depth.wgsl` and `map_layers.wgsl`.
pub(super) const SHARED: [Shared; 2] = [
    Shared { module: "map_depth", layouts: &[MapView::LAYOUT], constants: &[] },
    Shared {
        module: "map_layers",
        layouts: &[MapLayer::LAYOUT, LightExtent::LAYOUT, MapLookup::LAYOUT],
        constants: LAYER_CONSTANTS,
    },
];

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
        }
    }
}

impl MapLookup {
    /// For the maps of this frame; `bias` multiplies the automatic one.
    pub(super) fn new(view: &View<'_>, maps: &DepthMaps, bias: f64) -> Self {
        let eye_from_ndc = view.clip_from_eye().inverse();
        // A layer that was not rendered sends every point outside of the map, where all is lit.
        let outside = DMat4::from_cols(DVec4::ZERO, DVec4::ZERO, DVec4::ZERO, DVec4::new(-1.0, -1.0, 0.0, 1.0));
        let mut layers = [MapLayer { map_from_ndc: matrix(&outside), ..MapLayer::default() }; MOST_LAYERS];
        let world_from_ndc = DMat4::from_translation(view.camera.eye) * eye_from_ndc;
        for v in &maps.views {
            layers[v.layer as usize] = MapLayer::of(v, &world_from_ndc, &maps.scene.casters);
        }
        super::steady::share_first(&maps.views, &mut layers);
        let center = view.light.shape.center();
        let from_light = DMat4::from_translation(view.camera.eye * center.w - center.truncate()) * eye_from_ndc;
        Self {
            eye: Eye::new(view),
            layers,
            from_light: matrix(&from_light),
            size: maps.size as f32,
            rounding: rounding(maps),
            bias: bias as f32,
            caster_rounding: (maps.largest_coordinate(view) * 2.4e-7 + storage_rounding(maps)) as f32,
            farthest: FARTHEST as f32,
            softness: maps.choice.softness_m() as f32,
            light: LightExtent::of(&view.light.shape),
            ..Self::splits(view, maps, &eye_from_ndc)
        }
    }
}

impl MapLookup {
    /// What chooses the split of a pixel.
    fn splits(view: &View<'_>, maps: &DepthMaps, eye_from_ndc: &DMat4) -> Self {
        let [mut splits, mut blends] = [[f32::MAX; MOST_LAYERS - 1]; 2];
        for (i, ends) in
            maps.borders.windows(2).take(maps.borders.len().saturating_sub(2)).enumerate().take(MOST_LAYERS - 1)
        {
            splits[i] = ends[1] as f32;
            blends[i] = (ends[1] - maps.choice.overlap() * (ends[1] - ends[0])) as f32;
        }
        let halves = |v: [f32; MOST_LAYERS - 1]| [[v[0], v[1], v[2], v[3]], [v[4], v[5], v[6], v[7]]];
        Self {
            splits: halves(splits),
            blends: halves(blends),
            last_split: maps.borders.last().map_or(f32::MAX, |last| *last as f32),
            view_distance: view_distance(view, eye_from_ndc),
            ..Self::default()
        }
    }
}

impl MapLayer {
    pub(super) fn of(view: &LightView, world_from_ndc: &DMat4, casters: &[Bounds]) -> Self {
        let border = view.steady_border.unwrap_or(0.0) as f32;
        Self { nearest: nearest(view, casters), border, ..Self::new(view, world_from_ndc) }
    }

    fn new(view: &LightView, world_from_ndc: &DMat4) -> Self {
        match &view.paraboloid {
            Some(paraboloid) => Self::paraboloid(view, paraboloid, world_from_ndc),
            None => Self::matrix(view, world_from_ndc),
        }
    }

    fn matrix(view: &LightView, world_from_ndc: &DMat4) -> Self {
        let map_from_world = texels_from_clip(view.size) * view.clip_from_world;
        let slopes = Slopes::of(&map_from_world, view.is_perspective());
        let axis = if view.is_warped() { warp(&map_from_world) } else { axis(&map_from_world) };
        let row = |i| map_from_world.row(i).truncate().as_vec3().to_array();
        Self {
            map_from_ndc: matrix(&(map_from_world * world_from_ndc)),
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

    fn paraboloid(view: &LightView, paraboloid: &Paraboloid, world_from_ndc: &DMat4) -> Self {
        let axes = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * view.clip_from_world;
        let [right, down, ahead] = [0, 1, 3].map(|i| axes.row(i).truncate());
        let InTexels { axis, per_unit } = InTexels::of(view.size, paraboloid);
        let floats = |v: DVec3| v.as_vec3().to_array();
        Self {
            map_from_ndc: matrix(&(axes * world_from_ndc)),
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

/// Where a paraboloid's plane is in its map.
#[derive(Clone, Copy)]
struct InTexels {
    /// The texel of the axis.
    axis: DVec2,
    /// Texels per unit of the plane, across and down.
    per_unit: DVec2,
}

impl InTexels {
    fn of(size: u32, paraboloid: &Paraboloid) -> Self {
        let half = f64::from(size) * 0.5;
        let down = DVec2::new(1.0, -1.0);
        Self { axis: (DVec2::ONE + paraboloid.axis * down) * half, per_unit: paraboloid.scale * half }
    }
}

/// Of a view from a point: the texel straight ahead, and what a texel spans of the plane, that at distance 1 ahead or a
/// paraboloid's.
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

/// Of a perspective view the texel straight ahead and the tangent that a texel spans, of a parallel one the metres it spans.
fn axis(map_from_world: &DMat4) -> DVec4 {
    let [across, down, ahead] = [0, 1, 3].map(|i| map_from_world.row(i).truncate());
    let straight = DVec2::new(across.dot(ahead), down.dot(ahead));
    let per_texel = |row: DVec3, straight: f64| 1.0 / (row - ahead * straight).length().max(f64::MIN_POSITIVE);
    straight.extend(per_texel(across, straight.x)).extend(per_texel(down, straight.y))
}

/// Of a warped view of parallel light: how w changes with texels times w, across and down.
fn warp(map_from_world: &DMat4) -> DVec4 {
    let [across, down, depth, w] = [0, 1, 2, 3].map(|i| map_from_world.row(i).truncate());
    let inverse = DMat3::from_cols(across, down, depth).inverse();
    (inverse * w).truncate().extend(0.0).extend(0.0)
}

/// What a plane's normal has to do with the slope of its stored depth, see `plane_through` in `lookup/map_lookup.wgsl`.
struct Slopes {
    right: DVec3,
    down: DVec3,
    axis: DVec3,
}

impl Slopes {
    fn of(map_from_world: &DMat4, perspective: bool) -> Self {
        let rows = [0, 1, 2, 3].map(|i| map_from_world.row(i).truncate());
        // In perspective texels times w, and w, are linear in p − light; for parallel light texels and depth are in p.
        let last = if perspective { rows[3] } else { rows[2] };
        let inverse = DMat3::from_cols(rows[0], rows[1], last).inverse();
        let axis = inverse.row(2);
        // Any common factor will do: it cancels. Its sign makes n · axis positive for a plane that faces the light.
        let scale = 1.0 / axis.length().max(f64::MIN_POSITIVE);
        let toward_light = if perspective { -scale } else { scale };
        Self { right: inverse.row(0) * -scale, down: inverse.row(1) * -scale, axis: axis * toward_light }
    }
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

/// How depth changes per metre along the light: perspective depth is near / distance, so its derivative is
/// depth² / near; that of parallel depth is constant.
fn per_metre(view: &LightView) -> f32 {
    let change = if view.is_perspective() { 1.0 / near(view) } else { view.clip_from_world.row(2).truncate().length() };
    change as f32
}

/// Depth 0…1 in single precision; perspective depth keeps its relative precision, parallel depth does not. In a
/// paraboloid each texel's depth comes from differences between neighbours, which round more.
fn rounding(maps: &DepthMaps) -> [f32; 2] {
    match maps.views.first() {
        Some(view) if view.paraboloid.is_some() => [2e-5, 0.0],
        Some(view) if view.is_perspective() => [2e-6, 0.0],
        _ => [0.0, 1e-6],
    }
}

/// What storing a linear depth rounds, metres: the same at every distance.
fn storage_rounding(maps: &DepthMaps) -> f64 {
    let view = maps.views.first().filter(|view| maps.linear && view.is_perspective());
    view.map_or(0.0, |view| 1e-6 * near(view) / FARTHEST)
}
