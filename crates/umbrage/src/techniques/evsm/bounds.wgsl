// needs: moments_share, moments
// What warped moments say of the share of light.

// 2: the growing warp alone, 4: both.
override COMPONENTS: u32 = 4u;
// What rounding may make of no variance, relative to the squared warp.
override LEAST_VARIANCE: f32 = 1e-6;

// Beyond this many standard deviations nothing of the receiver's own plane is in the filter.
const EXTENT: f32 = 3.0;

fn bound(mean: f32, square: f32, warped: f32) -> f32 {
    let variance = max(square - mean * mean, LEAST_VARIANCE * warped * warped);
    return largest_share(mean, variance, warped);
}

// `variance` is the filter's. The mean of a slanted plane's falling warp is that of a point
// somewhat nearer to the light, by a second-order term: for depths of a normal distribution exactly
// half the exponent times their variance.
fn share_of(m: vec4f, receiver: LinearPoint, variance: f32) -> f32 {
    let grown = bound(m.x, m.y, warps(receiver.depth).x);
    if COMPONENTS < 4u {
        return grown;
    }
    let spread = variance * dot(receiver.slope, receiver.slope);
    let nearer = min(DECAY * spread, EXTENT * sqrt(spread));
    return min(grown, bound(m.z, m.w, warps(receiver.depth - nearer).y));
}
