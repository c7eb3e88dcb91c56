// Finds the edges that bound shadows and the triangles that cap them, and lists them for indirect draws.

struct FindSilhouettes {
    edge_chunks: u32,
    triangle_chunks: u32,
    // Of sides counted by z-pass, and by z-fail.
    vertices_per_side: vec2u,
    vertices_per_cap: u32,
    // A side that counts twice is listed once where counters take weights, else twice.
    weighted: u32,
    pad_a: u32,
    pad_b: u32,
}

struct DrawArguments {
    vertex_count: atomic<u32>,
    instance_count: u32,
    first_vertex: u32,
    first_instance: u32,
}

@group(0) @binding(2) var<storage, read_write> list: array<u32>;
// Sides counted by z-pass, sides counted by z-fail, caps.
@group(0) @binding(3) var<storage, read_write> draws: array<DrawArguments, 3>;
@group(0) @binding(4) var<uniform> find: FindSilhouettes;

const CAPS: u32 = 2u;

fn append(draw: u32, vertices: u32, entry: u32, times: u32) {
    let before = atomicAdd(&draws[draw].vertex_count, vertices * times);
    let at = (draws[draw].first_vertex + before) / vertices;
    for (var i = 0u; i < times; i++) {
        list[at + i] = entry;
    }
}

@compute @workgroup_size(64)
fn find_sides(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) place: u32,
) {
    let chunk = group.x + group.y * groups.x;
    if chunk >= find.edge_chunks {
        return;
    }
    let caster = chunks[chunk];
    let edge = (chunk - casters[caster].edge_chunk) * CHUNK + place;
    if edge >= casters[caster].edge_count {
        return;
    }
    let times = multiplicity(caster, edges[casters[caster].first_edge + edge]);
    if times == 0 {
        return;
    }
    let draw = u32((casters[caster].flags & Z_FAIL) != 0u);
    let entries = select(u32(abs(times)), 1u, find.weighted != 0u);
    append(draw, find.vertices_per_side[draw], side_entry(chunk * CHUNK + place, times), entries);
}

@compute @workgroup_size(64)
fn find_caps(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) place: u32,
) {
    let own = group.x + group.y * groups.x;
    if own >= find.triangle_chunks {
        return;
    }
    let chunk = find.edge_chunks + own;
    let caster = chunks[chunk];
    let triangle = (chunk - casters[caster].triangle_chunk) * CHUNK + place;
    if triangle >= casters[caster].triangle_count {
        return;
    }
    let plane = planes[casters[caster].first_triangle + triangle];
    let f = facing(plane, casters[caster].light);
    // A triangle without area has no plane and covers nothing.
    if all(plane.xyz == vec3f(0.0)) || (f > 0 && (casters[caster].flags & AWAY) != 0u) {
        return;
    }
    append(CAPS, find.vertices_per_cap, cap_entry(chunk * CHUNK + place, f < 0), 1u);
}
