// needs: moments_share, moments
// What warped moments say of the share of light.

// 2: the growing warp alone, 4: both.
override COMPONENTS: u32 = 4u;
// What rounding may make of no variance, relative to the squared warp.
override LEAST_VARIANCE: f32 = 1e-6;

// Beyond this many standard deviations nothing of the receiver's own plane is in the filter.
const EXTENT: f32 = 3.0;

// In units of the larger of both: at the far end of the falling warp a variance is too small for a
// normal number, and devices differ in whether there are others.
fn bound(mean: f32, square: f32, warped: f32) -> f32 {
    let unit = 1.0 / max(abs(mean), abs(warped));
    let m = mean * unit;
    let w = warped * unit;
    return largest_share(m, max(square * unit * unit - m * m, LEAST_VARIANCE * w * w), w);
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
