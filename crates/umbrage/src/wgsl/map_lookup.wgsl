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
    // How a small way of the receiver's moves its homogeneous texel. Of a paraboloid, its axes are in `slope_right`, `slope_down` and
    // `slope_axis`, and this lacks what the change of the distance adds, see `texel_change`.
    texel_right: vec3f,
    pad_d: f32,
    texel_down: vec3f,
    pad_e: f32,
    texel_w: vec3f,
    pad_f: f32,
    // Perspective: the texel straight ahead, and the tangent that a texel spans, of a paraboloid what it spans of its plane. Parallel: the
    // metres that it spans.
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
    // Camera's normalised device coordinates to the way from a point light, times w. Chooses the layer.
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
    // Depth of the nearest caster there can be; from a point, near / distance.
    nearest: f32,
    // Depth that linear maps store as 0.
    farthest: f32,
    pad_a: f32,
    pad_b: f32,
    pad_c: f32,
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
    // near / distance, or what is left of a parallel view: the depth that projective maps would store there.
    depth: f32,
    // Change of depth per texel along the receiver's plane: `along` over `across`, kept apart to spare a division.
    along: vec2f,
    across: f32,
    // Of a paraboloid: what bends that, see `plane_step`.
    bend: f32,
    // It faces away from the light and throws shadows itself: nothing has to be looked up.
    is_own_shadow: bool,
    // How much the depth may be off by rounding.
    rounding: f32,
    // One over the homogeneous texel's last coordinate, the distance along the axis of a perspective view; else 1.
    inverse_w: f32,
    layer: u32,
    is_covered: bool,
}

@group(1) @binding(0) var<uniform> map: MapLookup;
@group(1) @binding(1) var map_depth: texture_depth_2d_array;
@group(1) @binding(2) var map_compare: sampler_comparison;

// Views from a point.
override PERSPECTIVE: bool = false;
// The light is a ball of some kind, else flat.
override ROUND: bool = false;

// Which layer a receiver is in.
override LAYOUT: u32 = 0u;
const SINGLE: u32 = 0u;
const CUBE: u32 = 1u;
const TETRAHEDRON: u32 = 2u;
const PARABOLOIDS: u32 = 3u;

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

// One axis is straight down, three look up a little, the first of these along x.
fn face_of_tetrahedron(direction: vec3f) -> u32 {
    let up = direction.y / 3.0;
    let back = vec2f(-0.47140452, 0.81649658);
    let along = vec3f(0.94280904 * direction.x, dot(back, direction.xz), dot(back, vec2f(direction.x, -direction.z))) + up;
    let most = max(along.x, max(along.y, along.z));
    if -direction.y >= most {
        return 0u;
    }
    return select(select(3u, 2u, along.y == most), 1u, along.x == most);
}

fn layer_of(direction: vec3f) -> u32 {
    switch LAYOUT {
        case CUBE: {
            return face_of_cube(direction);
        }
        case TETRAHEDRON: {
            return face_of_tetrahedron(direction);
        }
        case PARABOLOIDS: {
            return select(0u, 1u, direction.y > 0.0);
        }
        default: {
            return 0u;
        }
    }
}

// What a map holds, as the depth of a receiver there.
fn load_depth(texel: vec2i, layer: u32) -> f32 {
    return depth_of(textureLoad(map_depth, texel, layer, 0), map.farthest);
}

// What hardware compares with the map.
fn reference_of(depth: f32) -> f32 {
    return stored_of(max(depth, 0.0), map.farthest);
}

// A plane as the map sees it: `along` and `bend` over `across` are the change of its depth around the receiver.
struct MapPlane {
    along: vec2f,
    across: f32,
    bend: f32,
}

// Through a point whose texel and depth are known.
//
// On a plane with normal n depth is linear in the texel, in perspective too, since it is near / distance there.
// With m = (n · right, n · down, n · axis) the plane is m₀ u + m₁ v + m₂ = c · near / depth in perspective, so that its
// slope is depth · (m₀, m₁) / (m₀ u + m₁ v + m₂); for parallel light it is (m₀, m₁) / m₂.
//
// A place q in a paraboloid's plane is the unit way (2q, 1 − q²) / (1 + q²), and depth is proportional to n times that.
fn plane_through(point: MapPoint, normal: vec3f) -> MapPlane {
    let layer = point.layer;
    let m = vec2f(dot(normal, map.layers[layer].slope_right), dot(normal, map.layers[layer].slope_down));
    var plane = MapPlane(m, dot(normal, map.layers[layer].slope_axis), 0.0);
    if LAYOUT == PARABOLOIDS {
        let q = plane_place(point);
        let inverse = 1.0 / (1.0 + dot(q, q));
        let ahead = plane.across;
        plane.across = -(2.0 * dot(m, q) + ahead * (1.0 - dot(q, q))) * inverse;
        let scale = point.depth * inverse;
        plane.bend = scale * (ahead - plane.across);
        plane.along = -2.0 * (scale * m - plane.bend * q) * map.layers[layer].axis.zw;
    } else if PERSPECTIVE {
        plane.across += dot(m, point.texel);
        plane.along *= point.depth;
    }
    return plane;
}

