// needs: fullscreen, receivers
// Reads depth, writes visibility: what any technique does at least.

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    return saturate(1.0 - textureLoad(receiver_depth, vec2i(at.xy), 0));
}
