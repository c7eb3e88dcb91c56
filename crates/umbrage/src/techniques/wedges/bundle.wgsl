// needs: area_light, record, body
// Wedges that lie close together are drawn as one: see `wedge::Wedge::around` in the core crate.

@group(0) @binding(0) var<uniform> light: AreaLight;
@group(0) @binding(1) var<storage, read> wedges: array<Wedge>;
// Arguments of the draws of all bodies, of single ones, of bundles and of sides.
@group(0) @binding(2) var<storage, read_write> draws: array<atomic<u32>, 20>;
@group(0) @binding(3) var<storage, read_write> bundles: array<Bundle>;
// How many single wedges and how many bundles there are; then the numbers of the single ones.
@group(0) @binding(4) var<storage, read_write> singles: array<atomic<u32>>;

// Wedges, and bundles, that an instance draws.
const GROUP: u32 = 64u;

// Wedges that a thread looks for bundles among. They come in the order of their edges, neighbours
// in space mostly being neighbours in it.
const WINDOW: u32 = 16u;

// Bundles are made where their bodies cover less than this share of what the wedges cover one by
// one. A fragment costs more than the share of an edge, and one of a bundle has four shares.
const WORTH: f32 = 0.6;

fn draw_alone(wedge: u32) {
    let at = atomicAdd(&singles[0], 1u);
    atomicStore(&singles[2u + at], wedge);
    atomicMax(&draws[6], at / GROUP + 1u);
}

fn draw_together(made: Bundle) {
    let at = atomicAdd(&singles[1], 1u);
    bundles[at] = made;
    atomicMax(&draws[11], at / GROUP + 1u);
}

// A wedge that no body holds covers more than the places where its edge could be seen.
fn has_body(wedge: u32) -> bool {
    return any(wedges[wedge].weights != vec2f(0.0)) && any(wedges[wedge].planes[0].xyz != vec3f(0.0));
}

fn middle_of(wedge: u32) -> vec3f {
    return 0.5 * (wedges[wedge].start + wedges[wedge].end);
}

// Where the bits of a window are set, those of the place that is nearest to another one.
fn nearest(first: u32, free: u32, to: vec3f) -> u32 {
    var best = 1e30;
    var found = 0u;
    for (var i = 0u; i < WINDOW; i++) {
        let way = middle_of(first + i) - to;
        let distance = dot(way, way);
        if (free & (1u << i)) != 0u && distance < best {
            best = distance;
            found = i;
        }
    }
    return found;
}

// Steps after which a ray leaves the box around all that is seen.
fn leaves(start: vec3f, way: vec3f) -> f32 {
    let walls = select(light.low.xyz, light.high.xyz, way > vec3f(0.0));
    let steps = select((walls - start) / way, vec3f(1e30), way == vec3f(0.0));
    return max(min(steps.x, min(steps.y, steps.z)), 0.0);
}

// Compares what bodies cover half way to where they end, going by the faces of the first wedge.
fn is_worth_it(members: vec4u) -> bool {
    let seed = wedges[members.x].planes;
    let main = -normalize(way_to_light(light, middle_of(members.x)));
    let aside = normalize(seed[0].xyz - seed[1].xyz);
    let along = cross(main, aside);
    let steps = 0.5 * leaves(from_light(light, middle_of(members.x)) + light.center, from_light(light, main));
    let apart = steps * vec2f(dot(seed[0].xyz + seed[1].xyz, main), dot(seed[2].xyz + seed[3].xyz, main));
    var low = vec2f(1e30);
    var high = vec2f(-1e30);
    var one_by_one = 0.0;
    for (var i = 0u; i < BUNDLE; i++) {
        let start = wedges[members[i]].start;
        let end = wedges[members[i]].end;
        let a = vec2f(dot(start, aside), dot(start, along));
        let b = vec2f(dot(end, aside), dot(end, along));
        low = min(low, min(a, b));
        high = max(high, max(a, b));
        one_by_one += apart.x * apart.y + 0.5 * (apart.x + apart.y) * length(b - a);
    }
    let extent = high - low + apart;
    return extent.x * extent.y < WORTH * one_by_one;
}

fn span_of_all(members: vec4u, main: vec3f, other: vec3f) -> vec2f {
    var found = vec2f(-10.0, 10.0);
    for (var i = 0u; i < BUNDLE; i++) {
        let one = span(main, other, array<vec3f, 2>(wedges[members[i]].start, wedges[members[i]].end));
        found = vec2f(max(found.x, one.x), min(found.y, one.y));
    }
    return found;
}

