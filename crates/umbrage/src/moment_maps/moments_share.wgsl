// needs: map_lookup, moments_depth
// What filtered moments say of a receiver. The technique gives `moments_of`, beside a look-up that
// binds `moments`.

// Shares of light up to this count as none.
override BLEEDING: f32 = 0.0;

// What a plane falls to at most that leaves the light's view.
const LEAST_STORED: f32 = 1e-30;

// Moments come in levels, each half as fine as the one before. Level 0 of a view fills a layer; the
// others share one with those of a second view, stacked in its left or right half. So a level of a
// pixel's own is a place and no level of the texture: the software driver takes those from the
// first of 2 × 2 pixels, which may look somewhere else, or nowhere.
struct Level {
    layer: u32,
    corner: vec2i,
    // Of its texels, the last across and down.
    last: i32,
    // Texels of the map across one of its own.
    width: f32,
}

fn level_at(layer: u32, level: u32) -> Level {
    let side = moments.side >> level;
    let width = moments.scale * f32(1u << level);
    if level == 0u {
        return Level(layer, vec2i(0), i32(side) - 1, width);
    }
    let corner = vec2u((layer & 1u) * (moments.side >> 1u), moments.side - (moments.side >> (level - 1u)));
    return Level(moments.views + (layer >> 1u), vec2i(corner), i32(side) - 1, width);
}

fn moments_at(level: Level, texel: vec2i) -> vec4f {
    return from_stored(textureLoad(moment_map, level.corner + texel, level.layer, 0));
}

// What was looked up, and how many texels away from the receiver: where the map ends, filters stay
// inside.
struct Found {
    moments: vec4f,
    offset: vec2f,
}

// The receiver in linear depth.
struct LinearPoint {
    depth: f32,
    // Change per texel.
    slope: vec2f,
}

// The receiver's plane, `offset` texels away.
fn linear_point(point: MapPoint, offset: vec2f, crease: f32) -> LinearPoint {
    let slope = map_slope(point);
    let stored = max(depth_along(point, slope, offset) + map_bias(point, slope, crease), LEAST_STORED);
    return LinearPoint(linear_depth(moments, stored), slope * linear_depth_change(moments, stored));
}

// The largest share of a distribution of this mean and variance that can lie at `depth` or farther
// (Chebyshev).
fn largest_share(mean: f32, variance: f32, depth: f32) -> f32 {
    let nearer = max(depth - mean, 0.0);
    return variance / (variance + nearer * nearer);
}

// Takes what bleeds off the bottom.
fn without_bleeding(share: f32) -> f32 {
    return clamp((share - BLEEDING) / (1.0 - BLEEDING), 0.0, 1.0);
}
