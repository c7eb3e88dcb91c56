// needs: moments_mean
// Warped depth and its square, of one exponential that grows and of one that falls.

// Of the growing and of the falling one, over half the range of depth.
override GROWTH: f32 = 42.0;
override DECAY: f32 = 42.0;

// Multiplies both, as an exponent.
override LIFT: f32 = 0.0;

// Both grow with depth.
fn warps(depth: f32) -> vec2f {
    let z = 2.0 * depth - 1.0;
    return vec2f(exp(GROWTH * z + LIFT), -exp(LIFT - DECAY * z));
}

fn moments_of(depth: f32) -> vec4f {
    let w = warps(depth);
    return vec4f(w.x, w.x * w.x, w.y, w.y * w.y);
}
