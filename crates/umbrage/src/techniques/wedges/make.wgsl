// needs: instances, edges, area_light, record, body
// Builds the wedge of every silhouette edge that was listed: see `wedge` in the core crate.

@group(0) @binding(1) var<storage, read> list: array<u32>;
@group(1) @binding(2) var<storage, read> positions: array<f32>;
@group(1) @binding(4) var<storage, read> instances: array<Instance>;
@group(2) @binding(0) var<uniform> light: AreaLight;
@group(2) @binding(1) var<storage, read_write> wedges: array<Wedge>;
@group(2) @binding(2) var<storage, read_write> draw: array<u32, 20>;

// Wedges that an instance draws.
const GROUP: u32 = 64u;

// Depth that is behind everything.
override FAR: f32 = 0.0;

fn place(caster: u32, vertex: u32) -> vec3f {
    let at = 3u * vertex;
    let p = vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
    return world_from_mesh(casters[caster].instance, p) + light.eye_from_origin;
}

fn no_wedge() -> Wedge {
    var wedge: Wedge;
    wedge.weights = vec2f(0.0);
    for (var i = 0u; i < 6u; i++) {
        wedge.corners[i] = vec4f(4.0, 4.0, 0.0, 1.0);
    }
    return wedge;
}

// Covers the screen: corners of the far face are those of the screen, turned to be seen from
// within, all others fall together.
fn everywhere(wedge: ptr<function, Wedge>) {
    for (var i = 0u; i < 4u; i++) {
        (*wedge).planes[i] = vec4f(0.0, 0.0, 0.0, -1.0);
    }
    // Larger than the screen, which the last pixels of a small buffer go beyond.
    (*wedge).corners[5] = vec4f(-2.0, -2.0, FAR, 1.0);
    (*wedge).corners[4] = vec4f(-2.0, 2.0, FAR, 1.0);
    (*wedge).corners[2] = vec4f(2.0, 2.0, FAR, 1.0);
    (*wedge).corners[3] = vec4f(2.0, -2.0, FAR, 1.0);
    (*wedge).corners[0] = (*wedge).corners[2];
    (*wedge).corners[1] = (*wedge).corners[4];
}

// In light space; false where no such body holds the wedge.
fn body(a: vec3f, b: vec3f, wedge: ptr<function, Wedge>) -> bool {
    let away_a = -way_to_light(light, normalize(a));
    let away_b = -way_to_light(light, normalize(b));
    var main = away_a + away_b;
    let edge_length = length(b - a);
    if !(length(main) > 1e-3) || !(edge_length > 0.0) {
        return false;
    }
    main = normalize(main);
    let edge = (b - a) / edge_length;
    var aside = cross(edge, main);
    if dot(aside, aside) < 1e-10 {
        aside = select(cross(main, vec3f(1.0, 0.0, 0.0)), cross(main, vec3f(0.0, 1.0, 0.0)), abs(main.x) > 0.7);
    }
    aside = normalize(aside);
    let along = cross(main, aside);
    let ends = array<vec3f, 2>(a, b);
    let across_ends = span(main, along, ends);
    if !(across_ends.x < across_ends.y) {
        return false;
    }
    let low = main * cos(across_ends.x) + along * sin(across_ends.x);
    let high = main * cos(across_ends.y) + along * sin(across_ends.y);
    let near_low = select(b, a, dot(low, a - b) <= 0.0);
    let near_high = select(b, a, dot(high, a - b) <= 0.0);
    var axis = away_a;
    var held = ends;
    if any(near_low != near_high) {
        axis = normalize(main - edge * dot(main, edge));
        held = array<vec3f, 2>(a, a);
    } else if all(near_low == b) {
        axis = away_b;
    }
    let sides = span(axis, aside, held);
    if !(sides.x < sides.y) {
        return false;
    }
    let front = axis * cos(sides.x) + aside * sin(sides.x);
    let back = axis * cos(sides.y) + aside * sin(sides.y);
    let normals = array<vec3f, 4>(front, back, low, high);
    let rays = rays_of(normals);
    if !lie_within(rays, normals) {
        return false;
    }
    for (var i = 0u; i < 4u; i++) {
        let least = min(dot(normals[i], a), dot(normals[i], b));
        (*wedge).planes[i] = vec4f(normals[i], least - SLACK * 0.01 * abs(least));
    }
    let starts = array<vec3f, 2>(corner_of(near_low, low + front + back), corner_of(near_high, high + front + back));
    let ways = ways_of(rays);
    let end = end_of(starts, ways, light.low.xyz, light.high.xyz);
    let corners = corners_of(starts, ways, end);
    for (var i = 0u; i < 6u; i++) {
        (*wedge).corners[i] = corners[i];
    }
    return true;
}

