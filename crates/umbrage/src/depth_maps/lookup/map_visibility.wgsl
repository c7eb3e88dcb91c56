// needs: fullscreen, receivers, map_share
// The full-screen pass of a technique with maps. A receiver's place is in the camera's normalised
// device coordinates.

fn pixel_at(at: vec2f) -> Pixel {
    let depth = textureLoad(receiver_depth, vec2i(at), 0);
    let place = ndc_of(map.eye, at, depth);
    let w = eye_w(map.eye, place);
    let seen = surface(map.eye, at, depth);
    let rounding = position_rounding(map.eye, depth, 1.0 / w);
    let off = off_surface(map.eye, seen.normal, 1.0 / w);
    return Pixel(at, depth != map.eye.background_depth, place, w, seen, rounding, off);
}

fn position_of(pixel: Pixel) -> vec3f {
    return (map.eye.eye_from_ndc * pixel.place).xyz / pixel.w;
}

// Change of the place along with a change of the camera's normalised device coordinates.
fn step_of_place(pixel: Pixel, step: vec4f) -> vec4f {
    return step;
}

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    return share_of_light(pixel_at(at.xy));
}
