// needs: moments_share, soft_moments
// What the moments of the growing warp and those of depth say of the share of light.

// What rounding may make of no variance: relative to the squared warp, and absolute.
override LEAST_VARIANCE: f32 = 1e-6;
override LEAST_DEPTH_VARIANCE: f32 = 1e-7;

fn depth_share(m: vec4f, receiver: f32) -> f32 {
    return largest_share(m.z, max(m.w - m.z * m.z, LEAST_DEPTH_VARIANCE), receiver);
}

fn warped_share(m: vec4f, receiver: f32) -> f32 {
    // In units of the larger of both, as `bound` in `bounds.wgsl`.
    let warped = warp(receiver);
    let unit = 1.0 / max(m.x, warped);
    let mean = m.x * unit;
    let own = warped * unit;
    return largest_share(mean, max(m.y * unit * unit - mean * mean, LEAST_VARIANCE * own * own), own);
}
