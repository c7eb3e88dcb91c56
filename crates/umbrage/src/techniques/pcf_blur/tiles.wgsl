// needs: head
// Finds the tiles around which visibility differs.

struct TileCounts {
    blurred: atomic<u32>,
    beside: atomic<u32>,
    tiles: array<u32>,
}

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var nearest: sampler;
// The value of each block, or one of those below.
@group(0) @binding(2) var<storage, read_write> blocks: array<f32>;
@group(0) @binding(3) var<storage, read_write> list: TileCounts;
// Arguments of two dispatches and a draw.
@group(0) @binding(4) var<storage, read_write> arguments: array<vec4u, 3>;

// What is in its own shadow stays so, and does not count.
override DEPTH_AWARE: bool = true;

// Nothing that counts, and more than one value.
const NONE: f32 = -1.0;
const MIXED: f32 = -2.0;

// Quads of pixels that a workgroup blurs, tiles that an instance draws.
const QUADS: u32 = 64u;
const TILES: u32 = 64u;
// Workgroups in a row, the most that every adapter allows.
const ROW: u32 = 65535u;

fn block_count() -> vec2i {
    return vec2i((textureDimensions(source) + BLOCK - 1u) / BLOCK);
}

fn both(a: f32, b: f32) -> f32 {
    return select(select(select(MIXED, a, a == b), b, a == NONE), a, b == NONE);
}

fn value_of(values: vec4f) -> f32 {
    let counts = (values != vec4f(OWN_SHADOW)) | vec4<bool>(!DEPTH_AWARE);
    let v = select(vec4f(NONE), values, counts);
    return both(both(v.x, v.y), both(v.z, v.w));
}

@compute @workgroup_size(8, 8)
fn find_blocks(@builtin(global_invocation_id) id: vec3u) {
    let count = block_count();
    if any(vec2i(id.xy) >= count) {
        return;
    }
    let size = vec2f(textureDimensions(source));
    var value = NONE;
    for (var y = 1u; y < BLOCK; y += 2u) {
        for (var x = 1u; x < BLOCK; x += 2u) {
            let corner = vec2f(id.xy * BLOCK + vec2u(x, y));
            value = both(value, value_of(textureGather(0, source, nearest, corner / size)));
        }
    }
    blocks[id.y * u32(count.x) + id.x] = value;
}

// Columns are blurred after rows, and read what is above and below a tile: whatever has one that is
// blurred there.
@compute @workgroup_size(8, 8)
fn find_tiles(@builtin(global_invocation_id) id: vec3u) {
    let count = block_count();
    let tile = vec2i(id.xy);
    if any(tile >= (count + 1) / 2) {
        return;
    }
    var around = NONE;
    var in_column = NONE;
    for (var y = -3; y <= 4; y++) {
        for (var x = -1; x <= 2; x++) {
            let block = clamp(2 * tile + vec2i(x, y), vec2i(0), count - 1);
            let value = blocks[block.y * count.x + block.x];
            in_column = both(in_column, value);
            around = both(around, select(NONE, value, y >= -1 && y <= 2));
        }
    }
    let entry = id.x | (id.y << 16u);
    if around == MIXED {
        list.tiles[atomicAdd(&list.blurred, 1u)] = entry;
    } else if in_column == MIXED {
        list.tiles[arrayLength(&list.tiles) - 1u - atomicAdd(&list.beside, 1u)] = entry;
    }
}

fn dispatch_of(tiles: u32) -> vec4u {
    let groups = (tiles * BLOCK * BLOCK + QUADS - 1u) / QUADS;
    return vec4u(min(groups, ROW), (groups + ROW - 1u) / ROW, 1u, 0u);
}

@compute @workgroup_size(1)
fn count_tiles() {
    let blurred = atomicLoad(&list.blurred);
    arguments[0] = dispatch_of(blurred);
    arguments[1] = dispatch_of(atomicLoad(&list.beside));
    arguments[2] = vec4u(6u * TILES, (blurred + TILES - 1u) / TILES, 0u, 0u);
}
