// The first phase of a look-up in two: what is quick to decide. The technique says the share of a covered point that is lit, or a negative
// number where that takes more: `fn quick_share(point: MapPoint, pixel: Pixel) -> f32`. The second phase, `visibility`, is drawn
// where this one discards.

@fragment
fn quick_visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    let pixel = Pixel(at.xy, depth, surface(map.eye, at.xy, depth));
    let point = map_point(pixel);
    let is_drawn = depth != map.eye.background_depth;
    if !(is_drawn && point.is_covered) || point.is_own_shadow {
        return select(1.0, 0.0, is_drawn && point.is_own_shadow);
    }
    let share = quick_share(point, pixel);
    let is_mixed = LAYOUT == SPLITS && BLEND == LERP && split_of(pixel).next > 0.0;
    if share < 0.0 || is_mixed {
        discard;
    }
    return share;
}
