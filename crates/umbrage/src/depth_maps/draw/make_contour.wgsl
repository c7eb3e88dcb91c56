// needs: extrude, contour_record
// Puts the edges that were listed into world space, each once for all corners and layers that it is
// drawn with.

@group(2) @binding(0) var<storage, read_write> contour: array<ContourRecord>;

@compute @workgroup_size(64)
fn make_contour(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) place: u32,
) {
    let chunk = group.x + group.y * groups.x;
    let at = chunk * CHUNK + place;
    // A draw takes whole chunks.
    if chunk * CHUNK >= list[1] || at >= arrayLength(&contour) {
        return;
    }
    let entry = listed(place * 4u, chunk, 4u);
    if entry == NO_ENTRY {
        contour[at] = ContourRecord(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
        return;
    }
    let slot = entry >> 2u;
    let caster = list[HEADER + slot / CHUNK];
    let number = casters[caster].first_edge + slot - casters[caster].edge_chunk * CHUNK;
    let edge = edges[number];
    let pair = pairs[number];
    let is_turned = ((entry & 1u) != 0u) != ((casters[caster].flags & MIRRORED) != 0u);
    let start = light_corner(caster, select(start_of(edge), edge.end, is_turned));
    let end = light_corner(caster, select(edge.end, start_of(edge), is_turned));
    let other = pair.second & ~SAME_DIRECTION;
    let is_there = has_area(pair.first) || (other != NO_TRIANGLE && has_area(other));
    let times = select(1.0, 2.0, (entry & 2u) != 0u);
    contour[at] = ContourRecord(start, select(0.0, times, is_there), end, 0.0);
}

// A triangle without area has no plane and shadows nothing, whatever its edges are.
fn has_area(triangle: u32) -> bool {
    return any(normal_of(triangle) != vec3f(0.0));
}
