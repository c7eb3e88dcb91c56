// needs: moments_share
// Looks filtered moments up: group 2. The technique gives `moments_of`.

@group(2) @binding(0) var<uniform> moments: Moments;
@group(2) @binding(1) var moment_map: MomentArray;

// Takes coarser levels where a pixel covers many texels.
override MIPS: bool = true;

// The 3 × 3 texels around a point and the weights of a quadratic B-spline: smooth where bilinear
// weights show the grid, and of the same variance everywhere, ¼. At the border of the map, the
// texels there count for those beyond.
struct Spline {
    columns: vec3i,
    rows: vec3i,
    x: vec3f,
    y: vec3f,
}

fn spline_weights(f: f32) -> vec3f {
    return vec3f(0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f));
}

fn spline_at(texel: vec2f, level: Level) -> Spline {
    let at = texel / level.width;
    let middle = clamp(vec2i(at), vec2i(0), vec2i(level.last));
    let f = clamp(at - vec2f(middle) - 0.5, vec2f(-0.5), vec2f(0.5));
    let before = max(middle - 1, vec2i(0));
    let after = min(middle + 1, vec2i(level.last));
    let columns = vec3i(before.x, middle.x, after.x);
    let rows = vec3i(before.y, middle.y, after.y);
    return Spline(columns, rows, spline_weights(f.x), spline_weights(f.y));
}

// The mean place of what is looked up, texels of the map: the point itself but at the border.
fn spline_place(s: Spline, level: Level) -> vec2f {
    return (vec2f(dot(s.x, vec3f(s.columns)), dot(s.y, vec3f(s.rows))) + 0.5) * level.width;
}

fn moments_in_row(s: Spline, row: i32, level: Level) -> vec4f {
    return s.x.x * moments_at(level, vec2i(s.columns.x, row))
        + s.x.y * moments_at(level, vec2i(s.columns.y, row))
        + s.x.z * moments_at(level, vec2i(s.columns.z, row));
}

fn moments_on(s: Spline, level: Level) -> vec4f {
    return s.y.x * moments_in_row(s, s.rows.x, level)
        + s.y.y * moments_in_row(s, s.rows.y, level)
        + s.y.z * moments_in_row(s, s.rows.z, level);
}

// The two levels that a level lies between, and how much of each is in it.
struct Between {
    levels: vec2u,
    shares: vec2f,
}

fn levels_around(level: f32) -> Between {
    let lower = u32(level);
    let share = level - f32(lower);
    return Between(vec2u(lower, min(lower + 1u, moments.levels - 1u)), vec2f(1.0 - share, share));
}

fn moments_between(texel: vec2f, layer: u32, level: f32) -> Found {
    let between = levels_around(level);
    var sum = vec4f(0.0);
    var offset = vec2f(0.0);
    for (var i = 0; i < 2; i++) {
        let one = level_at(layer, between.levels[i]);
        let s = spline_at(texel, one);
        sum += between.shares[i] * moments_on(s, one);
        offset += between.shares[i] * (spline_place(s, one) - texel);
    }
    return Found(sum, offset);
}

// Texels of the map that a pixel covers, as the side of a square: from the receiver's plane.
fn texels_of_pixel(point: MapPoint, pixel: Pixel) -> f32 {
    let eye = map.eye.eye_from_ndc;
    let normal = vec4f(pixel.surface.normal, -dot(pixel.surface.normal, position_of(pixel)));
    // Change of depth along the plane, per step to the right and down.
    let plane = vec3f(dot(normal, eye[0]), dot(normal, eye[1]), dot(normal, eye[2]));
    let change = -plane.xy / plane.z * map.eye.ndc_from_pixel;
    let to_map = map.layers[point.layer].map_from_place;
    let place = to_map * pixel.place;
    let step_right = step_of_place(pixel, vec4f(map.eye.ndc_from_pixel.x, 0.0, change.x, 0.0));
    let step_down = step_of_place(pixel, vec4f(0.0, map.eye.ndc_from_pixel.y, change.y, 0.0));
    let right = texel_step(point.layer, place, to_map * step_right);
    let down = texel_step(point.layer, place, to_map * step_down);
    let w = texel_w(place);
    let a = (right.xy - point.texel * right.z) / w;
    let b = (down.xy - point.texel * down.z) / w;
    let sum = dot(a, a) + dot(b, b);
    let area = abs(a.x * b.y - a.y * b.x);
    return area / sqrt(0.5 * (sum + sqrt(max(sum * sum - 4.0 * area * area, 0.0))));
}

// The level whose filter is as wide as that of level 0 and the pixel together. Level n has a
// variance of 4ⁿ / 3 − 1 / 12, a pixel one of 1 / 12 of its square.
fn level_of_pixel(point: MapPoint, pixel: Pixel) -> f32 {
    if !MIPS {
        return 0.0;
    }
    let side = texels_of_pixel(point, pixel) / (2.0 * moments.scale);
    // Not a number where a surface is seen edge-on.
    let level = select(0.0, log2(side), side > 1.0 && side < 65536.0);
    return min(level, f32(moments.levels - 1u));
}

// Of the filter of a level, squared texels of the map along each axis.
fn variance_of(level: f32) -> f32 {
    return moments.variance + moments.scale * moments.scale * (exp2(2.0 * level) - 1.0) / 3.0;
}
