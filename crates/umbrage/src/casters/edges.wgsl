// Edges of meshes, and how often each of them bounds the shadow of a caster: once for every
// light-facing triangle that no neighbour cancels, so that any triangle soup casts right (Bergeron
// 1986; Aldridge and Woods 2004; Kim 2008).

// All of it lies in arrays of at most 12 bytes a triangle, as indices do, so that a binding of
// 128 MiB holds what belongs to 11 million triangles.

struct Edge {
    // A vertex, and ONE_WAY where no triangles lie on both sides of the edge.
    start: u32,
    end: u32,
}

// The triangles at an edge.
struct Pair {
    // The one that runs from start to end.
    first: u32,
    // The other one and SAME_DIRECTION, or NO_TRIANGLE.
    second: u32,
}

// A caster under one light.
struct Caster {
    // The light in mesh space about the middle of the mesh; w = 0: the direction to it.
    light: vec4f,
    // The shadow may end where n · p = w, since nothing that is seen lies beyond; n = 0: nowhere.
    end: vec4f,
    first_edge: u32,
    edge_count: u32,
    // Of its chunks of edges, the first.
    edge_chunk: u32,
    first_triangle: u32,
    triangle_count: u32,
    triangle_chunk: u32,
    // Of its mesh in the index buffer, and what indices are relative to.
    first_index: u32,
    base_vertex: u32,
    instance: u32,
    flags: u32,
    // Where its shadow ends, metres from the light; 0: nowhere.
    reach: f32,
    pad: u32,
    // Wedges, in the light's own space: from where the silhouette is seen, and the x axis of a
    // piece of a sphere.
    seen_from: vec3f,
    pad_seen_from: f32,
    axis: vec3f,
    pad_axis: f32,
}

// Only triangles that face away from the light cast the shadow; otherwise all do, turned to the
// light.
const AWAY: u32 = 1u;
const MIRRORED: u32 = 2u;
const Z_FAIL: u32 = 4u;
const LIGHT_CAP: u32 = 8u;
const DARK_CAP: u32 = 16u;
// Its near and its far side count apart.
const BODY: u32 = 32u;
// Wedges: the shadow is counted from infinity.
const COUNT_FROM_INFINITY: u32 = 64u;

const NO_TRIANGLE: u32 = 0x7fffffffu;
const SAME_DIRECTION: u32 = 0x80000000u;
const ONE_WAY: u32 = 0x80000000u;

// Edges, and triangles, of a caster that go together; each chunk names its caster.
const CHUNK: u32 = 64u;

// Words of a list before those that name the caster of each chunk: for each part where its entries
// start and how many there are. The entries follow the chunks.
const HEADER: u32 = 8u;

@group(0) @binding(0) var<storage, read> casters: array<Caster>;
@group(1) @binding(0) var<storage, read> edges: array<Edge>;
@group(1) @binding(1) var<storage, read> pairs: array<Pair>;
@group(1) @binding(5) var<storage, read> plane_normals: array<f32>;
@group(1) @binding(6) var<storage, read> plane_offsets: array<f32>;

fn start_of(edge: Edge) -> u32 {
    return edge.start & ~ONE_WAY;
}

// Of a triangle; zero where that has no area.
fn normal_of(triangle: u32) -> vec3f {
    let at = 3u * triangle;
    return vec3f(plane_normals[at], plane_normals[at + 1u], plane_normals[at + 2u]);
}

fn plane_at(triangle: u32) -> vec4f {
    return vec4f(normal_of(triangle), plane_offsets[triangle]);
}

// 1 where the light is in front of the plane or in it, −1 behind it.
fn facing(plane: vec4f, light: vec4f) -> i32 {
    return select(-1, 1, plane.x * light.x + plane.y * light.y + plane.z * light.z + plane.w * light.w >= 0.0);
}

// What a triangle adds to its edges; it is taken turned to the light.
fn share(caster: u32, triangle: u32) -> i32 {
    let f = facing(plane_at(triangle), casters[caster].light);
    return select(f, 0, f > 0 && (casters[caster].flags & AWAY) != 0u);
}

// How often the edge bounds the shadow; negative where that runs from end to start.
fn multiplicity(caster: u32, pair: Pair) -> i32 {
    let one = share(caster, pair.first);
    let other = pair.second & ~SAME_DIRECTION;
    if other == NO_TRIANGLE {
        return one;
    }
    let two = share(caster, other);
    return one + select(-two, two, (pair.second & SAME_DIRECTION) != 0u);
}

// What is drawn, in 32 bits: chunk, place in it, and two bits: turned round, counts twice.
fn side_entry(slot: u32, times: i32) -> u32 {
    return (slot << 2u) | (u32(abs(times) == 2) << 1u) | u32(times < 0);
}

fn cap_entry(slot: u32, facing_away: bool) -> u32 {
    return (slot << 2u) | u32(facing_away);
}
