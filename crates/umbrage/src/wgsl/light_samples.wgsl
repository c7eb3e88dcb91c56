// needs: fullscreen
// Sums visibilities of single light samples, then divides by their number.

@group(0) @binding(0) var visibility_texture: texture_2d<f32>;

override COUNT: f32 = 1.0;

@fragment
fn add(@builtin(position) at: vec4f) -> @location(0) f32 {
    return textureLoad(visibility_texture, vec2i(at.xy), 0).x;
}

@fragment
fn mean(@builtin(position) at: vec4f) -> @location(0) f32 {
    return textureLoad(visibility_texture, vec2i(at.xy), 0).x / COUNT;
}