// Where a receiver is in the paraboloid's plane.
fn plane_place(point: MapPoint) -> vec2f {
    let axis = map.layers[point.layer].axis;
    return (point.texel - axis.xy) * axis.zw;
}

// Change of a plane's depth `offset` texels away, times its `across`.
fn plane_step(point: MapPoint, along: vec2f, bend: f32, offset: vec2f) -> f32 {
    let step = dot(along, offset);
    if LAYOUT == PARABOLOIDS {
        let q = plane_place(point);
        let way = offset * map.layers[point.layer].axis.zw;
        let square = dot(way, way);
        return (step + bend * square) / (1.0 + (2.0 * dot(q, way) + square) / (1.0 + dot(q, q)));
    }
    return step;
}

// How a small way of the receiver's moves its homogeneous texel; `unit` is the unit way to it from the light.
fn texel_change(layer: u32, way: vec3f, unit: vec3f) -> vec3f {
    let change = vec3f(
        dot(map.layers[layer].texel_right, way),
        dot(map.layers[layer].texel_down, way),
        dot(map.layers[layer].texel_w, way),
    );
    if LAYOUT == PARABOLOIDS {
        return change + vec3f(map.layers[layer].axis.xy, 1.0) * dot(unit, way);
    }
    return change;
}

// For the surface that a pixel shows.
fn map_point(pixel: Pixel) -> MapPoint {
    let surface = pixel.surface;
    let ndc = ndc_of(map.eye, pixel.at, pixel.depth);
    var point: MapPoint;
    point.layer = 0u;
    if LAYOUT != SINGLE {
        point.layer = layer_of((map.from_light * ndc).xyz);
    }
    let p = map.layers[point.layer].map_from_ndc * ndc;
    var inverse_w = 1.0 / p.w;
    if LAYOUT == PARABOLOIDS {
        let distance = length(p.xyw);
        let axis = map.layers[point.layer].axis;
        inverse_w = 1.0 / (distance + p.w);
        point.texel = axis.xy + p.xy * inverse_w / axis.zw;
        point.depth = p.z / distance;
    } else {
        point.texel = p.xy * inverse_w;
        point.depth = p.z * inverse_w;
    }
    var is_in_front = true;
    var eye_inverse_w = inverse_w;
    point.inverse_w = 1.0;
    if PERSPECTIVE {
        let w = eye_w(map.eye, ndc);
        eye_inverse_w = 1.0 / w;
        point.inverse_w = inverse_w * w;
        is_in_front = inverse_w * eye_inverse_w > 0.0;
    }
    let plane = plane_through(point, surface.normal);
    point.along = plane.along;
    point.across = plane.across;
    point.bend = plane.bend;
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

// Depth of the receiver's plane `offset` texels away, by its slope.
fn depth_along(point: MapPoint, slope: vec2f, offset: vec2f) -> f32 {
    if LAYOUT == PARABOLOIDS {
        let bend = select(point.bend / point.across, 0.0, point.across == 0.0);
        return point.depth + plane_step(point, slope, bend, offset);
    }
    return point.depth + dot(slope, offset);
}

// What comparing has to forgive when the compared surface may be `texels` away from the receiver's own place.
fn map_bias(point: MapPoint, slope: vec2f, texels: f32) -> f32 {
    return map.bias * (texels * (abs(slope.x) + abs(slope.y)) + point.rounding);
}

// How deep a texel is wide.
fn texel_depth(point: MapPoint) -> f32 {
    let axis = map.layers[point.layer].axis;
    let wide = max(axis.z, axis.w) * select(map.per_metre.y, point.depth, PERSPECTIVE);
    if LAYOUT == PARABOLOIDS {
        let q = plane_place(point);
        return 2.0 * wide / (1.0 + dot(q, q));
    }
    return wide;
}

// What comparing `texels` away from the receiver has to forgive besides, since curved surfaces bend away from its plane.
fn map_bend(point: MapPoint, texels: f32) -> f32 {
    return map.bias * BEND * texels * texel_depth(point);
}

// Whether a receiver is lit when the depth `stored` lies `offset` texels away from it: its plane, continued to there, is compared
// with forgiveness for a crease between and for `bend`. All is multiplied by |across|, so that nothing is divided and a plane
// seen edge-on counts as lit.
fn is_lit_beyond(point: MapPoint, offset: vec2f, stored: f32, bend: f32) -> bool {
    let toward = plane_step(point, point.along, point.bend, offset) * sign(point.across);
    let crease = map.bias * CREASE * (abs(point.along.x) + abs(point.along.y));
    return (point.depth + map.bias * point.rounding + bend - stored) * abs(point.across) + toward + crease >= 0.0;
}

fn is_lit(point: MapPoint, offset: vec2f, stored: f32) -> bool {
    return is_lit_beyond(point, offset, stored, 0.0);
}
