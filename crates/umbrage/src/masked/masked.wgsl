// needs: fullscreen
// Hands visibility on, for the target to keep the smaller one.

@group(0) @binding(0) var visibility_texture: texture_2d<f32>;

@fragment
fn copied(@builtin(position) at: vec4f) -> @location(0) f32 {
    return textureLoad(visibility_texture, vec2i(at.xy), 0).x;
}
