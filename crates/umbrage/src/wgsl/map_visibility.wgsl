// The full-screen pass of a technique with maps. The technique says which share of a covered point is lit:
// `fn lit_share(point: MapPoint, at: vec2f) -> f32`, where `at` is the pixel.

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
    return lit_share(point, at.xy);
}
