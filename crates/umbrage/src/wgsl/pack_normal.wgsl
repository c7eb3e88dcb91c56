// Directions in 32 bits: the octahedron's unfolded faces, 16 bits each way.

fn pack_normal(n: vec3f) -> u32 {
    let flat_normal = n / (abs(n.x) + abs(n.y) + abs(n.z));
    let folded = (1.0 - abs(flat_normal.yx)) * select(vec2f(-1.0), vec2f(1.0), flat_normal.xy >= vec2f(0.0));
    return pack2x16snorm(select(folded, flat_normal.xy, flat_normal.z >= 0.0));
}

// Not of unit length.
fn unpack_normal(bits: u32) -> vec3f {
    let e = unpack2x16snorm(bits);
    let z = 1.0 - abs(e.x) - abs(e.y);
    let fold = max(-z, 0.0);
    return vec3f(e - fold * sign(e), z);
}
