// needs: fullscreen, receivers, area_light
// The light as a set of samples: every triangle before it removes those that it hides, so that
// whatever casters share counts once. Triangles are found in hierarchies of boxes by the pyramid
// from the point to the light.

struct TreeNode {
    low: vec3f,
    // Where the walk continues when it does not enter.
    next: u32,
    high: vec3f,
    // Of a leaf the first thing and how many, else 0.
    leaf: u32,
}

// A placed mesh.
struct Placed {
    // Rows of the way from eye-relative space to the mesh's.
    mesh_from_eye: array<vec4f, 3>,
    // Columns of the way back, of directions.
    eye_from_mesh: array<vec4f, 3>,
    first_node: u32,
    end_node: u32,
    // Points this close to a triangle's plane are on it, in units of the mesh.
    tolerance: f32,
    pad: u32,
}

@group(1) @binding(0) var<uniform> light: AreaLight;
@group(1) @binding(1) var<uniform> eye: Eye;
@group(1) @binding(2) var<storage, read> nodes: array<TreeNode>;
// Three vertices each.
@group(1) @binding(3) var<storage, read> triangles: array<u32>;
@group(1) @binding(4) var<storage, read> positions: array<f32>;
@group(1) @binding(5) var<storage, read> top: array<TreeNode>;
@group(1) @binding(6) var<storage, read> placed: array<Placed>;
// The samples in each half plane of the face, see `half_planes.rs`.
@group(1) @binding(7) var<storage, read> half_planes: array<vec4u>;

const LEAF_BITS: u32 = 8u;

// What there is in place of light space's axes: rows that take differences to the face's
// coordinates (x, y, w).
struct Rows {
    x: vec3f,
    y: vec3f,
    w: vec3f,
}

override FACE: u32 = SPHERE;
// 32 samples each, and four words each.
override WORDS: u32 = 2u;
override FOURS: u32 = 1u;
// How far from the middle of the face there are samples.
override REACH: f32 = 1.0;
// Half planes are known by the turn of their normal and their distance from the middle, in so many
// steps.
override TURNS: f32 = 128.0;
override DISTANCES: f32 = 128.0;

// Two unit vectors that make a right-handed system with a third one (Duff et al. 2017).
fn across(z: vec3f) -> array<vec3f, 2> {
    let s = select(-1.0, 1.0, z.z >= 0.0);
    let a = -1.0 / (s + z.z);
    let b = z.x * z.y * a;
    return array<vec3f, 2>(vec3f(1.0 + s * z.x * z.x * a, s * b, -s * z.x), vec3f(b, s + z.y * z.y * a, -z.y));
}

fn rows_at(p: vec3f) -> Rows {
    let x = vec3f(1.0, 0.0, 0.0);
    let y = vec3f(0.0, 1.0, 0.0);
    let z = vec3f(0.0, 0.0, 1.0);
    if light.parallel != 0u {
        return Rows(x, y, z);
    }
    if FACE == SPHERE {
        let far = length(p);
        let way = -p / far;
        let xy = across(way);
        return Rows(xy[0], xy[1], way / far);
    }
    if FACE == LINE {
        let square = dot(p.yz, p.yz);
        let w = vec3f(0.0, -p.yz / square);
        let aside = vec3f(0.0, -p.z, p.y) * (inverseSqrt(square) / LINE_WIDTH);
        return Rows(x + w * p.x, aside, w);
    }
    let w = z / -p.z;
    return Rows(x + w * p.x, y + w * p.y, w);
}

// Rows times a matrix of columns.
fn through(rows: Rows, a: vec3f, b: vec3f, c: vec3f) -> Rows {
    return Rows(
        vec3f(dot(rows.x, a), dot(rows.x, b), dot(rows.x, c)),
        vec3f(dot(rows.y, a), dot(rows.y, b), dot(rows.y, c)),
        vec3f(dot(rows.w, a), dot(rows.w, b), dot(rows.w, c)),
    );
}

fn reaches(n: vec3f, middle: vec3f, half: vec3f) -> bool {
    return dot(n, middle) + dot(abs(n), half) >= 0.0;
}

