// One compare with the nearest texel.

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == map.eye.background_depth {
        return 1.0;
    }
    let point = map_point(at.xy, depth, surface(map.eye, at.xy, depth));
    if point.is_own_shadow {
        return 0.0;
    }
    if !point.is_covered {
        return 1.0;
    }
    let texel = vec2i(point.texel);
    let stored = textureLoad(map_depth, texel, point.layer, 0);
    // Depth was stored at the middle of the texel.
    return select(0.0, 1.0, is_lit(point, vec2f(texel) + 0.5 - point.texel, stored));
}
