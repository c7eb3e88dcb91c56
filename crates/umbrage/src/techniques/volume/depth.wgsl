// needs: fullscreen, receivers
// The receivers' depth, to be compared with where their own buffer can't be used.

struct DepthBounds {
    eye: Eye,
    // The light relative to the eye; its range squared.
    light: vec3f,
    range_squared: f32,
    // What makes all volumes fail the depth test.
    nearest: f32,
    // Over 0: depth becomes this over the distance, as a reversed projection without a far plane
    // has it.
    own_near: f32,
    pad_a: f32,
    pad_b: f32,
}

@group(1) @binding(0) var<uniform> bounds: DepthBounds;

@fragment
fn copy_depth(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(receiver_depth, vec2i(at.xy), 0);
}

// In place of the depth-bounds test (GG 9.6.3), and tighter: what the light can't reach becomes the
// nearest there is, so that nothing is counted there.
@fragment
fn changed_depth(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    let own = bounds.own_near * eye_w(bounds.eye, ndc_of(bounds.eye, at.xy, depth));
    let kept = select(depth, select(own, 0.0, depth == bounds.eye.background_depth), bounds.own_near > 0.0);
    let to_light = bounds.light - position_eye(bounds.eye, at.xy, depth);
    return select(bounds.nearest, kept, dot(to_light, to_light) <= bounds.range_squared);
}
