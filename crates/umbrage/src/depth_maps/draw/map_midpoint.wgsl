// needs: fullscreen
// The mean of first and second depth; the first alone where nothing is behind it.

@group(0) @binding(0) var first_depth: texture_depth_2d;
@group(0) @binding(1) var second_depth: texture_depth_2d;

// Depths are near / distance: their harmonic mean is the mean of the distances.
override HARMONIC: bool = false;

@fragment
fn midpoint(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    let first = textureLoad(first_depth, vec2i(position.xy), 0);
    let second = textureLoad(second_depth, vec2i(position.xy), 0);
    if second == 0.0 {
        return first;
    }
    return select(0.5 * (first + second), 2.0 * first * second / (first + second), HARMONIC);
}
