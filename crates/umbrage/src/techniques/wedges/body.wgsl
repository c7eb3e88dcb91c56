// Bodies around wedges: see `wedge` in the core crate. In light space; `light` is the module's own.

// Bodies are larger than wedges by this share, so that rounding cuts nothing off.
const SLACK: f32 = 1e-3;

// Of all n = cos φ axis + sin φ other with n · d ≥ radius for the directions from the light to
// `ends`, the first and the last φ.
fn span(axis: vec3f, other: vec3f, ends: array<vec3f, 2>) -> vec2f {
    var found = vec2f(-10.0, 10.0);
    let first = light.corners[0];
    // Of a sphere and a sun they are all the same.
    let is_round = all(light.corners[1] == first) && all(light.corners[2] == first) && all(light.corners[3] == first);
    for (var i = 0u; i < select(4u, 1u, is_round); i++) {
        let corner = light.corners[i].xyz;
        for (var k = 0u; k < 2u; k++) {
            let d = select(ends[k] - corner, -corner, light.parallel != 0u);
            let at = vec2f(dot(d, axis), dot(d, other));
            let far = length(at);
            let radius = light.radius * (1.0 + SLACK) + SLACK * 0.01 * far;
            if !(far > radius) {
                return vec2f(1.0, -1.0);
            }
            let middle = atan2(at.y, at.x);
            let half = acos(radius / far);
            found = vec2f(max(found.x, middle - half), min(found.y, middle + half));
        }
    }
    return found;
}

fn ray(end: vec3f, side: vec3f, sum: vec3f) -> vec3f {
    let r = cross(end, side);
    return normalize(select(-r, r, dot(r, sum) >= 0.0));
}

// Directions of a body's edges: of the low end in the front and in the back face, then of the high
// end.
fn rays_of(normals: array<vec3f, 4>) -> array<vec3f, 4> {
    let sum = normals[0] + normals[1] + normals[2] + normals[3];
    return array<vec3f, 4>(
        ray(normals[2], normals[0], sum),
        ray(normals[2], normals[1], sum),
        ray(normals[3], normals[0], sum),
        ray(normals[3], normals[1], sum),
    );
}

fn lie_within(rays: array<vec3f, 4>, normals: array<vec3f, 4>) -> bool {
    for (var i = 0u; i < 4u; i++) {
        for (var k = 0u; k < 4u; k++) {
            // Not so if a number is not one.
            if !(dot(normals[i], rays[k]) > -1e-4) {
                return false;
            }
        }
    }
    return true;
}

fn ways_of(rays: array<vec3f, 4>) -> array<vec3f, 4> {
    var ways = rays;
    for (var i = 0u; i < 4u; i++) {
        ways[i] = from_light(light, rays[i]);
    }
    return ways;
}

// In clip space: the near ones, then for each of them those of the front and the back face.
fn corners_of(starts: array<vec3f, 2>, ways: array<vec3f, 4>, end: vec4f) -> array<vec4f, 6> {
    var corners: array<vec4f, 6>;
    for (var i = 0u; i < 4u; i++) {
        corners[i + 2u] = light.clip_from_eye * run(starts[i / 2u], ways[i], end);
    }
    corners[0] = light.clip_from_eye * vec4f(starts[0], 1.0);
    corners[1] = light.clip_from_eye * vec4f(starts[1], 1.0);
    return corners;
}

// The side of a box where all rays, two from each start, leave it soonest, as n · p = w. Zero where
// they do not leave it through one side.
fn end_of(starts: array<vec3f, 2>, ways: array<vec3f, 4>, low: vec3f, high: vec3f) -> vec4f {
    var best = 1e30;
    var end = vec4f(0.0);
    for (var k = 0u; k < 6u; k++) {
        let axis = k / 2u;
        let sign = select(-1.0, 1.0, k % 2u == 1u);
        let bound = select(-low[axis], high[axis], k % 2u == 1u);
        var last = 0.0;
        for (var i = 0u; i < 4u; i++) {
            let speed = sign * ways[i][axis];
            // Not so steep that rounding moves where a ray meets the side.
            let is_steep = speed < 1e-3 * length(ways[i]);
            last = max(last, select((bound - sign * starts[i / 2u][axis]) / speed, 1e30, is_steep));
        }
        if last < best {
            best = last;
            end = vec4f(0.0, 0.0, 0.0, bound);
            end[axis] = sign;
        }
    }
    return end;
}

// A corner from light space to the eye's, moved out by what rounding may move it.
fn corner_of(p: vec3f, inwards: vec3f) -> vec3f {
    let out = p - inwards * (light.rounding * (length(p) + 1.0));
    return from_light(light, out) + light.center;
}
