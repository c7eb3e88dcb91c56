// What the passes of the blur share.

struct Blur {
    // Change of depth where a surface is as far off its plane as a pixel is wide: times the depth,
    // and constant.
    pixel_depth: vec2f,
    // Rounding of depth, in the same way.
    rounding: vec2f,
    ndc_from_pixel: vec2f,
    // What the depth buffer holds where nothing was drawn.
    background_depth: f32,
    // Pixels across and down a tile.
    tile: u32,
}

// Tiles that are blurred from the start on; from the end on those above and below them, which are
// only read.
struct TileList {
    blurred: u32,
    beside: u32,
    tiles: array<u32>,
}

// Pixels across and down a block; a tile is two across and down.
override BLOCK: u32 = 4u;

// What stands for the darkness of what faces away from the light: it neither is blurred nor darkens
// what faces it.
const OWN_SHADOW: f32 = 6.103515625e-5;

// Tiles across and down from the corner of the picture.
fn tile_at(entry: u32) -> vec2u {
    return vec2u(entry & 0xffffu, entry >> 16u);
}
