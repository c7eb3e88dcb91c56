// Where a receiver lies in the maps of a light, and how the depth there slopes: the one place that bias comes from.

// One view of the light.
struct MapLayer {
    // Camera's normalised device coordinates to texels and stored depth, homogeneous.
    map_from_ndc: mat4x4f,
    // What the normal of a plane has to do with the change of its stored depth per texel to the right and down, and
    // what that is to be divided by.
    slope_right: vec3f,
    pad_a: f32,
    slope_down: vec3f,
    pad_b: f32,
    slope_axis: vec3f,
    pad_c: f32,
    // How a small way of the receiver's moves its homogeneous texel.
    texel_right: vec3f,
    pad_d: f32,
    texel_down: vec3f,
    pad_e: f32,
    texel_w: vec3f,
    pad_f: f32,
    // Perspective: the texel straight ahead, and the tangent that a texel spans; parallel: the metres it spans.
    axis: vec4f,
}

// The light as a surface. A round one is the image of the unit ball under its half axes, a flat one has two.
struct LightExtent {
    right: vec3f,
    pad: f32,
    up: vec3f,
    pad_a: f32,
    ahead: vec3f,
    pad_b: f32,
    // Take a direction to where a round light is the unit ball, but for a factor. Of a flat light, the last is its normal.
    unit_right: vec3f,
    pad_c: f32,
    unit_up: vec3f,
    pad_d: f32,
    unit_ahead: vec3f,
    pad_e: f32,
}

struct MapLookup {
    eye: Eye,
    layers: array<MapLayer, 6>,
    // Camera's normalised device coordinates to the way from a point light, times w. Chooses the face of a cube.
    from_light: mat4x4f,
    // Rounding of stored depth: relative, and absolute.
    rounding: vec2f,
    // Change of stored depth per metre: times the squared depth, and constant.
    per_metre: vec2f,
    // Texels across and down.
    size: f32,
    // Multiplies the automatic bias.
    bias: f32,
    // How far casters may be off by rounding, metres.
    caster_rounding: f32,
    // Stored depth of the nearest caster there can be.
    nearest: f32,
    light: LightExtent,
}

// What a pixel shows.
struct Pixel {
    at: vec2f,
    depth: f32,
    surface: Surface,
}

struct MapPoint {
    // Texels; whole numbers are corners.
    texel: vec2f,
    // Depth that would be stored there.
    depth: f32,
    // Change of depth per texel along the receiver's plane: `along` over `across`, kept apart to spare a division.
    along: vec2f,
    across: f32,
    // It faces away from the light and throws shadows itself: nothing has to be looked up.
    is_own_shadow: bool,
    // How much the depth may be off by rounding.
    rounding: f32,
    // One over the distance along the axis of a perspective view, else 1.
    inverse_w: f32,
    layer: u32,
    is_covered: bool,
}

@group(1) @binding(0) var<uniform> map: MapLookup;
@group(1) @binding(1) var map_depth: texture_depth_2d_array;
@group(1) @binding(2) var map_compare: sampler_comparison;

// Views from a point, and six of them.
override PERSPECTIVE: bool = false;
// The light is a ball of some kind, else flat.
override ROUND: bool = false;
override CUBE: bool = false;

// Texels that the neighbouring surface at a crease may slope against the receiver's plane.
const CREASE: f32 = 0.5;
// How steeply a surface may rise above the receiver's plane within a wide filter: a tangent.
const BEND: f32 = 0.25;

fn face_of_cube(direction: vec3f) -> u32 {
    let a = abs(direction);
    if a.x >= a.y && a.x >= a.z {
        return select(0u, 1u, direction.x < 0.0);
    }
    if a.y >= a.z {
        return select(2u, 3u, direction.y < 0.0);
    }
    return select(4u, 5u, direction.z < 0.0);
}

