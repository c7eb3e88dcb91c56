// Positions of a mesh that a host lends and moves, copied to where edges are drawn copied.

struct LentPositions {
    // Words of the host's buffer to the first vertex, and from one to the next.
    first_word: u32,
    words: u32,
    format: u32,
    // Where the first one goes, and how many there are.
    vertex: u32,
    vertex_count: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

// Three floats otherwise.
const UNORM_16: u32 = 1u;
const SNORM_16: u32 = 2u;
const FLOAT_16: u32 = 3u;

@group(0) @binding(0) var<uniform> copied: LentPositions;
@group(0) @binding(1) var<storage, read> lent: array<u32>;
@group(0) @binding(2) var<storage, read_write> positions: array<f32>;

// The lower half of a word, by its exponent of five bits; what has none is next to 0.
fn half(word: u32) -> f32 {
    let size = bitcast<f32>((word & 0x7fffu) << 13u) * 0x1p112;
    return select(size, -size, (word & 0x8000u) != 0u);
}

fn pair(word: u32) -> vec2f {
    if copied.format == UNORM_16 {
        return unpack2x16unorm(word);
    }
    if copied.format == SNORM_16 {
        return unpack2x16snorm(word);
    }
    return vec2f(half(word), half(word >> 16u));
}

fn lent_position(at: u32) -> vec3f {
    if copied.format == 0u {
        return vec3f(bitcast<f32>(lent[at]), bitcast<f32>(lent[at + 1u]), bitcast<f32>(lent[at + 2u]));
    }
    return vec3f(pair(lent[at]), pair(lent[at + 1u]).x);
}

@compute @workgroup_size(64)
fn copy_positions(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= copied.vertex_count {
        return;
    }
    let p = lent_position(copied.first_word + copied.words * id.x);
    let to = 3u * (copied.vertex + id.x);
    positions[to] = p.x;
    positions[to + 1u] = p.y;
    positions[to + 2u] = p.z;
}
