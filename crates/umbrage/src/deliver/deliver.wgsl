// needs: fullscreen
// Visibility as it is, to a target of the host's.

struct Delivery {
    // Upper left pixel of the target.
    corner: vec2i,
    pad_a: f32,
    pad_b: f32,
}

@group(0) @binding(0) var<uniform> delivery: Delivery;
@group(0) @binding(1) var visibility: texture_2d<f32>;

@fragment
fn deliver(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(textureLoad(visibility, vec2i(position.xy) - delivery.corner, 0).x);
}
