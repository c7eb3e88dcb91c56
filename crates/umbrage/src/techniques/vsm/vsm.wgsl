// needs: map_visibility, moments_lookup, moments
// Variance shadow maps (Donnelly and Lauritzen 2006).

// What rounding may make of none.
override LEAST_VARIANCE: f32 = 1e-7;

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let level = level_of_pixel(point, pixel);
    let found = moments_between(point.texel, point.layer, level);
    let m = found.moments;
    let variance = max(m.y - m.x * m.x, LEAST_VARIANCE);
    let receiver = linear_point(point, found.offset, CREASE * exp2(level));
    return without_bleeding(largest_share(m.x, variance, receiver.depth));
}
