// needs: map_visibility
// What is blurred: percentage-closer filtering over a square of 3 × 3 bilinear compares (ZA 3.2),
// or a single compare.

override IS_HARD: bool = false;

fn nearest_texel(point: MapPoint) -> f32 {
    let texel = vec2i(point.texel);
    let stored = load_depth(texel, point.layer);
    return select(0.0, 1.0, is_lit(point, vec2f(texel) + 0.5 - point.texel, stored));
}

// Four compares around the corner between texels (corner − 1, corner), in the order of
// textureGather.
fn compare_four(point: MapPoint, slope: vec2f, corner: vec2f, bias: f32) -> vec4f {
    let reference = reference_of(depth_along(point, slope, corner - point.texel) + bias);
    return textureGatherCompare(map_depth, map_compare, corner / map.size, point.layer, reference);
}

// Nine bilinear compares are the 4 × 4 texels around: the outer ones count by the fraction that the
// square covers.
fn nine_compares(point: MapPoint) -> f32 {
    let slope = map_slope(point);
    let bias = map_bias(point, slope, 1.0 + CREASE);
    let base = floor(point.texel - 0.5);
    let f = point.texel - 0.5 - base;
    let a = compare_four(point, slope, base, bias);
    let b = compare_four(point, slope, base + vec2f(2.0, 0.0), bias);
    let c = compare_four(point, slope, base + vec2f(0.0, 2.0), bias);
    let d = compare_four(point, slope, base + 2.0, bias);
    let columns = vec4f(1.0 - f.x, 1.0, 1.0, f.x);
    let rows = vec4f(
        dot(columns, vec4f(a.wz, b.wz)),
        dot(columns, vec4f(a.xy, b.xy)),
        dot(columns, vec4f(c.wz, d.wz)),
        dot(columns, vec4f(c.xy, d.xy)),
    );
    return dot(rows, vec4f(1.0 - f.y, 1.0, 1.0, f.y)) / 9.0;
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    if IS_HARD {
        return nearest_texel(point);
    }
    return nine_compares(point);
}
