// needs: map_visibility
// Percentage-closer filtering: the share of compares that pass around the receiver (ZA 3.2, FE
// 2.3.1).

// 2, 3, 5, 7: a square of that many bilinear compares a side; 4: a bicubic B-spline; 0: a disc.
override KERNEL: u32 = 3u;
// Of the disc.
override TAPS: u32 = 16u;
override RADIUS: f32 = 2.5;

// Four compares around the corner between texels (corner − 1, corner), in the order of
// textureGather.
fn gather(point: MapPoint, slope: vec2f, corner: vec2f, bias: f32) -> vec4f {
    let reference = reference_of(depth_along(point, slope, corner - point.texel) + bias);
    return textureGatherCompare(map_depth, map_compare, corner / map.size, point.layer, reference);
}

// A gather's four compares by the weights of their columns and rows.
fn weighted(lit: vec4f, columns: vec2f, rows: vec2f) -> f32 {
    return rows.x * (columns.x * lit.w + columns.y * lit.z) + rows.y * (columns.x * lit.x + columns.y * lit.y);
}

// A box of KERNEL × KERNEL bilinear compares. Together they are the (KERNEL + 1)² texels around,
// each weighted by its overlap with the box: inner ones whole, those at the border by the fraction.
// Gathers fetch them four at a time.
fn square(point: MapPoint, slope: vec2f, bias: f32) -> f32 {
    let base = floor(point.texel - 0.5);
    let f = point.texel - 0.5 - base;
    let half_kernel = i32(KERNEL / 2u);
    var sum = 0.0;
    for (var y = -half_kernel; y <= half_kernel + 1; y += 2) {
        // Weights of the two rows of this gather.
        let rows = vec2f(select(1.0, 1.0 - f.y, y == -half_kernel), select(1.0, f.y, y == half_kernel));
        for (var x = -half_kernel; x <= half_kernel + 1; x += 2) {
            let columns = vec2f(select(1.0, 1.0 - f.x, x == -half_kernel), select(1.0, f.x, x == half_kernel));
            let lit = gather(point, slope, base + vec2f(f32(x), f32(y)) + 1.0, bias);
            sum += weighted(lit, columns, rows);
        }
    }
    return sum / f32(KERNEL * KERNEL);
}

// Weights of the four texels around a place that is `f` beyond the second one: a cubic B-spline.
fn cubic(f: f32) -> vec4f {
    let g = 1.0 - f;
    return vec4f(g * g * g, 4.0 - 3.0 * f * f * (1.0 + g), 4.0 - 3.0 * g * g * (1.0 + f), f * f * f) / 6.0;
}

// The 4 × 4 texels around, weighted by a bicubic B-spline (SG "Rendering Fake Soft Shadows with
// Smoothies": 16 samples).
fn bicubic(point: MapPoint, slope: vec2f, bias: f32) -> f32 {
    let base = floor(point.texel - 0.5);
    let columns = cubic(point.texel.x - 0.5 - base.x);
    let rows = cubic(point.texel.y - 0.5 - base.y);
    return weighted(gather(point, slope, base, bias), columns.xy, rows.xy)
        + weighted(gather(point, slope, base + vec2f(2.0, 0.0), bias), columns.zw, rows.xy)
        + weighted(gather(point, slope, base + vec2f(0.0, 2.0), bias), columns.xy, rows.zw)
        + weighted(gather(point, slope, base + 2.0, bias), columns.zw, rows.zw);
}

// Points spread evenly over a disc along a golden spiral (Vogel), turned for every pixel so that
// steps become grain.
fn disc(point: MapPoint, slope: vec2f, at: vec2f, radius: f32, bias: f32) -> f32 {
    let turn = gradient_noise(at) * 6.2831853;
    var sum = 0.0;
    for (var i = 0u; i < TAPS; i++) {
        let angle = turn + f32(i) * 2.3999632;
        let offset = radius * sqrt((f32(i) + 0.5) / f32(TAPS)) * vec2f(cos(angle), sin(angle));
        let reference = reference_of(depth_along(point, slope, offset) + bias);
        sum += textureSampleCompareLevel(map_depth, map_compare, (point.texel + offset) / map.size, point.layer, reference);
    }
    return sum / f32(TAPS);
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let slope = map_slope(point);
    // A bilinear compare shares one reference depth between texels up to a texel away. For gathers
    // half of that would do on a plane, but wide filters meet curved surfaces: 7×7 then loses 0.05
    // % of the interior of `primitives`.
    let radius = filter_radius(point, RADIUS);
    let width = select(0.5 * f32(KERNEL), radius, KERNEL == 0u);
    let bias = map_bias(point, slope, 1.0 + CREASE) + map_bend(point, max(width - 1.0, 0.0));
    if KERNEL == 0u {
        return disc(point, slope, pixel.at, radius, bias);
    }
    if KERNEL == 2u {
        return textureSampleCompareLevel(map_depth, map_compare, point.texel / map.size, point.layer, reference_of(point.depth + bias));
    }
    if KERNEL == 4u {
        return bicubic(point, slope, bias);
    }
    return square(point, slope, bias);
}
