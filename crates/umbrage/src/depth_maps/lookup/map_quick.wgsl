// needs: map_visibility
// The first phase of a look-up in two: what is quick to decide. The technique says the share of a
// covered point that is lit, or a negative number where that takes more: `fn quick_share(point:
// MapPoint, pixel: Pixel) -> f32`. The second phase, `visibility`, is drawn where this one
// discards.

@fragment
fn quick_visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = pixel_at(at.xy);
    let first = point_by_matrix(pixel, 0u);
    let split = layer_of_pixel(pixel, first);
    var point = map_point(pixel, first, split.layer);
    point.is_covered &= split.is_covered;
    if is_settled(pixel, point) {
        return settled_share(pixel, point);
    }
    let share = quick_share(point, pixel);
    if share < 0.0 || split.next > 0.0 {
        discard;
    }
    return share;
}
