// Directions in 32 bits: the octahedron's unfolded faces, 16 bits each way. The lowest bit is taken
// for a flag.

// `n`: geometric normal in world space, turned to the eye. `casts`: whether the surface casts
// shadows, so that it is in its own shadow where it faces away from the light.
fn pack_normal(n: vec3f, casts: bool) -> u32 {
    let flat_normal = n / (abs(n.x) + abs(n.y) + abs(n.z));
    let folded = (1.0 - abs(flat_normal.yx)) * select(vec2f(-1.0), vec2f(1.0), flat_normal.xy >= vec2f(0.0));
    let bits = pack2x16snorm(select(folded, flat_normal.xy, flat_normal.z >= 0.0));
    return (bits & 0xfffffffeu) | u32(casts);
}

// Not of unit length: that saves the scaling.
fn unpack_normal(bits: u32) -> vec3f {
    let signed = bitcast<i32>(bits);
    let e = vec2f(f32((signed << 16u) >> 16u), f32(signed >> 16u));
    let z = 32767.0 - abs(e.x) - abs(e.y);
    let fold = min(z, 0.0);
    return vec3f(e + select(vec2f(-fold), vec2f(fold), e >= vec2f(0.0)), z);
}
