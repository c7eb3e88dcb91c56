// Fragments of bodies for pictures of wedges. After `draw.wgsl`, whose `body` and `add_wedge` they share.

// Fronts in the first channel, backs in the second.
@fragment
fn tint(@builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return select(vec4f(0.0, 1.0, 0.0, 0.0), vec4f(1.0, 0.0, 0.0, 0.0), is_front);
}

@fragment
fn line() -> @location(0) vec4f {
    return vec4f(1.0, 0.0, 0.0, 0.0);
}

// Wedges that the point is in, and fragments that ask.
@fragment
fn count(in: Body) -> @location(0) vec2f {
    let depth = textureLoad(receiver_depth, vec2i(in.position.xy), 0);
    let is_in = depth != eye.background_depth && is_in_body(in, receiver(in.position.xy, depth));
    return vec2f(f32(is_in), 1.0);
}

// Edges that cross the light, with the point on the side of the shadow and on the other one.
@fragment
fn crossing(in: Body) -> @location(0) vec2f {
    let depth = textureLoad(receiver_depth, vec2i(in.position.xy), 0);
    let p = receiver(in.position.xy, depth);
    if depth == eye.background_depth || !is_in_body(in, p) {
        discard;
    }
    let inside = is_inside(p, in.plane, in.eye_inside);
    let crosses = share_of_edge(light, p, in.start.xyz, in.end.xyz, inside) != 0.0;
    // On which side the shadow is goes by the sign of how often it counts.
    let is_dark = inside == (in.start.w + in.end.w > 0.0);
    return f32(crosses) * vec2f(f32(is_dark), f32(!is_dark));
}
