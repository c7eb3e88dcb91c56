// What a directed edge adds to the covered share of a light apart from the hard shadow: see
// `coverage` in the core crate. All in light space.

const PI: f32 = 3.14159265358979;

// Where an edge runs across a disc: its line's distance from the centre, which is negative where
// that is on its right, and where its ends are along it, from the foot of the perpendicular.
struct Across {
    distance: f32,
    start: f32,
    end: f32,
    hit: bool,
}

// The face turns to whoever looks: `a` and `b` are the edge relative to the point, `way` leads to
// the centre.
fn across_sphere(a: vec3f, b: vec3f, way: vec3f) -> Across {
    let square = dot(way, way);
    let per_square = 1.0 / square;
    let depth_a = dot(a, way) * per_square;
    let depth_b = dot(b, way) * per_square;
    let n = cross(a, b);
    let height = dot(n, way);
    // Of the part of n along the face, times the distance.
    let aside = sqrt(max(dot(n, n) * square - height * height, 0.0));
    let along = cross(n, way) / aside;
    // What lies beyond the light's plane is cut off there; outside of the face it adds nothing.
    let cut = mix(a, b, (1.0 - depth_a) / (depth_b - depth_a));
    let from_a = select(dot(a, along) / depth_a, dot(cut, along), depth_a > 1.0);
    let from_b = select(dot(b, along) / depth_b, dot(cut, along), depth_b > 1.0);
    return clipped(height * sqrt(square) / aside, vec2f(from_a, from_b), vec2f(depth_a, depth_b), true);
}

// Ends as a point sees them on a fixed disc, homogeneous.
fn across_disc(a: vec3f, b: vec3f, beyond: bool) -> Across {
    let n = cross(a, b);
    let length = length(n.xy);
    let along = vec2f(n.y, -n.x) / length;
    let cut = mix(a, b, (1.0 - a.z) / (b.z - a.z));
    let from_a = select(dot(a.xy, along) / a.z, dot(cut.xy, along), beyond && a.z > 1.0);
    let from_b = select(dot(b.xy, along) / b.z, dot(cut.xy, along), beyond && b.z > 1.0);
    return clipped(n.z / length, vec2f(from_a, from_b), vec2f(a.z, b.z), beyond);
}

fn clipped(distance: f32, ends: vec2f, depths: vec2f, beyond: bool) -> Across {
    let half = sqrt(max(1.0 - distance * distance, 0.0));
    // What comes from behind the observer comes from infinitely far away.
    let start = select(-half, max(ends.x, -half), depths.x > 0.0);
    let end = select(half, min(ends.y, half), depths.y > 0.0);
    let is_seen = any(depths > vec2f(0.0)) && !(beyond && all(depths > vec2f(1.0)));
    return Across(distance, start, end, is_seen && start < end && abs(distance) < 1.0);
}

// `inside`: the centre is on the left, whatever was rounded.
fn disc_analytic(c: Across, inside: bool) -> f32 {
    let area = abs(c.distance) * (c.end - c.start);
    let share = area - atan2(area, c.distance * c.distance + c.start * c.end);
    return select(-share, share, inside) / (2.0 * PI);
}

struct Chord {
    start: vec2f,
    end: vec2f,
    hit: bool,
}

fn across_square(from_a: vec3f, from_b: vec3f) -> Chord {
    var a = from_a;
    var b = from_b;
    let before = mix(a, b, (1.0 - a.z) / (b.z - a.z));
    a = select(from_a, before, from_a.z > 1.0);
    b = select(from_b, before, from_b.z > 1.0);
    let at_a = vec4f(a.z + a.x, a.z - a.x, a.z + a.y, a.z - a.y);
    let at_b = vec4f(b.z + b.x, b.z - b.x, b.z + b.y, b.z - b.y);
    let cut = at_a / (at_a - at_b);
    let enters = select(vec4f(0.0), cut, at_a < vec4f(0.0));
    let leaves = select(vec4f(1.0), cut, at_b < vec4f(0.0));
    let start = max(max(enters.x, enters.y), max(enters.z, enters.w));
    let end = min(min(leaves.x, leaves.y), min(leaves.z, leaves.w));
    let misses = any((at_a < vec4f(0.0)) & (at_b < vec4f(0.0))) || (from_a.z > 1.0 && from_b.z > 1.0);
    let p = mix(a, b, start);
    let q = mix(a, b, end);
    return Chord(p.xy / p.z, q.xy / q.z, !misses && start < end);
}

// An angle that is near half a turn has the sign of the side that the centre is on.
fn signed(angle: f32, quarter: f32, inside: bool) -> f32 {
    return select(angle, select(-abs(angle), abs(angle), inside), abs(angle) > quarter);
}

// The share 0…1 of the way around the square where the ray through a point leaves it.
fn around_square(p: vec2f) -> f32 {
    let longest = max(abs(p.x), abs(p.y));
    let at = p / max(longest, 1e-30);
    let right_or_left = select(5.0 - at.y, 1.0 + at.y, at.x > 0.0);
    let up_or_down = select(7.0 + at.x, 3.0 - at.x, at.y > 0.0);
    return select(up_or_down, right_or_left, abs(p.x) >= abs(p.y)) / 8.0;
}

// The share of the square within the angle under which its centre sees a chord.
fn turn_on_square(c: Chord, inside: bool) -> f32 {
    let turn = around_square(c.end) - around_square(c.start);
    return signed(turn - round(turn), 0.25, inside);
}

fn on_square(c: Chord, inside: bool) -> f32 {
    return (c.start.x * c.end.y - c.start.y * c.end.x) / 8.0 - turn_on_square(c, inside);
}

// What flat lights make of differences of places: homogeneous coordinates (x, y, w) of the face,
// w = 1 in its plane.
fn on_face(d: vec3f, p: vec3f) -> vec3f {
    let w = -d.z / p.z;
    return vec3f(d.xy + p.xy * w, w);
}

// The face of a line is next to nothing wide and turns to whoever looks. Its hand does not change.
fn on_line(d: vec3f, p: vec3f) -> vec3f {
    let square = dot(p.yz, p.yz);
    let w = -dot(d.yz, p.yz) / square;
    let aside = (d.z * p.y - d.y * p.z) * inverseSqrt(square) / LINE_WIDTH;
    return vec3f(d.x + p.x * w, aside, w);
}

// A − S of an edge, times what is covered on its left; `inside`: the centre is, too.
fn share_of_edge(light: AreaLight, p: vec3f, start: vec3f, end: vec3f, inside: bool) -> f32 {
    let a = start - p;
    let b = end - p;
    if FACE == SPHERE {
        let c = across_sphere(a, b, -p);
        return select(0.0, disc_term(c, inside), c.hit);
    }
    if light.parallel != 0u {
        let c = across_disc(a, b, false);
        return select(0.0, disc_term(c, inside), c.hit);
    }
    // Seen from behind, left is right.
    let is_behind = p.z > 0.0 && FACE != LINE;
    if FACE == DISC {
        let c = across_disc(on_face(a, p), on_face(b, p), true);
        let share = select(0.0, disc_term(c, inside != is_behind), c.hit);
        return select(share, -share, is_behind);
    }
    var c: Chord;
    if FACE == LINE {
        c = across_square(on_line(a, p), on_line(b, p));
    } else {
        c = across_square(on_face(a, p), on_face(b, p));
    }
    let share = select(0.0, square_term(c, inside != is_behind), c.hit);
    return select(share, -share, is_behind);
}

// What the light looks like, one of the constants.
override FACE: u32 = SPHERE;
// The light is a piece of a disc or a sphere.
override SPLIT: bool = false;
