// needs: contour_record, map_view
// Draws edges that bound the shadows of casters into a layer of a light's maps: what
// `EdgePass` draws, four corners an edge. Group 3 is the technique's own.

@group(0) @binding(0) var<storage, read> contour: array<ContourRecord>;
// Relative to the casters' origin; w = 0: the direction to it.
@group(0) @binding(1) var<uniform> contour_light: vec4f;
@group(2) @binding(0) var<uniform> map_view: MapView;

// The layer is seen from a point.
override PERSPECTIVE: bool = false;
// The layer is a paraboloid. Its edges are straight between corners, as those of its triangles are.
override PARABOLOID: bool = false;

// An edge in world space, relative to the casters' origin. Seen from the light it runs with the
// shadow on its left.
struct ContourEdge {
    start: vec3f,
    end: vec3f,
    // How many surfaces end here: 1 at the border of an open mesh, 2 where a mesh folds.
    times: f32,
    // False where a draw has more corners than there are edges.
    is_there: bool,
}

// The part of an edge that is in the layer or near it.
struct LayerEdge {
    // Texels right and down; whole numbers are corners.
    start: vec2f,
    end: vec2f,
    // Depth at both ends: near / distance, or what is left of a parallel view. Linear between them
    // (nearly so in paraboloids).
    depth: vec2f,
    // Which part of the whole edge it is, 0 its start, 1 its end.
    part: vec2f,
    // One way along it and one away from the shadow, in texels, of length 1.
    along: vec2f,
    outward: vec2f,
    is_seen: bool,
}

// Edges that an instance draws.
const EDGES: u32 = 64u;

// What a corner with nothing to draw returns: off the layer.
const OFF_LAYER: vec4f = vec4f(2.0, 2.0, 0.0, 1.0);

// The edge that a corner belongs to; both numbers are the draw's own.
fn contour_edge(vertex: u32, group: u32) -> ContourEdge {
    let at = group * EDGES + vertex / 4u;
    if at >= arrayLength(&contour) {
        return ContourEdge();
    }
    let found = contour[at];
    return ContourEdge(found.start, found.end, found.times, found.times > 0.0);
}

// Corners 0 to 3 go round the quad: at the end and at the start on one side, at the start and at
// the end on the other.
fn is_at_end(vertex: u32) -> bool {
    return (vertex & 3u) == 0u || (vertex & 3u) == 3u;
}

fn is_on_other_side(vertex: u32) -> bool {
    return (vertex & 3u) >= 2u;
}

// The way of light at a point, not normalised: from the light to it, or along parallel light.
fn way_of_light(p: vec3f) -> vec3f {
    return p * contour_light.w - contour_light.xyz;
}

// One metre away from the shadow at a point of the edge, across the light; zero where the edge runs
// along the light.
fn outward_at(edge: ContourEdge, p: vec3f) -> vec3f {
    return unit_or_zero(cross(normalize(way_of_light(p)), unit_or_zero(edge.end - edge.start)));
}

// One metre along the edge as the light sees it: across the light, from start to end.
fn along_at(edge: ContourEdge, p: vec3f) -> vec3f {
    return cross(outward_at(edge, p), normalize(way_of_light(p)));
}

fn unit_or_zero(v: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(vec3f(0.0), v * inverseSqrt(square), square > 1e-12);
}

// A point in the layer's clip space. z over w is its depth as maps that are not linear have it.
fn clip_of(p: vec3f) -> vec4f {
    let at = map_view.clip_from_world * vec4f(p, 1.0);
    if PARABOLOID {
        let distance = length(at.xyw);
        let w = max(distance + at.w, 1e-6 * distance);
        return vec4f(at.xy * map_view.clip_from_plane.xy + map_view.clip_from_plane.zw * w, map_view.near * w / distance, w);
    }
    return at;
}

// Texels right and down of a place in clip space.
fn texel_of(clip: vec4f) -> vec2f {
    return (0.5 + vec2f(0.5, -0.5) * clip.xy / clip.w) * map_view.size;
}

// The place in clip space of a texel and a depth.
fn clip_of_texel(texel: vec2f, depth: f32) -> vec4f {
    return vec4f((texel / map_view.size * 2.0 - 1.0) * vec2f(1.0, -1.0), depth, 1.0);
}

// Narrows a part to where what is linear along it is not negative.
fn narrowed(part: vec2f, at_start: f32, at_end: f32) -> vec2f {
    let crossing = at_start / (at_start - at_end);
    let narrow = vec2f(
        select(part.x, max(part.x, crossing), at_start < 0.0),
        select(part.y, min(part.y, crossing), at_end < 0.0),
    );
    return select(narrow, vec2f(1.0, 0.0), at_start < 0.0 && at_end < 0.0);
}

// The part of an edge that is in the layer or at most `margin` texels outside. What is behind the
// light is cut off, so that all of it has a finite place.
fn layer_edge(edge: ContourEdge, margin: f32) -> LayerEdge {
    var seen: LayerEdge;
    let a = clip_of(edge.start);
    let b = clip_of(edge.end);
    let wide = 1.0 + 2.0 * margin / map_view.size;
    let least = 1e-6 * max(abs(a.w), abs(b.w));
    var part = narrowed(vec2f(0.0, 1.0), a.w - least, b.w - least);
    part = narrowed(part, wide * a.w - a.x, wide * b.w - b.x);
    part = narrowed(part, wide * a.w + a.x, wide * b.w + b.x);
    part = narrowed(part, wide * a.w - a.y, wide * b.w - b.y);
    part = narrowed(part, wide * a.w + a.y, wide * b.w + b.y);
    // Neither is true of numbers that are none.
    seen.is_seen = edge.is_there && part.x < part.y && least > 0.0;
    if !seen.is_seen {
        return seen;
    }
    let start = mix(a, b, part.x);
    let end = mix(a, b, part.y);
    seen.start = texel_of(start);
    seen.end = texel_of(end);
    seen.depth = vec2f(start.z / start.w, end.z / end.w);
    seen.part = part;
    let way = seen.end - seen.start;
    let square = dot(way, way);
    seen.along = select(vec2f(1.0, 0.0), way * inverseSqrt(square), square > 1e-12);
    // Texels go down, so that right of the way is this.
    seen.outward = vec2f(-seen.along.y, seen.along.x);
    return seen;
}

// The two ends in world space of the part that a layer shows: what a fin of some metres stands on,
// no corner of which is then behind the light by more than the fin is wide.
fn seen_start(edge: ContourEdge, seen: LayerEdge) -> vec3f {
    return mix(edge.start, edge.end, seen.part.x);
}

fn seen_end(edge: ContourEdge, seen: LayerEdge) -> vec3f {
    return mix(edge.start, edge.end, seen.part.y);
}

// A corner, in texels, of the quad that holds all that is at most `beyond` texels from the edge,
// outwards; and inwards at most `inward`.
fn quad_corner(seen: LayerEdge, vertex: u32, beyond: f32, inward: f32) -> vec2f {
    let at = select(seen.start - seen.along * beyond, seen.end + seen.along * beyond, is_at_end(vertex));
    return at + seen.outward * select(beyond, -inward, is_on_other_side(vertex));
}
