// needs: head
// Quads: two by two pixels. Visibility is a whole number, 0 for what faces away from the light,
// else 1 to 255 for none to all of it; four of them are a word.

@group(1) @binding(0) var<uniform> blur: Blur;
@group(1) @binding(1) var<storage, read> list: TileList;
@group(1) @binding(2) var nearest: sampler;

// Quads that a workgroup takes.
const QUADS: u32 = 64u;

// The quad that an invocation is for: in which tile, and where in it.
struct Place {
    tile: u32,
    quad: vec2u,
}

fn place_of(group: vec3u, groups: vec3u, index: u32) -> Place {
    let number = (group.y * groups.x + group.x) * QUADS + index;
    let in_tile = number % (BLOCK * BLOCK);
    return Place(number / (BLOCK * BLOCK), vec2u(in_tile % BLOCK, in_tile / BLOCK));
}

fn word_of(values: vec4f) -> vec4u {
    return vec4u(pack4xU8(vec4u(values + 0.5)));
}
