// A look-up in two phases.

fn share_at(pixel: Pixel) -> f32 {
    let quick = quick_share_of_light(pixel);
    if quick >= 0.0 {
        return quick;
    }
    return share_of_light(pixel);
}
