// needs: head
// Puts blurred tiles into the visibility target.

@group(0) @binding(0) var<uniform> blur: Blur;
@group(0) @binding(1) var<storage, read> list: TileList;
@group(0) @binding(2) var blurred: texture_2d<u32>;

// Tiles that an instance draws.
const TILES: u32 = 64u;

// Two triangles a tile.
@vertex
fn fullscreen(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> @builtin(position) vec4f {
    let place = group * TILES + vertex / 6u;
    if place >= list.blurred {
        // Off the screen.
        return vec4f(2.0, 2.0, 0.0, 1.0);
    }
    let corner = vertex % 6u;
    let step = vec2u(u32(corner == 1u || corner >= 4u), u32(corner == 2u || corner == 3u || corner == 5u));
    let tile = tile_at(list.tiles[place]) + step;
    return vec4f(vec2f(blur.tile * tile) * blur.ndc_from_pixel + vec2f(-1.0, 1.0), 0.0, 1.0);
}

@fragment
fn result(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = vec2u(at.xy);
    let word = textureLoad(blurred, pixel / 2u, 0).x;
    let place = (pixel.x & 1u) + 2u * (pixel.y & 1u);
    let value = (word >> (8u * place)) & 0xffu;
    return f32(max(value, 1u) - 1u) / 254.0;
}
