// The full-screen pass of a technique with maps. The technique says which share of a covered point is lit:
// `fn lit_share(point: MapPoint, pixel: Pixel) -> f32`.

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    let pixel = Pixel(at.xy, depth, surface(map.eye, at.xy, depth));
    let point = map_point(pixel);
    // Nothing drawn, no view of the light there, or turned away from it. One branch for all three: each costs.
    let is_drawn = depth != map.eye.background_depth;
    if !(is_drawn && point.is_covered) || point.is_own_shadow {
        return select(1.0, 0.0, is_drawn && point.is_own_shadow);
    }
    let share = lit_share(point, pixel);
    if LAYOUT == SPLITS && BLEND == LERP {
        let split = split_of(pixel);
        if split.next > 0.0 {
            return mix(share, lit_share(map_point_in(pixel, split.layer + 1u), pixel), split.next);
        }
    }
    return share;
}
