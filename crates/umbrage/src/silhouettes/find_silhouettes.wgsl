// needs: edges
// Finds the edges that bound shadows and the triangles that cap them, and lists them for indirect
// draws.

struct FindSilhouettes {
    edge_chunks: u32,
    triangle_chunks: u32,
    // A side that counts twice is listed once where counters take weights, else twice.
    weighted: u32,
    pad: u32,
}

// Header, chunks and entries, see `HEADER`.
@group(0) @binding(1) var<storage, read_write> list: array<atomic<u32>>;
// Arguments of three indexed indirect draws.
@group(0) @binding(2) var<storage, read_write> draws: array<u32, 15>;
@group(0) @binding(3) var<uniform> find: FindSilhouettes;

const CAPS: u32 = 2u;

fn append(part: u32, entry: u32, times: u32) {
    let at = atomicLoad(&list[2u * part]) + atomicAdd(&list[2u * part + 1u], times);
    for (var i = 0u; i < times; i++) {
        atomicStore(&list[at + i], entry);
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
    let caster = atomicLoad(&list[HEADER + chunk]);
    let edge = (chunk - casters[caster].edge_chunk) * CHUNK + place;
    if edge >= casters[caster].edge_count {
        return;
    }
    let times = multiplicity(caster, pairs[casters[caster].first_edge + edge]);
    if times == 0 {
        return;
    }
    let part = u32((casters[caster].flags & Z_FAIL) != 0u);
    append(part, side_entry(chunk * CHUNK + place, times), select(u32(abs(times)), 1u, find.weighted != 0u));
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
    let caster = atomicLoad(&list[HEADER + chunk]);
    let triangle = (chunk - casters[caster].triangle_chunk) * CHUNK + place;
    if triangle >= casters[caster].triangle_count {
        return;
    }
    let plane = plane_at(casters[caster].first_triangle + triangle);
    let f = facing(plane, casters[caster].light);
    // A triangle without area has no plane and covers nothing.
    if all(plane.xyz == vec3f(0.0)) || (f > 0 && (casters[caster].flags & AWAY) != 0u) {
        return;
    }
    append(CAPS, cap_entry(chunk * CHUNK + place, f < 0), 1u);
}

// Each instance draws a group of entries.
@compute @workgroup_size(3)
fn group_entries(@builtin(local_invocation_index) part: u32) {
    draws[5u * part + 1u] = (atomicLoad(&list[2u * part + 1u]) + CHUNK - 1u) / CHUNK;
}
