// A look-up in one phase.

fn share_at(pixel: Pixel) -> f32 {
    return share_of_light(pixel);
}
