// needs: eye, map_storage
// The maps of a light: group 1, which layer a receiver is in, and what depth a map holds.

// One view of the light.
struct MapLayer {
    // A receiver's place, see `Pixel`, to texels and stored depth, homogeneous.
    map_from_place: mat4x4f,
    // What the normal of a plane has to do with the change of its stored depth per texel to the
    // right and down, and what that is to be divided by.
    slope_right: vec3f,
    // Change of stored depth per metre: of parallel views; in perspective, times the squared depth.
    per_metre: f32,
    slope_down: vec3f,
    // Depth of the nearest caster there can be; from a point, near / distance.
    nearest: f32,
    slope_axis: vec3f,
    // Of a split that stands still: texels along its borders that are for filters alone. Else 0.
    border: f32,
    // How a small way of the receiver's moves its homogeneous texel. Of a paraboloid, its axes are
    // in `slope_right`, `slope_down` and `slope_axis`, and this lacks what the change of the
    // distance adds, see `texel_change`.
    texel_right: vec3f,
    pad_d: f32,
    texel_down: vec3f,
    pad_e: f32,
    texel_w: vec3f,
    pad_f: f32,
    // Perspective: the texel straight ahead, and the tangent that a texel spans, of a paraboloid
    // what it spans of its plane. Parallel: the metres that it spans. Warped: how w changes with
    // texels times w, across and down.
    axis: vec4f,
    // Of a split that stands still: its texels are those of layer 0's matrix times x, plus zw; y is
    // one over x.
    from_first: vec4f,
}

// The light as a surface. A round one is the image of the unit sphere under its half axes, a flat
// one has two.
struct LightExtent {
    right: vec3f,
    pad: f32,
    up: vec3f,
    pad_a: f32,
    ahead: vec3f,
    pad_b: f32,
    // Take a direction to where a round light is the unit sphere, but for a factor. Of a flat
    // light, the last is its normal.
    unit_right: vec3f,
    pad_c: f32,
    unit_up: vec3f,
    pad_d: f32,
    unit_ahead: vec3f,
    pad_e: f32,
}

// Most layers of a light.
const MOST_LAYERS: u32 = 9u;
// Room for those of two points, the second one's from the middle on.
const LOOKUP_LAYERS: u32 = 12u;

struct MapLookup {
    eye: Eye,
    // From positions relative to the eye, for `map_inline`.
    ndc_from_eye: mat4x4f,
    layers: array<MapLayer, LOOKUP_LAYERS>,
    // A receiver's place to the way from the light's centre, or along parallel light, times w.
    // Chooses the layer.
    from_light: mat4x4f,
    // Rounding of stored depth: relative, and absolute.
    rounding: vec2f,
    // Texels across and down.
    size: f32,
    // Multiplies the automatic bias.
    bias: f32,
    // How far casters may be off by rounding, metres.
    caster_rounding: f32,
    // Depth that linear maps store as 0.
    farthest: f32,
    // Distance along the view beyond which no split goes.
    last_split: f32,
    // Radius of filters, metres; 0 where it is in texels.
    softness: f32,
    // Offsets tuned by hand: along the light, metres; and the rise over so many texels.
    offsets: vec2f,
    // 1 where the outlines of all casters are edges of triangles, 0 where there are alpha masks.
    outlined: f32,
    // Pixels by which the noise of taps is shifted in this frame: across, and 64 times those down.
    jitter: f32,
    // Takes a receiver's place to the distance along the view, times w.
    view_distance: vec4f,
    // Distances at which splits end, and at which blending with the next one begins.
    splits: array<vec4f, 2>,
    blends: array<vec4f, 2>,
    light: LightExtent,
}

@group(1) @binding(0) var<uniform> map: MapLookup;
@group(1) @binding(1) var map_depth: texture_depth_2d_array;
@group(1) @binding(2) var map_compare: sampler_comparison;

// Views from a point.
override PERSPECTIVE: bool = false;
// Views of parallel light whose texels are not all of one size.
override WARPED: bool = false;
// The light is a sphere of some kind, else flat.
override ROUND: bool = false;

// Which layer a receiver is in.
override LAYOUT: u32 = 0u;
const SINGLE: u32 = 0u;
const CUBE: u32 = 1u;
const TETRAHEDRON: u32 = 2u;
const PARABOLOIDS: u32 = 3u;
const SPLITS: u32 = 4u;
const SIDES: u32 = 5u;

// How many layers there may be; sizes the search for a split.
override LAYERS: u32 = MOST_LAYERS;
// Splits stand still while the camera moves.
override STEADY: bool = false;

// Offsets are tuned by hand: a constant, and one by the receiver's slope.
override CLASSIC: bool = false;

// How a split is blended with the next one: at once, pixel by pixel, or by mixing both.
override BLEND: u32 = 0u;
const DITHER: u32 = 1u;
const LERP: u32 = 2u;

// A pixel's layer.
struct Split {
    layer: u32,
    // Share of the next one.
    next: f32,
    is_covered: bool,
}

// By the distance along the view.
fn split_at(distance: f32) -> Split {
    var reached = vec4u(map.splits[0] <= vec4f(distance));
    if LAYERS > 5u {
        reached += vec4u(map.splits[1] <= vec4f(distance));
    }
    let layer = reached.x + reached.y + reached.z + reached.w;
    var next = 0.0;
    if BLEND != 0u {
        // No border beyond the last split but one is ever reached.
        let begin = map.blends[(layer >> 2u) & 1u][layer & 3u];
        let end = map.splits[(layer >> 2u) & 1u][layer & 3u];
        next = select(0.0, (distance - begin) / (end - begin), distance > begin && layer < MOST_LAYERS - 1u);
    }
    return Split(layer, next, distance <= map.last_split);
}

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
