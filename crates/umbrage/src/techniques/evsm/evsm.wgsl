// Exponential variance shadow maps (Lauritzen 2008) with a filter of one width.

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let level = level_of_pixel(point, pixel);
    let m = moments_between(point.texel, point.layer, level);
    return without_bleeding(share_of(m, linear_point(point, CREASE * exp2(level)), variance_of(level)));
}
