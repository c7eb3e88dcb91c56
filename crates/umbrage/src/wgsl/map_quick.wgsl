// The first phase of a look-up in two: what is quick to decide. The technique says the share of a covered point that is lit, or a negative
// number where that takes more: `fn quick_share(point: MapPoint, pixel: Pixel) -> f32`. The second phase, `visibility`, is drawn
// where this one discards.

@fragment
fn quick_visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = pixel_at(at.xy);
    let point = map_point(pixel);
    if is_settled(pixel, point) {
        return settled_share(pixel, point);
    }
    let share = quick_share(point, pixel);
    if share < 0.0 || point.next > 0.0 {
        discard;
    }
    return share;
}
