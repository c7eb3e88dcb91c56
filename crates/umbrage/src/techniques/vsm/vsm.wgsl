// Variance shadow maps (Donnelly and Lauritzen 2006).

// What rounding may make of none.
override LEAST_VARIANCE: f32 = 1e-7;

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let level = level_of_pixel(point, pixel);
    let m = moments_between(point.texel, point.layer, level);
    let variance = max(m.y - m.x * m.x, LEAST_VARIANCE);
    return without_bleeding(largest_share(m.x, variance, linear_point(point, CREASE * exp2(level)).depth));
}
