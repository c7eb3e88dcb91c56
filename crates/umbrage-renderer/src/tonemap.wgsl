// needs: fullscreen, display
// The radiance of a picture as it is shown.

@group(0) @binding(0) var radiance_texture: texture_2d<f32>;

@fragment
fn tonemap(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let height = at.y / f32(textureDimensions(radiance_texture).y);
    return displayed(textureLoad(radiance_texture, vec2i(at.xy), 0), height);
}
