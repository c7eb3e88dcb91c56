// needs: receivers
// What pictures of a technique's inside are drawn over, and numbers as colours.

// The scene in dark greys, by how much surfaces face the eye.
fn grey(eye: Eye, at: vec4f) -> vec3f {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == eye.background_depth {
        return vec3f(0.02);
    }
    let position = position_eye(eye, at.xy, depth);
    let n = surface(eye, at.xy, depth).normal;
    return vec3f(0.03 + 0.17 * abs(dot(normalize(n), normalize(position))));
}

// Black, violet, red, orange, yellow, white: equal steps look equally large.
fn heat(t: f32) -> vec3f {
    let x = saturate(t);
    let r = saturate(x * 2.6);
    let g = saturate(x * 1.9 - 0.55);
    let b = saturate(0.55 * sin(min(x, 0.5) * 6.2831853)) + saturate(x * 3.0 - 2.0);
    return vec3f(r, g, min(b, 1.0));
}
