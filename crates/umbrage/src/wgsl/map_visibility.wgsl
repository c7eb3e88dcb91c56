// The full-screen pass of a technique with maps. The technique says which share of a covered point is lit:
// `fn lit_share(point: MapPoint, pixel: Pixel) -> f32`.

// What becomes of a surface that faces away from the light; whatever is less counts as none.
override OWN_SHADOW: f32 = 0.0;

fn pixel_at(at: vec2f) -> Pixel {
    let depth = textureLoad(receiver_depth, vec2i(at), 0);
    return Pixel(at, depth, surface(map.eye, at, depth));
}

fn is_drawn(pixel: Pixel) -> bool {
    return pixel.depth != map.eye.background_depth;
}

// Nothing drawn, no view of the light there, or turned away from it. One branch for all three: each costs.
fn is_settled(pixel: Pixel, point: MapPoint) -> bool {
    return !(is_drawn(pixel) && point.is_covered) || point.is_own_shadow;
}

fn settled_share(pixel: Pixel, point: MapPoint) -> f32 {
    return select(1.0, OWN_SHADOW, is_drawn(pixel) && point.is_own_shadow);
}

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = pixel_at(at.xy);
    let point = map_point(pixel);
    if is_settled(pixel, point) {
        return settled_share(pixel, point);
    }
    var share = lit_share(point, pixel);
    if LAYOUT == SPLITS && BLEND == LERP && point.next > 0.0 {
        share = mix(share, lit_share(map_point_in(pixel, point.layer + 1u), pixel), point.next);
    }
    return select(share, 0.0, share <= OWN_SHADOW);
}

// The first phase of a look-up in two: all but where splits are mixed. `visibility` is drawn where this one discards.
@fragment
fn unmixed_visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = pixel_at(at.xy);
    let point = map_point(pixel);
    if is_settled(pixel, point) {
        return settled_share(pixel, point);
    }
    let share = lit_share(point, pixel);
    if point.next > 0.0 {
        discard;
    }
    return select(share, 0.0, share <= OWN_SHADOW);
}
