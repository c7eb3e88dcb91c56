// needs: map_visibility, moments_lookup, bounds
// Exponential variance shadow maps (Lauritzen 2008) with a filter of one width.

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let level = level_of_pixel(point, pixel);
    let found = moments_between(point.texel, point.layer, level);
    let receiver = linear_point(point, found.offset, CREASE * exp2(level));
    return without_bleeding(share_of(found.moments, receiver, variance_of(level)));
}
