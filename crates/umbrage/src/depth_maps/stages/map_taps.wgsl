// needs: map_lookup
// Taps: where filters look into the map. Every pixel has a set of them, the first few on the rim.

// Sets of taps, and which one each pixel of a tile takes.
struct TapsHead {
    // Pixels across and down after which sets repeat; 0 chooses by interleaved gradient noise
    // (Jimenez 2014).
    tile: u32,
    sets: u32,
    count: u32,
    // They fill a square in place of a disc.
    is_square: u32,
}

// Pixels of the largest tile.
const TILE_PIXELS: u32 = 1024u;

struct Taps {
    head: TapsHead,
    set_of_pixel: array<u32, TILE_PIXELS>,
    offsets: array<vec2f>,
}

@group(2) @binding(0) var<storage, read> taps: Taps;

// Index of a pixel's first tap.
fn first_tap(pixel: vec2f) -> u32 {
    let at = pixel + vec2f(map.jitter % 64.0, floor(map.jitter / 64.0));
    if taps.head.tile == 0u {
        return min(u32(gradient_noise(at) * f32(taps.head.sets)), taps.head.sets - 1u) * taps.head.count;
    }
    let cell = vec2u(at) % vec2u(taps.head.tile);
    return taps.set_of_pixel[cell.y * taps.head.tile + cell.x] * taps.head.count;
}

// What the texel says that lies `offset` away from the receiver: its own offset, and its depth.
struct Stored {
    offset: vec2f,
    depth: f32,
}

fn stored_near(point: MapPoint, offset: vec2f) -> Stored {
    let texel = clamp(floor(point.texel + offset), vec2f(0.0), vec2f(map.size - 1.0));
    return Stored(texel + 0.5 - point.texel, load_depth(vec2i(texel), point.layer));
}
