// needs: map_edges
// How far from a light's centre an edge is, seen from what lies behind the edge's smoothie: 0
// there, 1 on the light's rim.
//
// From a receiver p the point A is in line with the point e = (A − P b) / (1 − b/r) of the plane
// through the light's centre: b and r are the distances of A and p from that plane, and P is the
// way to p, as long as reaches to distance 1. So what is divided by 1 − b/r (SG "Rendering Fake
// Soft Shadows with Smoothies", "Computing Alpha") is a way on the light, which has the light's
// shape. The nearest point of the edge, from there, counts: neighbours need no corners between
// them.

// The light in the space where it is a unit sphere, disc, square or segment, as `area_light.wgsl`
// has it.
struct SmoothieLight {
    // Rows that take a way from its centre there.
    to_light: array<vec4f, 3>,
    // Half axes in world space.
    half_axes: array<vec4f, 3>,
    // Relative to the casters' origin; under parallel light 0.
    center: vec3f,
    // From there to its farthest point; under parallel light per metre of distance.
    reach: f32,
    // A box around all receivers.
    low: vec3f,
    face: u32,
    high: vec3f,
    pad: u32,
}

@group(3) @binding(0) var<uniform> smoothie_light: SmoothieLight;
// The layer of the depth maps.
@group(3) @binding(1) var map_depth: texture_depth_2d;

// Which face a light has does not differ within a draw: fragment shaders have it as a constant.
const SPHERE: u32 = 0u;
const DISC: u32 = 1u;
const SQUARE: u32 = 2u;
const LINE: u32 = 3u;

// How wide a line is taken to be, over its half length.
const LINE_WIDTH: f32 = 1e-3;
// A part of the edge that is as near to the receiver's own distance as this, over its farthest
// part, is not looked at.
const CONTACT: f32 = 1e-4;

// A point of the smoothie, and what it stands on.
struct Smoothie {
    // The nearest point of the edge: how far from the light's centre, over that of the rim.
    share: f32,
    // Its depth.
    depth: f32,
}

// Nowhere near a receiver.
const NO_SMOOTHIE: Smoothie = Smoothie(2.0, 0.0);

fn is_parallel() -> bool {
    return !(PERSPECTIVE || PARABOLOID);
}

fn to_light(way: vec3f) -> vec3f {
    return vec3f(
        dot(smoothie_light.to_light[0].xyz, way),
        dot(smoothie_light.to_light[1].xyz, way),
        dot(smoothie_light.to_light[2].xyz, way),
    );
}

// How far the light reaches in a direction, metres (under parallel light per metre of distance).
fn light_extent(direction: vec3f) -> f32 {
    let along = vec3f(
        dot(smoothie_light.half_axes[0].xyz, direction),
        dot(smoothie_light.half_axes[1].xyz, direction),
        dot(smoothie_light.half_axes[2].xyz, direction),
    );
    let is_round = smoothie_light.face == SPHERE || smoothie_light.face == DISC;
    return select(abs(along.x) + abs(along.y), length(along), is_round);
}

// The nearest point to 0 of the way from a to b: its distance, and where it is, 0 at a and 1 at b.
fn nearest_on(a: vec3f, b: vec3f) -> vec2f {
    let way = b - a;
    let at = saturate(-dot(a, way) / max(dot(way, way), 1e-30));
    return vec2f(length(a + at * way), at);
}

// The same where distances are those of squares: there either coordinate is 0, or both are the same
// but for the sign.
fn nearest_in_squares(a: vec2f, b: vec2f) -> vec2f {
    let way = b - a;
    var nearest = vec2f(1e30, 0.0);
    nearest = nearer_in_squares(nearest, a, way, -a.x, way.x);
    nearest = nearer_in_squares(nearest, a, way, -a.y, way.y);
    nearest = nearer_in_squares(nearest, a, way, a.y - a.x, way.x - way.y);
    return nearer_in_squares(nearest, a, way, -(a.x + a.y), way.x + way.y);
}