// How far ends reach against a normal from `middle`; not more than 0.
fn least(members: vec4u, normal: vec3f, middle: vec3f) -> f32 {
    var least = 0.0;
    for (var i = 0u; i < BUNDLE; i++) {
        least = min(least, dot(normal, wedges[members[i]].start - middle));
        least = min(least, dot(normal, wedges[members[i]].end - middle));
    }
    return least;
}

// Where three planes meet.
fn meet(a: vec4f, b: vec4f, c: vec4f) -> vec3f {
    let aside = cross(b.xyz, c.xyz);
    return (a.w * aside + b.w * cross(c.xyz, a.xyz) + c.w * cross(a.xyz, b.xyz)) / dot(a.xyz, aside);
}

// The body around all of a bundle's wedges; false where there is no such body.
fn surround(members: vec4u, made: ptr<function, Bundle>) -> bool {
    let middle = 0.25 * (middle_of(members.x) + middle_of(members.y) + middle_of(members.z) + middle_of(members.w));
    let main = -normalize(way_to_light(light, middle));
    let aside = normalize(cross(main, select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(main.x) > 0.7)));
    let along = cross(main, aside);
    let sides = span_of_all(members, main, aside);
    let ends = span_of_all(members, main, along);
    if !(sides.x < sides.y) || !(ends.x < ends.y) {
        return false;
    }
    var normals = array<vec3f, 4>(
        main * cos(sides.x) + aside * sin(sides.x),
        main * cos(sides.y) + aside * sin(sides.y),
        main * cos(ends.x) + along * sin(ends.x),
        main * cos(ends.y) + along * sin(ends.y),
    );
    // Relative to the middle, so that little is rounded.
    var planes: array<vec4f, 4>;
    for (var i = 0u; i < 4u; i++) {
        planes[i] = vec4f(normals[i], least(members, normals[i], middle) * (1.0 + SLACK));
    }
    // Front and back meet in the body's near edge, or else low and high do.
    if dot(normals[3], meet(planes[0], planes[1], planes[2])) < planes[3].w {
        planes = array<vec4f, 4>(planes[2], planes[3], planes[1], planes[0]);
        normals = array<vec3f, 4>(normals[2], normals[3], normals[1], normals[0]);
    }
    let rays = rays_of(normals);
    let near_low = middle + meet(planes[0], planes[1], planes[2]);
    let near_high = middle + meet(planes[0], planes[1], planes[3]);
    let inwards = normals[0] + normals[1];
    let starts = array<vec3f, 2>(corner_of(near_low, inwards + normals[2]), corner_of(near_high, inwards + normals[3]));
    let ways = ways_of(rays);
    (*made).corners = corners_of(starts, ways, end_of(starts, ways, light.low.xyz, light.high.xyz));
    (*made).members = members;
    return lie_within(rays, normals);
}

// Of wedges one after the other.
fn bundle_window(first: u32) {
    var free = 0u;
    for (var i = 0u; i < WINDOW; i++) {
        if has_body(first + i) {
            free |= 1u << i;
        } else if any(wedges[first + i].weights != vec2f(0.0)) {
            draw_alone(first + i);
        }
    }
    while free != 0u {
        let seed = firstTrailingBit(free);
        free &= ~(1u << seed);
        var members = vec4u(first + seed);
        var left = free;
        var made: Bundle;
        var is_bundle = countOneBits(free) >= BUNDLE - 1u;
        if is_bundle {
            for (var i = 1u; i < BUNDLE; i++) {
                let next = nearest(first, left, middle_of(members.x));
                left &= ~(1u << next);
                members[i] = first + next;
            }
            is_bundle = is_worth_it(members) && surround(members, &made);
        }
        if is_bundle {
            draw_together(made);
            free = left;
        } else {
            draw_alone(members.x);
        }
    }
}

@compute @workgroup_size(64)
fn make(@builtin(num_workgroups) groups: vec3u, @builtin(global_invocation_id) thread: vec3u) {
    let end = atomicLoad(&draws[1]) * GROUP;
    for (var first = WINDOW * thread.x; first < end; first += WINDOW * 64u * groups.x) {
        bundle_window(first);
    }
}
