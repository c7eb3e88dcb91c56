// The pyramid of nearest depths: for each layer all its levels one after the other, the finest
// first.

struct MapBoundsHead {
    // Cells of level 0 a side, a power of two.
    cells: u32,
    // Base 2 logarithm of their width in texels.
    finest: u32,
    levels: u32,
    pad: u32,
}

struct MapBounds {
    head: MapBoundsHead,
    nearest: array<f32>,
}

fn cell_index(head: MapBoundsHead, layer: u32, level: u32, cell: vec2u) -> u32 {
    let all = head.cells * head.cells;
    let row = head.cells >> level;
    // Levels have a quarter of the cells of the one before: (all − row²) · 4 / 3 before this one,
    // (4 all − 1) / 3 in a layer.
    return layer * ((4u * all - 1u) / 3u) + (all - row * row) / 3u * 4u + cell.y * row + cell.x;
}
