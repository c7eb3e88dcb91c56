// The light as a set of samples: every triangle before it strikes out those that it hides, so that whatever casters share counts
// once. Triangles are found in hierarchies of boxes by the pyramid from the point to the light.

struct TreeNode {
    low: vec3f,
    // Where the walk goes on when it does not enter.
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

@group(1) @binding(0) var<uniform> light: WedgeLight;
@group(1) @binding(1) var<uniform> eye: Eye;
@group(1) @binding(2) var<storage, read> nodes: array<TreeNode>;
// Three vertices each.
@group(1) @binding(3) var<storage, read> triangles: array<u32>;
@group(1) @binding(4) var<storage, read> positions: array<f32>;
@group(1) @binding(5) var<storage, read> top: array<TreeNode>;
@group(1) @binding(6) var<storage, read> placed: array<Placed>;
// Of four samples at a time x, then y.
@group(1) @binding(7) var<storage, read> samples: array<vec4f>;

const LEAF_BITS: u32 = 8u;

// What there is in place of light space's axes: rows that take differences to the face's coordinates (x, y, w).
struct Rows {
    x: vec3f,
    y: vec3f,
    w: vec3f,
}

override FACE: u32 = BALL;
// 32 samples each.
override WORDS: u32 = 2u;

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
    if FACE == BALL {
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

// The samples that are hidden. Words that there are none for are full. Two vectors and no array: indices that are not constant cost
// loops, whose rounds some drivers count and cut off.
var<private> first: vec4u;
var<private> second: vec4u;

fn is_dark() -> bool {
    let all = first & second;
    return (all.x & all.y & all.z & all.w) == 0xffffffffu;
}

// Strikes out the samples that a triangle hides.
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
    let sum = u + v + w;
    // A sample is hidden where the ray to it passes on the same side of all edges, and meets the plane before the light.
    let least = select(abs(volume), 0.0, light.parallel != 0u);
    let edges = Edges(vec3f(u.x, v.x, w.x), vec3f(u.y, v.y, w.y), vec3f(u.z, v.z, w.z), sum, least);
    strike_all(edges);
}

// Lines over a triangle's edges on the face, positive inside, the sum of all and its least value.
struct Edges {
    x: vec3f,
    y: vec3f,
    z: vec3f,
    sum: vec3f,
    least: f32,
}

// Of four samples.
fn struck4(edges: Edges, at: u32) -> u32 {
    let x = samples[2u * at];
    let y = samples[2u * at + 1u];
    let one = edges.x.x * x + edges.y.x * y + edges.z.x;
    let two = edges.x.y * x + edges.y.y * y + edges.z.y;
    let three = edges.x.z * x + edges.y.z * y + edges.z.z;
    let far = edges.sum.x * x + edges.sum.y * y + edges.sum.z - edges.least;
    let is_hidden = min(min(one, two), min(three, far)) >= vec4f(0.0);
    let bits = select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), is_hidden);
    return bits.x | bits.y | bits.z | bits.w;
}

// Without a loop, whose rounds some drivers count.
fn struck(edges: Edges, word: u32) -> u32 {
    let at = 8u * word;
    return struck4(edges, at) | (struck4(edges, at + 1u) << 4u) | (struck4(edges, at + 2u) << 8u)
        | (struck4(edges, at + 3u) << 12u) | (struck4(edges, at + 4u) << 16u) | (struck4(edges, at + 5u) << 20u)
        | (struck4(edges, at + 6u) << 24u) | (struck4(edges, at + 7u) << 28u);
}

fn strike_all(edges: Edges) {
    first.x |= struck(edges, 0u);
    if WORDS > 1u {
        first.y |= struck(edges, 1u);
    }
    if WORDS > 2u {
        first.z |= struck(edges, 2u);
    }
    if WORDS > 3u {
        first.w |= struck(edges, 3u);
    }
    if WORDS > 4u {
        second.x |= struck(edges, 4u);
    }
    if WORDS > 5u {
        second.y |= struck(edges, 5u);
    }
    if WORDS > 6u {
        second.z |= struck(edges, 6u);
    }
    if WORDS > 7u {
        second.w |= struck(edges, 7u);
    }
}

fn walk_mesh(rows: Rows, p: vec3f, place: Placed) {
    var at = place.first_node;
    while at < place.end_node {
        let node = nodes[at];
        let is_met = meets(rows, p, node.low, node.high);
        let count = node.leaf & ((1u << LEAF_BITS) - 1u);
        if is_met {
            for (var i = 0u; i < count; i++) {
                strike(rows, p, (node.leaf >> LEAF_BITS) + i, place.tolerance);
            }
        }
        at = select(node.next, at + 1u, is_met && count == 0u);
        if count > 0u && is_met && is_dark() {
            return;
        }
    }
}

fn walk(rows: Rows, p: vec3f) {
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
                walk_mesh(through(rows, back[0].xyz, back[1].xyz, back[2].xyz), there, place);
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
    if FACE == BALL {
        x = dot(n, rows.x);
        y = dot(n, rows.y);
    } else if FACE == LINE {
        y = 0.0;
    }
    let line = vec3f(x, y, height) * -1.0;
    strike_all(Edges(line.xxx, line.yyy, line.zzz, line, 0.0));
}

@fragment
fn mask(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == eye.background_depth {
        return 1.0;
    }
    let here = position_eye(eye, at.xy, depth);
    let p = to_light(light, here);
    let rows = rows_at(p);
    let surface = surface(eye, at.xy, depth);
    let full = 0xffffffffu;
    first = select(vec4u(full), vec4u(0u), vec4u(0u, 1u, 2u, 3u) < vec4u(WORDS));
    second = select(vec4u(full), vec4u(0u), vec4u(4u, 5u, 6u, 7u) < vec4u(WORDS));
    if surface.casts {
        strike_horizon(p, rows, surface.normal);
    }
    // The same of differences in eye-relative space.
    let l = light.to_light;
    let x = vec3f(l[0].x, l[1].x, l[2].x);
    let y = vec3f(l[0].y, l[1].y, l[2].y);
    let z = vec3f(l[0].z, l[1].z, l[2].z);
    walk(through(rows, x, y, z), here);
    let seen = countOneBits(~first) + countOneBits(~second);
    return f32(seen.x + seen.y + seen.z + seen.w) / f32(32u * WORDS);
}
