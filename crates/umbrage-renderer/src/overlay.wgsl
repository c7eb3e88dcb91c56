// needs: fullscreen
// A dark overlay over all that any light's shadow falls on (PX 3.4): blended over the radiance.

@group(0) @binding(0) var visibility_texture: texture_2d<f32>;
@group(0) @binding(1) var<uniform> darkness: vec4f;

@fragment
fn darken(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let dark = 1.0 - textureLoad(visibility_texture, vec2i(at.xy), 0).x;
    return vec4f(0.0, 0.0, 0.0, darkness.x * dark);
}
