// needs: map_lookup
// The share of the light at a receiver. The technique says which share of a covered point is lit:
// `fn lit_share(point: MapPoint, pixel: Pixel) -> f32`.

// What becomes of a surface that faces away from the light; whatever is less counts as none.
override OWN_SHADOW: f32 = 0.0;

// Nothing drawn, no view of the light there, or turned away from it. One branch for all three: each
// costs.
fn is_settled(pixel: Pixel, point: MapPoint) -> bool {
    return !(pixel.is_drawn && point.is_covered) || point.is_own_shadow;
}

fn settled_share(pixel: Pixel, point: MapPoint) -> f32 {
    return select(1.0, OWN_SHADOW, pixel.is_drawn && point.is_own_shadow);
}

fn share_of_light(pixel: Pixel) -> f32 {
    let first = point_by_matrix(pixel, 0u);
    let split = layer_of_pixel(pixel, first);
    var layer = split.layer;
    var weight = 1.0 - split.next;
    var share = 0.0;
    // Twice where two splits are mixed.
    loop {
        var point = map_point(pixel, first, layer);
        point.is_covered &= split.is_covered;
        if layer == split.layer && is_settled(pixel, point) {
            return settled_share(pixel, point);
        }
        share += weight * lit_share(point, pixel);
        if split.next == 0.0 || layer != split.layer {
            break;
        }
        layer += 1u;
        weight = split.next;
    }
    return select(share, 0.0, share <= OWN_SHADOW);
}
