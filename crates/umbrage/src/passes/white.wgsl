// needs: fullscreen
@fragment
fn white() -> @location(0) vec4f {
    return vec4f(1.0);
}
