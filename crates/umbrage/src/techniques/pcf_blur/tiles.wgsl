// Finds the tiles around which visibility differs. A tile is two blocks across and down, a block no less than the radius.

struct TileCounts {
    blurred: atomic<u32>,
    beside: atomic<u32>,
    tiles: array<u32>,
}

@group(0) @binding(0) var source: texture_2d<f32>;
// The value of each block, or MIXED.
@group(0) @binding(1) var<storage, read_write> blocks: array<f32>;
@group(0) @binding(2) var<storage, read_write> list: TileCounts;
// Arguments of two indirect draws.
@group(0) @binding(3) var<storage, read_write> draws: array<u32, 8>;

// Pixels across and down a block.
override BLOCK: i32 = 4;

const MIXED: f32 = -1.0;
const GROUP: u32 = 64u;

fn block_count() -> vec2i {
    return (vec2i(textureDimensions(source)) + BLOCK - 1) / BLOCK;
}

@compute @workgroup_size(8, 8)
fn find_blocks(@builtin(global_invocation_id) id: vec3u) {
    let block = vec2i(id.xy);
    let count = block_count();
    if any(block >= count) {
        return;
    }
    let last = vec2i(textureDimensions(source)) - 1;
    let first = block * BLOCK;
    let value = textureLoad(source, first, 0).x;
    var is_mixed = false;
    for (var y = 0; y < BLOCK; y++) {
        for (var x = 0; x < BLOCK; x++) {
            is_mixed |= textureLoad(source, min(first + vec2i(x, y), last), 0).x != value;
        }
    }
    blocks[block.y * count.x + block.x] = select(value, MIXED, is_mixed);
}

@compute @workgroup_size(8, 8)
fn find_tiles(@builtin(global_invocation_id) id: vec3u) {
    let count = block_count();
    let tiles = (count + 1) / 2;
    let tile = vec2i(id.xy);
    if any(tile >= tiles) {
        return;
    }
    let own = blocks[2 * tile.y * count.x + 2 * tile.x];
    var differs = own == MIXED;
    var differs_above_or_below = differs;
    for (var y = -3; y <= 4; y++) {
        for (var x = -1; x <= 2; x++) {
            let block = clamp(2 * tile + vec2i(x, y), vec2i(0), count - 1);
            let is_other = blocks[block.y * count.x + block.x] != own;
            differs_above_or_below |= is_other;
            differs |= is_other && y >= -1 && y <= 2;
        }
    }
    let number = u32(tile.y * tiles.x + tile.x);
    if differs {
        list.tiles[atomicAdd(&list.blurred, 1u)] = number;
    } else if differs_above_or_below {
        list.tiles[arrayLength(&list.tiles) - 1u - atomicAdd(&list.beside, 1u)] = number;
    }
}

// Each instance draws a group of tiles.
@compute @workgroup_size(1)
fn group_tiles() {
    draws[1] = (atomicLoad(&list.blurred) + GROUP - 1u) / GROUP;
    draws[5] = (atomicLoad(&list.beside) + GROUP - 1u) / GROUP;
}
