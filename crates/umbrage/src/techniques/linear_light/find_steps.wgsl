// needs: step_list
// Finds where depth in a map steps from a blocker to what is behind it, and lists the pieces of
// the border between both: at most one for each pair of sides of a cell of 2 × 2 texels.

struct FindSteps {
    layers: array<vec4u, 2>,
    // Least step, as a share of the distance from the light to the blocker.
    threshold: f32,
    // Entries that the list holds.
    room: u32,
    pad: vec2u,
}

struct FoundSteps {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
    found: atomic<u32>,
    pad: vec2u,
    entries: array<vec2u>,
}

@group(0) @binding(0) var map: texture_depth_2d_array;
@group(0) @binding(1) var<storage, read_write> steps: FoundSteps;
@group(0) @binding(2) var<uniform> find: FindSteps;

// Threads across and down, and cells of each.
const WORKGROUP: u32 = 8u;
const BLOCK: u32 = 4u;

fn depth_at(texel: vec2i, layer: u32) -> f32 {
    let last = vec2i(textureDimensions(map)) - 1;
    return textureLoad(map, clamp(texel, vec2i(0), last), layer, 0);
}

// 1 where depth steps from a blocker at `from` to a receiver at `to`, −1 where it does so the other
// way, and 0 where both may be on one surface: planes stay planes in a map, so a steep one
// continues as it came.
fn step_between(before: f32, start: f32, end: f32, after: f32) -> i32 {
    let farther = min(start, end);
    let least = find.threshold * farther;
    let off = min(abs(end - 2.0 * start + before), abs(start - 2.0 * end + after));
    if abs(end - start) <= least || off <= least {
        return 0;
    }
    return select(-1, 1, start > end);
}

fn append(entry: vec2u) {
    let at = atomicAdd(&steps.found, 1u);
    if at < find.room {
        steps.entries[at] = entry;
    }
}

fn find_in_cell(cell: vec2u, layer: u32) {
    var turns: array<i32, 4>;
    for (var k = 0u; k < 4u; k++) {
        let start = vec2i(corner_of(cell, k));
        let end = vec2i(corner_of(cell, k + 1u));
        let way = end - start;
        turns[k] = step_between(
            depth_at(start - way, layer),
            depth_at(start, layer),
            depth_at(end, layer),
            depth_at(end + way, layer),
        );
    }
    // Each way down is joined to the next way up, and a way up that is left to the way down before.
    var joined: array<bool, 4>;
    for (var k = 0u; k < 4u; k++) {
        if turns[k] != 1 {
            continue;
        }
        for (var i = 1u; i < 4u; i++) {
            let up = (k + i) & 3u;
            if turns[up] == -1 {
                append(packed(cell, layer, k, up));
                joined[up] = true;
                break;
            }
        }
    }
    for (var k = 0u; k < 4u; k++) {
        if turns[k] != -1 || joined[k] {
            continue;
        }
        for (var i = 1u; i < 4u; i++) {
            let down = (k + 4u - i) & 3u;
            if turns[down] == 1 {
                append(packed(cell, layer, down, k));
                break;
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn find_steps(@builtin(global_invocation_id) id: vec3u) {
    let first = id.xy * BLOCK;
    let last = textureDimensions(map) - 1u;
    if any(first >= last) {
        return;
    }
    let layer = find.layers[id.z >> 2u][id.z & 3u];
    var nearest = 0.0;
    var farthest = 1.0;
    for (var y = 0u; y <= BLOCK; y++) {
        for (var x = 0u; x <= BLOCK; x++) {
            let depth = textureLoad(map, min(first + vec2u(x, y), last), layer, 0);
            nearest = max(nearest, depth);
            farthest = min(farthest, depth);
        }
    }
    // Most blocks hold no step at all.
    if nearest <= farthest * (1.0 + find.threshold) {
        return;
    }
    for (var y = first.y; y < min(first.y + BLOCK, last.y); y++) {
        for (var x = first.x; x < min(first.x + BLOCK, last.x); x++) {
            find_in_cell(vec2u(x, y), layer);
        }
    }
}

@compute @workgroup_size(1)
fn group_steps() {
    let count = min(atomicLoad(&steps.found), find.room);
    steps.index_count = GROUP * INDICES;
    steps.instance_count = (count + GROUP - 1u) / GROUP;
}
