// needs: fullscreen, map_lookup
// The full-screen pass of a technique with maps. The technique says which share of a covered point
// is lit: `fn lit_share(point: MapPoint, pixel: Pixel) -> f32`.

// What becomes of a surface that faces away from the light; whatever is less counts as none.
override OWN_SHADOW: f32 = 0.0;

fn pixel_at(at: vec2f) -> Pixel {
    let depth = textureLoad(receiver_depth, vec2i(at), 0);
    return Pixel(at, depth, surface(map.eye, at, depth));
}

fn is_drawn(pixel: Pixel) -> bool {
    return pixel.depth != map.eye.background_depth;
}

// Nothing drawn, no view of the light there, or turned away from it. One branch for all three: each
// costs.
fn is_settled(pixel: Pixel, point: MapPoint) -> bool {
    return !(is_drawn(pixel) && point.is_covered) || point.is_own_shadow;
}

fn settled_share(pixel: Pixel, point: MapPoint) -> f32 {
    return select(1.0, OWN_SHADOW, is_drawn(pixel) && point.is_own_shadow);
}

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = pixel_at(at.xy);
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
