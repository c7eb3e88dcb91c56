// needs: map_visibility, moments_lookup, moments
// Exponential shadow maps (Annen et al. 2008).

// Shares of light of the texels around, each compared with the receiver's plane continued to there.
fn share_on(point: MapPoint, receiver: LinearPoint, level: Level) -> f32 {
    let s = spline_at(point.texel, level);
    var sum = 0.0;
    for (var y = 0; y < 3; y++) {
        for (var x = 0; x < 3; x++) {
            let texel = vec2i(s.columns[x], s.rows[y]);
            let depth = receiver.depth + dot(receiver.slope, (vec2f(texel) + 0.5) * level.width - point.texel);
            sum += s.x[x] * s.y[y] * exp(min(EXPONENT * (moments_at(level, texel).x - depth), 0.0));
        }
    }
    return sum;
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let level = level_of_pixel(point, pixel);
    let receiver = linear_point(point, vec2f(0.0), (1.0 + CREASE) * exp2(level));
    let between = levels_around(level);
    var sum = 0.0;
    for (var i = 0; i < 2; i++) {
        sum += between.shares[i] * share_on(point, receiver, level_at(point.layer, between.levels[i]));
    }
    return without_bleeding(sum);
}
