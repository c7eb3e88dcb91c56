// needs: pack_normal
// What shading has to know of a visible surface, in 128 bits.

struct Look {
    // Linear RGB reflectance.
    base: vec3f,
    // Strength of the highlight, and its exponent.
    specular: f32,
    shininess: f32,
    // Whether shadows fall on it.
    receives: bool,
    // Light given off, linear RGB.
    emissive: vec3f,
}

// Square roots of the channels with 10 bits each, finer than eyes are at every brightness; and
// which of 1, 4, 16 and 64 is the most that they reach.
fn pack_base(base: vec3f) -> u32 {
    let most = max(base.r, max(base.g, base.b));
    let range = u32(most > 1.0) + u32(most > 4.0) + u32(most > 16.0);
    let roots = sqrt(clamp(base / f32(1u << (2u * range)), vec3f(0.0), vec3f(1.0)));
    let bits = vec3u(roots * 1023.0 + 0.5);
    return bits.x | (bits.y << 10u) | (bits.z << 20u) | (range << 30u);
}

fn unpack_base(bits: u32) -> vec3f {
    let roots = vec3f(vec3u(bits, bits >> 10u, bits >> 20u) & vec3u(1023u)) * (1.0 / 1023.0);
    return roots * roots * f32(1u << (2u * (bits >> 30u)));
}

// The upper halves of both numbers, which are not below 0: a shift unpacks them. The sign of the
// second says that no shadow falls.
fn pack_gloss(specular: f32, shininess: f32, receives: bool) -> u32 {
    let bits = bitcast<vec2u>(vec2f(shininess, specular)) + vec2u(0x8000u);
    return (bits.x & 0x7fff0000u) | (bits.y >> 16u) | select(0x8000u, 0u, receives);
}

// Three channels of 9 bits and the power of two that they share.
fn pack_emissive(emissive: vec3f) -> u32 {
    let light = clamp(emissive, vec3f(0.0), vec3f(65408.0));
    let most = max(light.r, max(light.g, light.b));
    // 2 to this power is more than any of them.
    let power = max(i32(bitcast<u32>(most) >> 23u) - 126, -15);
    let scale = bitcast<f32>(u32(136 - power) << 23u);
    let bits = vec3u(min(light * scale + 0.5, vec3f(511.0)));
    return bits.x | (bits.y << 9u) | (bits.z << 18u) | (u32(power + 15) << 27u);
}

fn unpack_emissive(bits: u32) -> vec3f {
    let scale = bitcast<f32>(((bits >> 27u) + 103u) << 23u);
    return vec3f(vec3u(bits, bits >> 9u, bits >> 18u) & vec3u(511u)) * scale;
}

// All but the normal, which is apart since it changes from pixel to pixel.
fn pack_look(look: Look) -> vec3u {
    return vec3u(
        pack_base(look.base),
        pack_gloss(look.specular, look.shininess, look.receives),
        pack_emissive(look.emissive),
    );
}

fn unpack_look(bits: vec3u) -> Look {
    let specular = bitcast<f32>((bits.y & 0x7fffu) << 16u);
    let shininess = bitcast<f32>(bits.y & 0x7fff0000u);
    return Look(unpack_base(bits.x), specular, shininess, (bits.y & 0x8000u) == 0u, unpack_emissive(bits.z));
}
