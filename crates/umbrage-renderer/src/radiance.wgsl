// needs: fullscreen
// Adds radiance that a technique found to that of the picture.

@group(0) @binding(0) var radiance_texture: texture_2d<f32>;

@fragment
fn add_radiance(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(textureLoad(radiance_texture, vec2i(at.xy), 0).rgb, 0.0);
}
