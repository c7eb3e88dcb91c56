// needs: map_visibility
// The first phase of a look-up in two: what is quick to decide. The technique says the share of a
// covered point that is lit, or a negative number where that takes more: `fn quick_share(point:
// MapPoint, pixel: Pixel) -> f32`. The second phase, `visibility`, is drawn where this one
// discards.

// The share of the light, negative where `share_of_light` has to find it.
fn quick_share_of_light(pixel: Pixel) -> f32 {
    let first = point_by_matrix(pixel, 0u);
    let split = layer_of_pixel(pixel, first);
    var point = map_point(pixel, first, split.layer);
    point.is_covered &= split.is_covered;
    if is_settled(pixel, point) {
        return settled_share(pixel, point);
    }
    return select(quick_share(point, pixel), -1.0, split.next > 0.0);
}

@fragment
fn quick_visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let share = quick_share_of_light(pixel_at(at.xy));
    if share < 0.0 {
        discard;
    }
    return share;
}
