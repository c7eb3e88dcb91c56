// needs: moments_share, soft_moments
// What the moments of the growing warp and those of depth say of the share of light.

// What rounding may make of no variance: relative to the squared warp, and absolute.
override LEAST_VARIANCE: f32 = 1e-6;
override LEAST_DEPTH_VARIANCE: f32 = 1e-7;

fn depth_share(m: vec4f, receiver: f32) -> f32 {
    return largest_share(m.z, max(m.w - m.z * m.z, LEAST_DEPTH_VARIANCE), receiver);
}

fn warped_share(m: vec4f, receiver: f32) -> f32 {
    let warped = warp(receiver);
    return largest_share(m.x, max(m.y - m.x * m.x, LEAST_VARIANCE * warped * warped), warped);
}
