// needs: map_visibility
// One compare with the nearest texel; what is in shadow keeps a share of the light.

override THROUGH: f32;

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let texel = vec2i(point.texel);
    let stored = load_depth(texel, point.layer);
    return select(THROUGH, 1.0, is_lit(point, vec2f(texel) + 0.5 - point.texel, stored));
}
