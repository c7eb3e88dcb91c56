// needs: map_share
// What is quick to decide about a receiver. The technique says the share of a covered point that is
// lit, or a negative number where that takes more: `fn quick_share(point: MapPoint, pixel: Pixel)
// -> f32`.

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
