// needs: fullscreen, receivers, area_light
// The depth of what places in a smaller buffer stand for.

@group(1) @binding(0) var<uniform> light: AreaLight;

@fragment
fn copy_depth(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(receiver_depth, vec2i(full_pixel(light, at.xy)), 0);
}