// The plane through an edge and the place where its silhouette is seen from, relative to the eye,
// where differences are small near the eye and the light may be far away. Zero for an edge in line
// with the light, or without length, which has no side.
fn plane_of(wedge: ptr<function, Wedge>) -> vec4f {
    let start = (*wedge).eye_start;
    let seen_from = light.center + from_light(light, (*wedge).anchor.place);
    let way = select(seen_from - start, seen_from, light.parallel != 0u);
    let normal = light.handed * normalize(cross(way, (*wedge).eye_end - start));
    if !all(normal == normal) {
        return vec4f(0.0);
    }
    // Of places in the plane the one nearest to the eye, which is the least rounded.
    var place = select(start, (*wedge).eye_end, dot((*wedge).eye_end, (*wedge).eye_end) < dot(start, start));
    if light.parallel == 0u && dot(seen_from, seen_from) < dot(place, place) {
        place = seen_from;
    }
    return vec4f(normal, dot(normal, place));
}

// Of the sum of both sides of a body, which the list goes by, each one's part. All triangles of a
// body count: of those on both sides of an edge one faces the light and one faces away; others all
// face the light or, where the edge is turned, away.
fn weights_of(caster: u32, edge: Edge, entry: u32) -> vec2f {
    let times = select(1.0, 2.0, (entry & 2u) != 0u);
    if (casters[caster].flags & BODY) == 0u {
        return vec2f(times);
    }
    let of_one_side = select(vec2f(times, 0.0), vec2f(0.0, times), (entry & 1u) != 0u);
    return select(vec2f(1.0), of_one_side, (edge.start & ONE_WAY) != 0u);
}

@compute @workgroup_size(64)
fn make(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u, @builtin(local_invocation_index) place_in: u32) {
    let number = (group.x + group.y * groups.x) * GROUP + place_in;
    let found = list[1];
    let first = light.first_wedge;
    let count = min(found - min(found, first), light.most_wedges);
    let used = (count + GROUP - 1u) / GROUP;
    if number == 0u {
        draw[1] = used;
        draw[16] = used;
    }
    if number >= used * GROUP {
        return;
    }
    if number >= count {
        wedges[number] = no_wedge();
        return;
    }
    let entry = list[list[0] + first + number];
    let slot = entry >> 2u;
    let caster = list[HEADER + slot / CHUNK];
    let edge = edges[casters[caster].first_edge + slot - casters[caster].edge_chunk * CHUNK];
    let is_turned = ((entry & 1u) != 0u) != ((casters[caster].flags & MIRRORED) != 0u);
    let one = place(caster, start_of(edge));
    let other = place(caster, edge.end);
    var wedge: Wedge;
    wedge.eye_start = select(one, other, is_turned);
    wedge.eye_end = select(other, one, is_turned);
    wedge.weights = weights_of(caster, edge, entry);
    let a = to_light(light, wedge.eye_start);
    let b = to_light(light, wedge.eye_end);
    wedge.start = a;
    wedge.end = b;
    wedge.anchor = Anchor(casters[caster].seen_from, 0.0, casters[caster].axis, 0.0);
    wedge.plane = plane_of(&wedge);
    wedge.eye_inside = f32(dot(wedge.plane.xyz, light.toward_eye) >= wedge.plane.w * light.eye_w);
    wedge.from_infinity = f32((casters[caster].flags & COUNT_FROM_INFINITY) != 0u);
    let end = casters[caster].end;
    wedge.dark = vec4f(end.xyz, end.w + dot(end.xyz, light.eye_from_origin));
    if !body(a, b, &wedge) {
        everywhere(&wedge);
    }
    wedges[number] = wedge;
}