// For the surface that a pixel shows.
//
// On a plane with normal n stored depth is linear in the texel, in perspective too, since it is near / distance there.
// With m = (n · right, n · down, n · axis) the plane is m₀ u + m₁ v + m₂ = c · near / depth in perspective, so that its
// slope is depth · (m₀, m₁) / (m₀ u + m₁ v + m₂); for parallel light it is (m₀, m₁) / m₂.
fn map_point(pixel: Pixel) -> MapPoint {
    let surface = pixel.surface;
    let ndc = ndc_of(map.eye, pixel.at, pixel.depth);
    var point: MapPoint;
    point.layer = 0u;
    if CUBE {
        point.layer = face_of_cube((map.from_light * ndc).xyz);
    }
    let p = map.layers[point.layer].map_from_ndc * ndc;
    let inverse_w = 1.0 / p.w;
    point.texel = p.xy * inverse_w;
    point.depth = p.z * inverse_w;
    let right = dot(surface.normal, map.layers[point.layer].slope_right);
    let down = dot(surface.normal, map.layers[point.layer].slope_down);
    point.along = vec2f(right, down);
    point.across = dot(surface.normal, map.layers[point.layer].slope_axis);
    var is_in_front = true;
    var eye_inverse_w = inverse_w;
    point.inverse_w = 1.0;
    if PERSPECTIVE {
        point.across += dot(point.along, point.texel);
        point.along *= point.depth;
        let w = eye_w(map.eye, ndc);
        eye_inverse_w = 1.0 / w;
        point.inverse_w = inverse_w * w;
        is_in_front = inverse_w * eye_inverse_w > 0.0;
    }
    point.is_covered = is_in_front && all(point.texel >= vec2f(0.0)) && all(point.texel < vec2f(map.size));
    // Positive where the surface faces the light; 0 where there is no normal or no view.
    point.is_own_shadow = surface.casts && is_in_front && point.across < 0.0;
    let z = abs(point.depth);
    let metres = position_rounding(map.eye, pixel.depth, eye_inverse_w) + map.caster_rounding;
    let per_metre = map.per_metre.x * z * z + map.per_metre.y;
    point.rounding = map.rounding.x * z + map.rounding.y + metres * per_metre;
    return point;
}

// Change of depth per texel. A plane seen edge-on has no slope to speak of; the largest that helps spans all depth.
fn map_slope(point: MapPoint) -> vec2f {
    let slope = clamp(point.along / point.across, vec2f(-1.0), vec2f(1.0));
    return select(slope, vec2f(0.0), point.across == 0.0);
}

// What comparing has to forgive when the compared surface may be `texels` away from the receiver's own place.
fn map_bias(point: MapPoint, slope: vec2f, texels: f32) -> f32 {
    return map.bias * (texels * (abs(slope.x) + abs(slope.y)) + point.rounding);
}

// How deep a texel is wide.
fn texel_depth(point: MapPoint) -> f32 {
    let axis = map.layers[point.layer].axis;
    return max(axis.z, axis.w) * select(map.per_metre.y, point.depth, PERSPECTIVE);
}

// What comparing `texels` away from the receiver has to forgive besides, since curved surfaces bend away from its plane.
fn map_bend(point: MapPoint, texels: f32) -> f32 {
    return map.bias * BEND * texels * texel_depth(point);
}

// Whether a receiver is lit when `stored` lies `offset` texels away from it: its plane, continued to there, is compared
// with forgiveness for a crease between and for `bend`. All is multiplied by |across|, so that nothing is divided and a plane
// seen edge-on counts as lit.
fn is_lit_beyond(point: MapPoint, offset: vec2f, stored: f32, bend: f32) -> bool {
    let toward = dot(point.along, offset) * sign(point.across);
    let crease = map.bias * CREASE * (abs(point.along.x) + abs(point.along.y));
    return (point.depth + map.bias * point.rounding + bend - stored) * abs(point.across) + toward + crease >= 0.0;
}

fn is_lit(point: MapPoint, offset: vec2f, stored: f32) -> bool {
    return is_lit_beyond(point, offset, stored, 0.0);
}
