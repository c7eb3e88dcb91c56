// Where a receiver lies in the maps of a light, and how the depth there slopes: the one place that bias comes from.

// One view of the light.
struct MapLayer {
    // Camera's normalised device coordinates to texels and stored depth, homogeneous.
    map_from_ndc: mat4x4f,
    // What the normal of a plane has to do with the change of its stored depth per texel to the right and down.
    slope_right: vec3f,
    spare: f32,
    slope_down: vec3f,
    more_spare: f32,
}

struct MapLookup {
    eye: Eye,
    layers: array<MapLayer, 6>,
    // Camera's normalised device coordinates to the way from a point light, times w. Chooses the face of a cube.
    from_light: mat4x4f,
    // For parallel light: the axis that depth falls along, in its scale.
    axis: vec3f,
    // Texels across and down.
    size: f32,
    // Rounding of stored depth: relative, and absolute.
    rounding: vec2f,
    // Change of stored depth per metre: times the squared depth, and constant.
    per_metre: vec2f,
    // Multiplies the automatic bias.
    bias: f32,
    pad_a: f32,
    pad_b: vec2f,
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

// Views from a point, and six of them.
override PERSPECTIVE: bool = false;
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

// For the surface with `normal` (either side, any length) that pixel `at` shows at `depth`.
//
// On a plane with normal n stored depth is linear in the texel, in perspective too, since it is near / distance there:
// its slope is the ratio of n's share along a texel step to n · (p − light), or to n · axis for parallel light.
fn map_point(at: vec2f, depth: f32, normal: vec3f) -> MapPoint {
    let ndc = ndc_of(map.eye, at, depth);
    var layer = 0u;
    var across = 0.0;
    var w = 0.0;
    if PERSPECTIVE {
        let from_light = map.from_light * ndc;
        w = from_light.w;
        across = dot(normal, from_light.xyz) / w;
        if CUBE {
            layer = face_of_cube(from_light.xyz);
        }
    } else {
        across = dot(normal, map.axis);
    }
    let p = map.layers[layer].map_from_ndc * ndc;
    let inverse_w = 1.0 / p.w;
    if !PERSPECTIVE {
        w = p.w;
    }
    var point: MapPoint;
    point.texel = p.xy * inverse_w;
    point.depth = p.z * inverse_w;
    let along = vec2f(dot(normal, map.layers[layer].slope_right), dot(normal, map.layers[layer].slope_down));
    // A plane seen edge-on has no slope to speak of; the largest that helps is one that spans the whole depth.
    point.slope = clamp(along / across, vec2f(-1.0), vec2f(1.0));
    let z = abs(point.depth);
    let per_metre = map.per_metre.x * z * z + map.per_metre.y;
    point.rounding = map.rounding.x * z + map.rounding.y + position_rounding(map.eye, depth, w) * per_metre;
    point.layer = layer;
    let inside = all(point.texel >= vec2f(0.0)) && all(point.texel < vec2f(map.size));
    point.is_covered = inside && p.w * w > 0.0;
    return point;
}

// What comparing has to forgive when the compared surface may be `texels` away from the receiver's own place.
fn map_bias(point: MapPoint, texels: f32) -> f32 {
    let slope = abs(point.slope.x) + abs(point.slope.y);
    return map.bias * (texels * slope + point.rounding);
}
