// What filtered moments say of a receiver. After the technique's `moments_of`, beside a look-up that binds `moments`.

// Shares of light up to this count as none.
override BLEEDING: f32 = 0.0;

// The receiver in linear depth.
struct LinearPoint {
    depth: f32,
    // Change per texel.
    slope: vec2f,
}

fn linear_point(point: MapPoint, crease: f32) -> LinearPoint {
    let slope = map_slope(point);
    let stored = point.depth + map_bias(point, slope, crease);
    return LinearPoint(linear_depth(moments, stored), slope * linear_depth_change(moments, stored));
}

// The largest share of a distribution of this mean and variance that can lie at `depth` or farther (Chebyshev).
fn largest_share(mean: f32, variance: f32, depth: f32) -> f32 {
    let nearer = max(depth - mean, 0.0);
    return variance / (variance + nearer * nearer);
}

// Takes what bleeds off the bottom.
fn without_bleeding(share: f32) -> f32 {
    return clamp((share - BLEEDING) / (1.0 - BLEEDING), 0.0, 1.0);
}