// Whether a box may reach into the pyramid over the face.
fn meets(rows: Rows, p: vec3f, low: vec3f, high: vec3f) -> bool {
    let middle = 0.5 * (low + high) - p;
    let half = 0.5 * (high - low) + 1e-6 * abs(p);
    let is_before = light.parallel != 0u || dot(rows.w, middle) - dot(abs(rows.w), half) <= 1.0;
    return is_before && reaches(rows.w, middle, half) && reaches(rows.w + rows.x, middle, half)
        && reaches(rows.w - rows.x, middle, half) && reaches(rows.w + rows.y, middle, half)
        && reaches(rows.w - rows.y, middle, half);
}

fn corner(vertex: u32) -> vec3f {
    return vec3f(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

fn on_rows(rows: Rows, d: vec3f) -> vec3f {
    return vec3f(dot(rows.x, d), dot(rows.y, d), dot(rows.w, d));
}

// The samples that are hidden. Words that there are none for are full. Two vectors and no array:
// indices that are not constant cost loops, whose rounds some drivers count and cut off.
var<private> first: vec4u;
var<private> second: vec4u;

fn is_dark() -> bool {
    let all = first & second;
    return (all.x & all.y & all.z & all.w) == 0xffffffffu;
}

// Removes the samples that a triangle hides.
fn strike(rows: Rows, p: vec3f, triangle: u32, tolerance: f32) {
    let da = corner(triangles[3u * triangle]) - p;
    let db = corner(triangles[3u * triangle + 1u]) - p;
    let dc = corner(triangles[3u * triangle + 2u]) - p;
    let normal = cross(db - da, dc - da);
    if abs(dot(normal, da)) <= tolerance * length(normal) {
        return;
    }
    let a = on_rows(rows, da);
    let b = on_rows(rows, db);
    let c = on_rows(rows, dc);
    let most = max(a, max(b, c));
    if most.z <= 0.0 {
        return;
    }
    let volume = dot(a, cross(b, c));
    let side = sign(volume);
    let u = cross(a, b) * side;
    let v = cross(b, c) * side;
    let w = cross(c, a) * side;
    // A sample is hidden where the ray to it passes on the same side of all edges, and meets the
    // plane before the light.
    let least = select(abs(volume), 0.0, light.parallel != 0u);
    let before = u + v + w - vec3f(0.0, 0.0, least);
    let halves = array<Half, 4>(half_of(u), half_of(v), half_of(w), half_of(before));
    first |= samples_in(halves[0], 0u) & samples_in(halves[1], 0u) & samples_in(halves[2], 0u) & samples_in(halves[3], 0u);
    if FOURS > 1u {
        second |= samples_in(halves[0], 1u) & samples_in(halves[1], 1u) & samples_in(halves[2], 1u) & samples_in(halves[3], 1u);
    }
}

// Where the table has a half plane, or the other side of its line.
struct Half {
    at: u32,
    other: u32,
}

// The half plane x X + y Y + z ≥ 0. Triangles beside each other ask for both sides of one line, so
// that no sample falls between them.
fn half_of(line: vec3f) -> Half {
    var l = line;
    if FACE == LINE {
        l.y = 0.0;
    }
    let is_other = l.x < 0.0 || (l.x == 0.0 && l.y < 0.0);
    l = select(l, -l, is_other);
    let turn = 0.5 + 0.5 * l.y / max(l.x + abs(l.y), 1e-30);
    let distance = 0.5 + 0.5 * l.z * inverseSqrt(max(dot(l.xy, l.xy), 1e-30)) / REACH;
    // The first step holds none and the last one all.
    let step = clamp(distance * (DISTANCES - 2.0) + 1.0, 0.0, DISTANCES - 1.0);
    let at = u32(min(turn * TURNS, TURNS - 1.0)) * u32(DISTANCES) + u32(step);
    return Half(at * FOURS, select(0u, 0xffffffffu, is_other));
}

fn samples_in(half: Half, four: u32) -> vec4u {
    return half_planes[half.at + four] ^ vec4u(half.other);
}

fn walk_mesh(rows: Rows, p: vec3f, place: Placed, off: f32) {
    var at = place.first_node;
    while at < place.end_node {
        let node = nodes[at];
        let is_met = meets(rows, p, node.low, node.high);
        let count = node.leaf & ((1u << LEAF_BITS) - 1u);
        if is_met {
            for (var i = 0u; i < count; i++) {
                strike(rows, p, (node.leaf >> LEAF_BITS) + i, place.tolerance + off);
            }
        }
        at = select(node.next, at + 1u, is_met && count == 0u);
        if count > 0u && is_met && is_dark() {
            return;
        }
    }
}

// `off` is how far, in metres, the point may be off its own surface.
fn walk(rows: Rows, p: vec3f, off: f32) {
    var at = 0u;
    while at < arrayLength(&top) && !is_dark() {
        let node = top[at];
        if node.next == 0u {
            return;
        }
        let is_met = meets(rows, p, node.low, node.high);
        let count = node.leaf & ((1u << LEAF_BITS) - 1u);
        if is_met {
            for (var i = 0u; i < count; i++) {
                let place = placed[(node.leaf >> LEAF_BITS) + i];
                let m = place.mesh_from_eye;
                let there = vec3f(dot(m[0].xyz, p) + m[0].w, dot(m[1].xyz, p) + m[1].w, dot(m[2].xyz, p) + m[2].w);
                let back = place.eye_from_mesh;
                let metre = max(length(m[0].xyz), max(length(m[1].xyz), length(m[2].xyz)));
                walk_mesh(through(rows, back[0].xyz, back[1].xyz, back[2].xyz), there, place, off * metre);
            }
        }
        at = select(node.next, at + 1u, is_met && count == 0u);
    }
}

// Samples below the surface's own plane.
fn strike_horizon(p: vec3f, rows: Rows, normal: vec3f) {
    // In light space.
    let n = vec3f(
        normal.x * light.from_light[0].x + normal.y * light.from_light[1].x + normal.z * light.from_light[2].x,
        normal.x * light.from_light[0].y + normal.y * light.from_light[1].y + normal.z * light.from_light[2].y,
        normal.x * light.from_light[0].z + normal.y * light.from_light[1].z + normal.z * light.from_light[2].z,
    );
    let height = dot(n, way_to_light(light, p));
    var x = n.x;
    var y = n.y;
    if FACE == SPHERE {
        x = dot(n, rows.x);
        y = dot(n, rows.y);
    } else if FACE == LINE {
        y = 0.0;
    }
    let below = half_of(-vec3f(x, y, height));
    first |= samples_in(below, 0u);
    if FOURS > 1u {
        second |= samples_in(below, 1u);
    }
}

// Seen edge-on, from its own plane or line, a flat light has no face: what is nearer to that than
// this, as a share of its distance, is taken to be so far from it, out of its own surface.
const EDGE_ON: f32 = 1e-3;

fn off_plane(p: vec3f, normal: vec3f) -> vec3f {
    let least = EDGE_ON * length(p);
    let side = dot(normal, from_light(light, select(vec3f(0.0, 0.0, 1.0), vec3f(0.0, 1.0, 0.0), FACE == LINE)));
    let out = select(least, -least, side < 0.0);
    if FACE == LINE && dot(p.yz, p.yz) < least * least {
        return vec3f(p.x, out, 0.0);
    }
    if FACE != LINE && FACE != SPHERE && light.parallel == 0u && abs(p.z) < least {
        return vec3f(p.xy, out);
    }
    return p;
}

@fragment
fn mask(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == eye.background_depth {
        return 1.0;
    }
    let seen_at = position_eye(eye, at.xy, depth);
    let seen_p = to_light(light, seen_at);
    let surface = surface(eye, at.xy, depth);
    let p = off_plane(seen_p, surface.normal);
    let here = seen_at + from_light(light, p - seen_p);
    let rows = rows_at(p);
    let full = 0xffffffffu;
    first = select(vec4u(full), vec4u(0u), vec4u(0u, 1u, 2u, 3u) < vec4u(WORDS));
    second = select(vec4u(full), vec4u(0u), vec4u(4u, 5u, 6u, 7u) < vec4u(WORDS));
    if surface.casts {
        strike_horizon(seen_p, rows, surface.normal);
    }
    // The same of differences in eye-relative space.
    let l = light.to_light;
    let x = vec3f(l[0].x, l[1].x, l[2].x);
    let y = vec3f(l[0].y, l[1].y, l[2].y);
    let z = vec3f(l[0].z, l[1].z, l[2].z);
    let off = off_any_surface(eye, 1.0 / eye_w(eye, ndc_of(eye, at.xy, depth)));
    walk(through(rows, x, y, z), here, off);
    let seen = countOneBits(~first) + countOneBits(~second);
    return f32(seen.x + seen.y + seen.z + seen.w) / f32(32u * WORDS);
}
