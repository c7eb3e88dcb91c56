// Moments of the growing warp and of depth itself, the falling warp without steepness.

override LEAST_VARIANCE: f32 = 1e-6;
override LEAST_DEPTH_VARIANCE: f32 = 1e-7;

// The smaller bound on the share of light.
fn share_of(m: vec4f, receiver: f32) -> f32 {
    let warped = warp(receiver);
    let grown = largest_share(m.x, max(m.y - m.x * m.x, LEAST_VARIANCE * warped * warped), warped);
    return min(grown, largest_share(m.z, max(m.w - m.z * m.z, LEAST_DEPTH_VARIANCE), receiver));
}
