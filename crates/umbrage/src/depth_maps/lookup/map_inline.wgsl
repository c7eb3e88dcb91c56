// needs: map_share
// What takes the place of the full-screen pass where a shader of a host's own asks: a receiver's
// place is relative to the eye, with world axes. A host calls one of three functions.

// What a position may be off, as a share of its coordinates: what interpolating it across a
// triangle rounds.
const INTERPOLATED: f32 = 5e-7;

fn receiver(position: vec3f, seen: Surface) -> Pixel {
    let place = vec4f(position, 1.0);
    let clip = map.ndc_from_eye * place;
    let sum = dot(abs(position), vec3f(1.0));
    // What is in the plane of the eye has no pixel: any will do.
    let w = select(clip.w, 1.0, abs(clip.w) <= 1e-6 * sum + 1e-20);
    let at = floor((clip.xy / w - vec2f(-1.0, 1.0)) / map.eye.ndc_from_pixel) + 0.5;
    return Pixel(at, true, place, 1.0, seen, INTERPOLATED * sum, off_surface(map.eye, seen.normal, clip.w));
}

fn turned_to_eye(position: vec3f, normal: vec3f) -> vec3f {
    return select(normal, -normal, dot(normal, position) > 0.0);
}

fn position_of(pixel: Pixel) -> vec3f {
    return pixel.place.xyz;
}

// Change of the place along with a change of the camera's normalised device coordinates.
fn step_of_place(pixel: Pixel, step: vec4f) -> vec4f {
    return map.eye.eye_from_ndc * step * (map.ndc_from_eye * pixel.place).w;
}

// The share of the light that the surface at `position`, in metres relative to the eye with world
// axes, sees. `normal` is its geometric normal, of any length but 0, and is turned to the eye.
fn visibility(position: vec3f, normal: vec3f) -> f32 {
    return share_of_light(receiver(position, Surface(turned_to_eye(position, normal), true)));
}

// The same for a surface that casts no shadow, such as a pane: light comes through to its back.
fn visibility_of_pane(position: vec3f, normal: vec3f) -> f32 {
    return share_of_light(receiver(position, Surface(turned_to_eye(position, normal), false)));
}

// The same for what has no surface, such as smoke: as for a small sheet that faces the light.
fn visibility_in_air(position: vec3f) -> f32 {
    return share_of_light(receiver(position, Surface(-(map.from_light * vec4f(position, 1.0)).xyz, false)));
}
