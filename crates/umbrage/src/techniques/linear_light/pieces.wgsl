// needs: fullscreen
// Adds up what both ends see of a piece of the light. Together they see no more than all of it,
// though the shares of both may overlap by the width of a texel.

@group(0) @binding(0) var first_shares: texture_2d<f32>;
@group(0) @binding(1) var second_shares: texture_2d<f32>;

@fragment
fn piece(@builtin(position) at: vec4f) -> @location(0) f32 {
    let first = textureLoad(first_shares, vec2i(at.xy), 0).x;
    let second = textureLoad(second_shares, vec2i(at.xy), 0).y;
    return min(first + second, 1.0);
}
