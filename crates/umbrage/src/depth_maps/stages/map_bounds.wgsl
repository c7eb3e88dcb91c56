// needs: map_cells
// Nearest depths of ever larger cells of a map: level 0 from the map, each further one from 2 × 2
// cells of the one before. Cells that lie beyond the map repeat its border.

struct MapBoundsPass {
    layer: u32,
    level: u32,
}

// Threads across and down.
const WORKGROUP: u32 = 8u;

@group(0) @binding(0) var map_level: texture_depth_2d_array;
@group(0) @binding(1) var<storage, read_write> bounds: MapBounds;
@group(0) @binding(2) var<uniform> bounds_pass: MapBoundsPass;

@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn bounds_of_map(@builtin(global_invocation_id) cell: vec3u) {
    if any(cell.xy >= vec2u(bounds.head.cells)) {
        return;
    }
    let width = 1u << bounds.head.finest;
    let last = textureDimensions(map_level) - 1u;
    var nearest = 0.0;
    for (var y = 0u; y < width; y++) {
        for (var x = 0u; x < width; x++) {
            let texel = min(cell.xy * width + vec2u(x, y), last);
            nearest = max(nearest, textureLoad(map_level, texel, bounds_pass.layer, 0));
        }
    }
    bounds.nearest[cell_index(bounds.head, bounds_pass.layer, 0u, cell.xy)] = nearest;
}

@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn bounds_of_bounds(@builtin(global_invocation_id) cell: vec3u) {
    if any(cell.xy >= vec2u(bounds.head.cells >> bounds_pass.level)) {
        return;
    }
    let below = cell_index(bounds.head, bounds_pass.layer, bounds_pass.level - 1u, 2u * cell.xy);
    let row = bounds.head.cells >> (bounds_pass.level - 1u);
    let upper = max(bounds.nearest[below], bounds.nearest[below + 1u]);
    let lower = max(bounds.nearest[below + row], bounds.nearest[below + row + 1u]);
    bounds.nearest[cell_index(bounds.head, bounds_pass.layer, bounds_pass.level, cell.xy)] = max(upper, lower);
}
