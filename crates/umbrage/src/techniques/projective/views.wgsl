// needs: fullscreen, inspect, plane_finder
// Pictures of planes and of what falls on them.

@group(2) @binding(0) var visibility_texture: texture_2d<f32>;

// A colour for each plane, told apart from its neighbours by the golden angle.
fn color_of(plane: u32) -> vec3f {
    let turn = f32(plane) * 2.3999632;
    return 0.5 + 0.45 * cos(turn + vec3f(0.0, 2.0943951, 4.1887902));
}

// The number of the pixel's plane; `finder.count` or more: none.
fn plane_at(at: vec4f) -> u32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == finder.eye.background_depth {
        return finder.count;
    }
    return find_plane(shown_at(at.xy, depth));
}

@fragment
fn planes(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let plane = plane_at(at);
    return vec4f(select(grey(finder.eye, at), color_of(plane), plane < finder.count), 1.0);
}

// White where a plane is lit, blue where it lies in shadow.
@fragment
fn mask(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let seen = textureLoad(visibility_texture, vec2i(at.xy), 0).x;
    let on_plane = mix(vec3f(0.1, 0.25, 0.75), vec3f(0.9), seen);
    return vec4f(select(grey(finder.eye, at), on_plane, plane_at(at) < finder.count), 1.0);
}
