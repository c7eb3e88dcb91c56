// needs: instances, edges, area_light, record
// Makes the caps of casters that are counted from infinity: their triangles, and where the
// triangles' shadows end.

struct CapChunk {
    caster: u32,
    // Its triangles from this one on.
    first: u32,
}

@group(1) @binding(2) var<storage, read> positions: array<f32>;
@group(1) @binding(3) var<storage, read> indices: array<u32>;
@group(1) @binding(4) var<storage, read> instances: array<Instance>;
@group(2) @binding(0) var<uniform> light: AreaLight;
@group(2) @binding(1) var<storage, read> cap_chunks: array<CapChunk>;
@group(2) @binding(2) var<storage, read_write> caps: array<Cap>;

fn corner(caster: u32, triangle: u32, k: u32) -> vec3f {
    let index = casters[caster].first_index + 3u * triangle + k;
    let at = 3u * (casters[caster].base_vertex + indices[index]);
    let p = vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
    return world_from_mesh(casters[caster].instance, p) + light.eye_from_origin;
}

// On the sides of bodies that a triangle belongs to, see `Wedge`.
fn weights_of(caster: u32, faces_light: bool) -> vec2f {
    let both = (casters[caster].flags & BODY) == 0u;
    return vec2f(f32(both || faces_light), f32(both || !faces_light));
}

// From where the light's shadows are cast: a place, or a direction, relative to the eye.
fn source(caster: u32) -> vec3f {
    return light.center + from_light(light, casters[caster].seen_from);
}

fn cap_of(caster: u32, triangle: u32, faces_light: bool, weights: vec2f) -> Cap {
    let l = source(caster);
    let end = casters[caster].end;
    let dark = vec4f(end.xyz, end.w + dot(end.xyz, light.eye_from_origin));
    var cap: Cap;
    var corners: array<vec3f, 3>;
    for (var k = 0u; k < 3u; k++) {
        corners[k] = corner(caster, triangle, k);
    }
    // As edges are turned, whatever is rounded.
    let turned = faces_light == ((casters[caster].flags & MIRRORED) != 0u);
    for (var k = 0u; k < 3u; k++) {
        let p = corners[select(k, (3u - k) % 3u, turned)];
        cap.lit[k] = vec4f(p, 1.0);
        cap.dark[k] = run(p, select(p - l, -l, light.parallel != 0u), dark);
    }
    let normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    let away = normalize(select(-normal, normal, turned));
    cap.plane = vec4f(away, dot(away, corners[0]));
    cap.weights = weights;
    // Corners are sums of what is relative to the middle of the scene and of the way from there to
    // the eye.
    let sizes = abs(corners[0]) + abs(corners[1]) + abs(corners[2]) + abs(light.eye_from_origin);
    cap.off = 2.0 * light.rounding * (sizes.x + sizes.y + sizes.z);
    return cap;
}

@compute @workgroup_size(64)
fn make(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u, @builtin(local_invocation_index) place: u32) {
    let number_of_chunk = group.x + group.y * groups.x;
    if number_of_chunk >= light.cap_chunks {
        return;
    }
    let chunk = cap_chunks[number_of_chunk];
    let cap = number_of_chunk * CHUNK + place;
    caps[cap].weights = vec2f(0.0);
    let triangle = chunk.first + place;
    if triangle >= casters[chunk.caster].triangle_count {
        return;
    }
    let number = casters[chunk.caster].first_triangle + triangle;
    let plane = plane_at(number);
    if any(plane.xyz != vec3f(0.0)) && share(chunk.caster, number) != 0 {
        let faces_light = facing(plane, casters[chunk.caster].light) > 0;
        caps[cap] = cap_of(chunk.caster, triangle, faces_light, weights_of(chunk.caster, faces_light));
    }
}
