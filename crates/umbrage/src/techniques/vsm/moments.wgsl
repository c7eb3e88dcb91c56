// needs: moments_mean
// Depth and its square.

fn moments_of(depth: f32) -> vec4f {
    return vec4f(depth, depth * depth, 0.0, 0.0);
}

// For even steps: the variance is what must not be lost, and m₁ − m₂ needs only a quarter of the
// range.
fn packed(m: vec4f) -> vec4f {
    return vec4f(m.x, 4.0 * (m.x - m.y), 0.0, 0.0);
}

fn unpacked(stored: vec4f) -> vec4f {
    return vec4f(stored.x, stored.x - 0.25 * stored.y, 0.0, 0.0);
}
