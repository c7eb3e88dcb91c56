// Exponential shadow maps (Annen et al. 2008).

// Shares of light of the texels around, each compared with the receiver's plane continued to there.
fn share_on(point: MapPoint, receiver: LinearPoint, level: i32) -> f32 {
    let s = spline_at(point.texel, level);
    var sum = 0.0;
    for (var y = 0; y < 3; y++) {
        for (var x = 0; x < 3; x++) {
            let place = (vec2f(f32(s.columns[x]), f32(s.rows[y])) + 0.5) * s.width;
            let depth = receiver.depth + dot(receiver.slope, place - point.texel);
            let stored = moments_at(s.columns[x], s.rows[y], point.layer, level).x;
            sum += s.x[x] * s.y[y] * exp(min(EXPONENT * (stored - depth), 0.0));
        }
    }
    return sum;
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let level = level_of_pixel(point, pixel);
    let receiver = linear_point(point, vec2f(0.0), (1.0 + CREASE) * exp2(level));
    var sum = 0.0;
    for (var i = 0; f32(i) < level + 1.0 && i < i32(textureNumLevels(moment_map)); i++) {
        let share = share_of_level(level, i);
        if share > 0.0 {
            sum += share * share_on(point, receiver, i);
        }
    }
    return without_bleeding(sum);
}
