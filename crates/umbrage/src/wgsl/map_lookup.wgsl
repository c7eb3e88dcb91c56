// Where a receiver lies in the maps of a light, and how the depth there slopes: the one place that bias comes from.

struct MapLookup {
    eye: Eye,
    // Space relative to the eye to texels and stored depth, homogeneous, for each layer.
    map_from_eye: array<mat4x4f, 6>,
    // The same for planes: inverse transposed.
    map_from_eye_plane: array<mat4x4f, 6>,
    // A point light's place relative to the eye; chooses the face of the cube.
    light_eye: vec3f,
    // Texels across and down.
    size: f32,
    // Rounding of stored depth: relative, and absolute.
    rounding: vec2f,
    // Change of stored depth per metre: times the squared depth, and constant.
    per_metre: vec2f,
    // Multiplies the automatic bias.
    bias: f32,
    spare: f32,
    more_spare: vec2f,
}

struct MapPoint {
    // Texels; whole numbers are corners.
    texel: vec2f,
    // Depth that would be stored there.
    depth: f32,
    // Change of depth per texel along the receiver's plane.
    slope: vec2f,
    // How much the depth may be off by rounding.
    rounding: f32,
    layer: u32,
    is_covered: bool,
}

@group(1) @binding(0) var<uniform> map: MapLookup;
@group(1) @binding(1) var map_depth: texture_depth_2d_array;
@group(1) @binding(2) var map_compare: sampler_comparison;

override CUBE: bool = false;

// Texels that the neighbouring surface at a crease may slope against the receiver's plane.
const CREASE: f32 = 0.5;

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

// `rounding`: of the position, metres.
fn map_point(position: vec3f, normal: vec3f, rounding: f32) -> MapPoint {
    var layer = 0u;
    if CUBE {
        layer = face_of_cube(position - map.light_eye);
    }
    let p = map.map_from_eye[layer] * vec4f(position, 1.0);
    let plane = map.map_from_eye_plane[layer] * vec4f(normal, -dot(normal, position));
    var point: MapPoint;
    point.texel = p.xy / p.w;
    point.depth = p.z / p.w;
    // A plane seen edge-on has no slope to speak of; the largest that helps is one that spans the whole depth.
    let steepness = -1.0 / select(plane.z, 1e-30, abs(plane.z) < 1e-30);
    point.slope = clamp(plane.xy * steepness, vec2f(-1.0), vec2f(1.0));
    let z = abs(point.depth);
    let per_metre = map.per_metre.x * z * z + map.per_metre.y;
    point.rounding = map.rounding.x * z + map.rounding.y + rounding * per_metre;
    point.layer = layer;
    point.is_covered = p.w > 0.0 && all(point.texel >= vec2f(0.0)) && all(point.texel < vec2f(map.size));
    return point;
}

// What comparing has to forgive when the compared surface may be `texels` away from the receiver's own place.
fn map_bias(point: MapPoint, texels: f32) -> f32 {
    let slope = abs(point.slope.x) + abs(point.slope.y);
    return map.bias * (texels * slope + point.rounding);
}
