// needs: moments_mean
// Warped depth and its square, and depth and its square: two steepnesses, of which the lesser is 0.

override GROWTH: f32 = 42.0;

fn warp(depth: f32) -> f32 {
    return exp(GROWTH * (2.0 * depth - 1.0));
}

fn moments_of(depth: f32) -> vec4f {
    let w = warp(depth);
    return vec4f(w, w * w, depth, depth * depth);
}

// For even steps from 0 to 1: the warp over its largest value, and as much of the square of depth
// as the variance needs.
fn packed(m: vec4f) -> vec4f {
    let largest = warp(1.0);
    return vec4f(m.x / largest, m.y / (largest * largest), m.z, 4.0 * (m.z - m.w));
}

fn unpacked(stored: vec4f) -> vec4f {
    let largest = warp(1.0);
    return vec4f(stored.x * largest, stored.y * largest * largest, stored.z, stored.z - 0.25 * stored.w);
}
