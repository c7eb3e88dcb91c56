// needs: fullscreen
// From counts to visibility.

@group(0) @binding(0) var counts: texture_2d<f32>;

override PARITY: bool = false;

@fragment
fn from_floats(@builtin(position) at: vec4f) -> @location(0) f32 {
    let count = textureLoad(counts, vec2i(at.xy), 0).x;
    let is_odd = fract(count * 0.5) != 0.0;
    return select(1.0, 0.0, select(count != 0.0, is_odd, PARITY));
}

// Where the stencil test lets it: everything that is in shadow.
@fragment
fn dark() -> @location(0) f32 {
    return 0.0;
}
