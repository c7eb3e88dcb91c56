// needs: map_visibility
// One compare with the nearest texel.

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let texel = vec2i(point.texel);
    let stored = load_depth(texel, point.layer);
    // Depth was stored at the middle of the texel.
    return select(0.0, 1.0, is_lit(point, vec2f(texel) + 0.5 - point.texel, stored));
}
