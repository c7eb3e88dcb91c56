// Looks at triangles one by one: counts the shadows that the eye is in, of triangles that throw one and lie between eye and light, and lists
// surfaces that the eye may see through, since counting from the eye takes them to end what it sees.

struct Chunk {
    caster: u32,
    // Its triangles from this one on.
    first: u32,
    // Where they count, see `eye_count`.
    slot: u32,
    todo: u32,
}

// They may be between eye and light.
const COUNTS: u32 = 1u;
// Only what the near plane may cut is seen through.
const NEAR_ALONE: u32 = 2u;

@group(1) @binding(2) var<storage, read> positions: array<f32>;
@group(1) @binding(3) var<storage, read> indices: array<u32>;
@group(1) @binding(4) var<storage, read> instances: array<Instance>;
@group(2) @binding(0) var<uniform> light: WedgeLight;
// Those with surfaces that are seen through first.
@group(2) @binding(1) var<storage, read> surfaces: array<Chunk>;
// Of each slot two, see `Wedge::weights`. The first slot is that of all casters that are not drawn apart.
@group(2) @binding(2) var<storage, read_write> eye_count: array<atomic<u32>>;
// Of casters, if the light is split.
@group(2) @binding(3) var<storage, read> anchors: array<Anchor>;
// Of the first chunks one after the other; there is room for no more.
@group(2) @binding(4) var<storage, read_write> caps: array<Cap>;

override SPLIT: bool = false;

fn corner(caster: u32, triangle: u32, k: u32) -> vec3f {
    let index = casters[caster].first_index + 3u * triangle + k;
    let at = 3u * (casters[caster].base_vertex + indices[index]);
    let p = vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
    return world_from_mesh(casters[caster].instance, p) + light.eye_from_origin;
}

// On the sides of bodies that a triangle belongs to, see `Wedge`.
fn weights_of(caster: u32, number: u32) -> vec2f {
    let both = (casters[caster].flags & BODY) == 0u;
    let faces_light = facing(planes[number], casters[caster].light) > 0;
    return vec2f(f32(both || faces_light), f32(both || !faces_light));
}

// From where the light's shadows are thrown: a place, or a direction, relative to the eye.
fn source(caster: u32) -> vec3f {
    if SPLIT {
        return light.center + from_light(light, anchors[caster].place);
    }
    return light.center + from_light(light, middle(light));
}

// Whether the segment from the eye, which is the origin, to the light crosses the triangle.
fn is_before_eye(corners: array<vec3f, 3>, l: vec3f) -> bool {
    let a = corners[0];
    let b = corners[1];
    let c = corners[2];
    let sides = vec3f(dot(cross(a, b), l), dot(cross(b, c), l), dot(cross(c, a), l));
    // It meets the plane at this share of the way to the light.
    let t = dot(cross(a, b), c) / (sides.x + sides.y + sides.z);
    let is_crossed = all(sides >= vec3f(0.0)) || all(sides < vec3f(0.0));
    return is_crossed && t > 0.0 && (t < 1.0 || light.parallel != 0u);
}

fn is_near(corners: array<vec3f, 3>) -> bool {
    let low = min(min(corners[0], corners[1]), corners[2]);
    let high = max(max(corners[0], corners[1]), corners[2]);
    return all(low <= light.near_high.xyz) && all(high >= light.near_low.xyz);
}

fn cap_of(corners: array<vec3f, 3>, l: vec3f, weights: vec2f) -> Cap {
    let normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    let turned = dot(normal, select(l - corners[0], l, light.parallel != 0u)) < 0.0;
    let a = to_light(light, corners[0]);
    let n = normalize(cross(to_light(light, corners[1]) - a, to_light(light, corners[2]) - a));
    let towards = to_light(light, light.center + l);
    let lit = dot(n, select(to_light(light, l) - a, towards, light.parallel != 0u)) > 0.0;
    let away = select(n, -n, lit);
    var cap: Cap;
    cap.corners[0] = vec4f(corners[0], 1.0);
    cap.corners[1] = vec4f(select(corners[1], corners[2], turned), 1.0);
    cap.corners[2] = vec4f(select(corners[2], corners[1], turned), 1.0);
    cap.plane = vec4f(away, dot(away, a));
    cap.weights = weights;
    return cap;
}

@compute @workgroup_size(64)
fn look(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u, @builtin(local_invocation_index) place: u32) {
    let number_of_chunk = group.x + group.y * groups.x;
    if number_of_chunk >= light.chunks {
        return;
    }
    let chunk = surfaces[number_of_chunk];
    let cap_number = number_of_chunk * CHUNK + place;
    let has_cap = cap_number < arrayLength(&caps);
    if has_cap {
        caps[cap_number].weights = vec2f(0.0);
    }
    let triangle = chunk.first + place;
    if triangle >= casters[chunk.caster].triangle_count {
        return;
    }
    let number = casters[chunk.caster].first_triangle + triangle;
    if all(planes[number].xyz == vec3f(0.0)) || share(chunk.caster, number) == 0 {
        return;
    }
    let corners =
        array<vec3f, 3>(corner(chunk.caster, triangle, 0u), corner(chunk.caster, triangle, 1u), corner(chunk.caster, triangle, 2u));
    let l = source(chunk.caster);
    let weights = weights_of(chunk.caster, number);
    if (chunk.todo & COUNTS) != 0u && is_before_eye(corners, l) {
        atomicAdd(&eye_count[2u * chunk.slot], u32(weights.x));
        atomicAdd(&eye_count[2u * chunk.slot + 1u], u32(weights.y));
    }
    if has_cap && ((chunk.todo & NEAR_ALONE) == 0u || is_near(corners)) {
        caps[cap_number] = cap_of(corners, l, weights);
    }
}