fn nearer_in_squares(nearest: vec2f, a: vec2f, way: vec2f, over: f32, under: f32) -> vec2f {
    let at = select(saturate(over / under), 0.0, under == 0.0);
    let found = abs(a + at * way);
    let most = max(found.x, found.y);
    return select(nearest, vec2f(most, at), most < nearest.x);
}

// A place on a light that is a square, or a line in the plane with this normal.
fn in_square(place: vec3f, normal: vec3f, face: u32) -> vec2f {
    let across = cross(vec3f(1.0, 0.0, 0.0), normal) / LINE_WIDTH;
    return vec2f(place.x, select(place.y, dot(place, across), face == LINE));
}

// What the light's plane is perpendicular to, for what lies in this direction.
fn plane_of_light(way: vec3f, face: u32) -> vec3f {
    let flat = vec3f(0.0, 0.0, select(1.0, -1.0, way.z < 0.0));
    let of_line = vec3f(0.0, way.yz);
    let other = select(way, of_line, face == LINE);
    let unit = other * inverseSqrt(max(dot(other, other), 1e-30));
    return select(unit, flat, face == DISC || face == SQUARE);
}

// An end of an edge as a receiver sees it: the place on the light that it is in line with, times
// `before`; that is how far it is before the receiver; and its distance.
struct End {
    place: vec3f,
    before: f32,
    distance: f32,
}

fn end_between(a: End, b: End, at: f32) -> End {
    return End(mix(a.place, b.place, at), mix(a.before, b.before, at), mix(a.distance, b.distance, at));
}

// From where ends are seen: through a point `at`, with the normal of the light's plane and the
// distance of the point from it, by a receiver whose depth is this share of the point's, or so many
// metres behind it.
struct Line {
    at: vec3f,
    normal: vec3f,
    distance: f32,
    share: f32,
    beyond: f32,
}

fn end_seen(p: vec3f, line: Line) -> End {
    let b = dot(line.normal, p);
    let before = b - line.distance + line.beyond;
    if is_parallel() {
        return End(vec3f(p.xy - line.at.xy, 0.0), before, before);
    }
    let scale = b / line.distance;
    return End(p - line.at * scale, 1.0 - scale * line.share, b);
}

// The smoothie of an edge from `start` to `end` at a point `at`, all in the light's space, where
// what the light sees lies at depth `behind`; that of `at` is `depth`, and `per_metre` how depth
// changes under parallel light.
fn smoothie_at(start: vec3f, end: vec3f, at: vec3f, depth: f32, per_metre: f32, behind: f32, face: u32) -> Smoothie {
    let normal = select(plane_of_light(at, face), vec3f(0.0, 0.0, 1.0), is_parallel());
    let distance = dot(normal, at);
    let beyond = (depth - behind) / per_metre;
    let line = Line(at, normal, distance, behind / depth, beyond);
    let first = end_seen(start, line);
    let last = end_seen(end, line);
    // What is between the light and the receiver.
    let least = CONTACT * max(abs(first.before), abs(last.before));
    var part = narrowed(vec2f(0.0, 1.0), first.before - least, last.before - least);
    part = narrowed(part, first.distance, last.distance);
    let a = end_between(first, last, part.x);
    let b = end_between(first, last, part.y);
    let first_place = a.place / a.before;
    let last_place = b.place / b.before;
    var nearest: vec2f;
    if face == SQUARE || face == LINE {
        nearest = nearest_in_squares(in_square(first_place, normal, face), in_square(last_place, normal, face));
    } else {
        nearest = nearest_on(first_place, last_place);
    }
    // What is evenly spread on the light is not along the edge.
    let place = nearest.y * a.before / max(nearest.y * a.before + (1.0 - nearest.y) * b.before, 1e-30);
    let away = mix(a.distance, b.distance, place);
    let fin_depth = select(depth * distance / away, behind + away * per_metre, is_parallel());
    let is_there = part.x < part.y && a.before > 0.0 && b.before > 0.0 && fin_depth > behind;
    return Smoothie(select(2.0, nearest.x, is_there), fin_depth);
}
