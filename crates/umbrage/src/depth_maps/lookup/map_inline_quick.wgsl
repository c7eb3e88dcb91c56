// A look-up in two phases. The second one is in a loop, since drivers that mask branches in place
// of jumping do leave a loop early: where no pixel of a block needs it, it costs nothing.

fn share_at(pixel: Pixel) -> f32 {
    var share = quick_share_of_light(pixel);
    for (var i = 0u; i < 2u && share < 0.0; i++) {
        share = share_of_light(pixel);
    }
    return share;
}
