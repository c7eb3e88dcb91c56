//! What the shader that looks maps up has to know: the eye, the views and the light's extent.

use super::DepthMaps;
use crate::{shader::shader_struct, view::View};
use umbrage_core::glam::{DMat3, DMat4, DVec2, DVec3, DVec4};
use umbrage_core::{Frustum, LightShape, light_view::LightView};

shader_struct! {
    /// How to get from a pixel to the surface it shows.
    pub(crate) struct Eye {
        eye_from_ndc: [[f32; 4]; 4],
        ndc_from_pixel: [f32; 2],
        background_depth: f32,
        reach: f32,
    }
}

shader_struct! {
    /// One view of the light, see `wgsl/map_lookup.wgsl`.
    pub(crate) struct MapLayer {
        map_from_ndc: [[f32; 4]; 4],
        slope_right: [f32; 3],
        pad_a: f32,
        slope_down: [f32; 3],
        pad_b: f32,
        slope_axis: [f32; 3],
        pad_c: f32,
        texel_right: [f32; 3],
        pad_d: f32,
        texel_down: [f32; 3],
        pad_e: f32,
        texel_w: [f32; 3],
        pad_f: f32,
        axis: [f32; 4],
    }
}

shader_struct! {
    /// The light as a surface, see `wgsl/map_lookup.wgsl`.
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

shader_struct! {
    /// See `wgsl/map_lookup.wgsl`.
    pub(crate) struct MapLookup {
        eye: Eye,
        layers: [MapLayer; 6],
        from_light: [[f32; 4]; 4],
        rounding: [f32; 2],
        per_metre: [f32; 2],
        size: f32,
        bias: f32,
        caster_rounding: f32,
        nearest: f32,
        light: LightExtent,
    }
}

/// Host structs of a lookup shader.
pub(crate) const LOOKUP_LAYOUTS: &[crate::shader::HostLayout] =
    &[Eye::LAYOUT, MapLayer::LAYOUT, LightExtent::LAYOUT, MapLookup::LAYOUT];

/// Host structs of a lookup shader with taps.
pub(crate) const TAP_LAYOUTS: &[crate::shader::HostLayout] =
    &[Eye::LAYOUT, MapLayer::LAYOUT, LightExtent::LAYOUT, MapLookup::LAYOUT, super::taps::TapsHead::LAYOUT];

impl Eye {
    /// For the camera and size of `view`.
    pub(crate) fn new(view: &View<'_>) -> Self {
        let (width, height) = view.receivers.size;
        let eye_from_ndc = view.clip_from_eye().inverse();
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let ends = corners.into_iter().flat_map(|(x, y)| [0.0, 1.0].map(|z| eye_from_ndc * DVec4::new(x, y, z, 1.0)));
        Self {
            reach: ends.map(|p| p.truncate().abs().element_sum()).fold(0.0, f64::max) as f32,
            eye_from_ndc: eye_from_ndc.as_mat4().to_cols_array_2d(),
            ndc_from_pixel: [2.0 / width as f32, -2.0 / height as f32],
            background_depth: view.camera.background_depth(),
        }
    }
}

impl MapLookup {
    /// For the maps of this frame; `bias` multiplies the automatic one.
    pub(super) fn new(view: &View<'_>, maps: &DepthMaps, bias: f64) -> Self {
        let eye_from_ndc = view.clip_from_eye().inverse();
        // A layer that was not rendered sends every point outside of the map, where all is lit.
        let outside = DMat4::from_cols(DVec4::ZERO, DVec4::ZERO, DVec4::ZERO, DVec4::new(-1.0, -1.0, 0.0, 1.0));
        let mut layers = [MapLayer { map_from_ndc: matrix(&outside), ..MapLayer::default() }; 6];
        let map_from_ndc = DMat4::from_translation(view.camera.eye) * eye_from_ndc;
        for v in &maps.views {
            let map_from_world = texels_from_clip(v.size) * v.clip_from_world;
            layers[v.layer as usize] = MapLayer::new(&map_from_world, &map_from_ndc, maps.is_perspective(v));
        }
        let center = view.light.shape.center();
        let from_light = DMat4::from_translation(view.camera.eye * center.w - center.truncate()) * eye_from_ndc;
        Self {
            eye: Eye::new(view),
            layers,
            from_light: matrix(&from_light),
            size: maps.size as f32,
            // Depth 0…1 in single precision; perspective depth keeps its relative precision, parallel depth does not.
            rounding: if maps.from_a_point() { [2e-6, 0.0] } else { [0.0, 1e-6] },
            per_metre: per_metre(maps),
            bias: bias as f32,
            caster_rounding: (maps.largest_coordinate(view) * 2.4e-7) as f32,
            nearest: nearest(maps),
            light: LightExtent::of(&view.light.shape),
        }
    }
}

impl MapLayer {
    fn new(map_from_world: &DMat4, world_from_ndc: &DMat4, perspective: bool) -> Self {
        let slopes = Slopes::of(map_from_world, perspective);
        let row = |i| map_from_world.row(i).truncate().as_vec3().to_array();
        Self {
            map_from_ndc: matrix(&(map_from_world * world_from_ndc)),
            slope_right: slopes.right.as_vec3().to_array(),
            slope_down: slopes.down.as_vec3().to_array(),
            slope_axis: slopes.axis.as_vec3().to_array(),
            texel_right: row(0),
            texel_down: row(1),
            texel_w: row(3),
            axis: axis(map_from_world).as_vec4().to_array(),
            ..Self::default()
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

/// Narrowest half axis of a round light over its widest: what is flatter than that has no direction of its own.
const FLATTEST: f64 = 1e-4;

impl LightExtent {
    fn of(shape: &LightShape) -> Self {
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

/// How many texels around a receiver's own place may show what hides the light's rim from it: the light's size seen from the
/// nearest caster in front of the farthest receiver.
pub(super) fn light_border(light: &LightShape, maps: &DepthMaps) -> f64 {
    let radius = match *light {
        LightShape::Directional { angle_deg, .. } => (angle_deg * 0.5).to_radians().clamp(0.0, 1.5).tan(),
        ref shape => shape.radius(),
    };
    let nearest = f64::from(nearest(maps));
    let texels = |view: &LightView| {
        let map_from_world = texels_from_clip(view.size) * view.clip_from_world;
        let per_metre = map_from_world.row(0).truncate().length().max(map_from_world.row(1).truncate().length());
        let depth = view.clip_from_world.row(2);
        // In perspective `near / depth` is the distance, and what is at distance d shows 1 / d as many texels a metre.
        if maps.is_perspective(view) {
            per_metre * nearest / depth.w
        } else {
            per_metre * nearest / depth.truncate().length()
        }
    };
    radius * maps.views.iter().map(texels).fold(0.0, f64::max)
}

/// The largest depth that a map can hold, from the boxes around the casters.
fn nearest(maps: &DepthMaps) -> f32 {
    let mut points = Vec::new();
    let mut deepest = 0.0_f64;
    for view in &maps.views {
        let depth = |p: DVec3| {
            let clip = view.clip_from_world * p.extend(1.0);
            if clip.w > clip.z { clip.z / clip.w } else { 1.0 }
        };
        let behind = |p: &DVec3| (view.clip_from_world * p.extend(1.0)).w <= 0.0;
        for bounds in &maps.scene.casters {
            // A box that is partly behind a point light's view: what of it is in front.
            let corners = bounds.corners();
            points.clear();
            match corners.iter().filter(|c| behind(c)).count() {
                0 => points.extend(corners),
                8 => {}
                _ => Frustum::of(&view.clip_from_world).clip_box(bounds, &mut points),
            }
            deepest = points.iter().map(|p| depth(*p)).fold(deepest, f64::max);
        }
    }
    deepest.min(1.0) as f32
}

/// What a plane's normal has to do with the slope of its stored depth, see `map_point` in `wgsl/map_lookup.wgsl`.
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
fn texels_from_clip(size: u32) -> DMat4 {
    let half = f64::from(size) * 0.5;
    DMat4::from_cols(
        DVec4::new(half, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -half, 0.0, 0.0),
        DVec4::Z,
        DVec4::new(half, half, 0.0, 1.0),
    )
}

fn matrix(m: &DMat4) -> [[f32; 4]; 4] {
    m.as_mat4().to_cols_array_2d()
}

/// How stored depth changes per metre along the light: perspective depth is near / distance, so its derivative is
/// depth² / near; that of parallel depth is constant.
fn per_metre(maps: &DepthMaps) -> [f32; 2] {
    let Some(view) = maps.views.first() else { return [0.0; 2] };
    let depth = view.clip_from_world.row(2);
    if maps.is_perspective(view) { [(1.0 / depth.w) as f32, 0.0] } else { [0.0, depth.truncate().length() as f32] }
}
