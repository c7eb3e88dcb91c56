// needs: soft_taps, moments_share
// Looks filtered moments up for filters that follow the light's size: group 2, beside taps and
// bounds.

@group(2) @binding(2) var<uniform> moments: Moments;
@group(2) @binding(3) var moment_map: MomentArray;

// Variance that bilinear weights and the boxes that were averaged add, squared texels of the level.
const OF_LEVEL: f32 = 0.25;

// Of what is found on levels of this squared width, in texels of level 0; squared texels of the map
// along each axis.
fn variance_of_level(squared_width: f32) -> f32 {
    return moments.variance + OF_LEVEL * moments.scale * moments.scale * squared_width;
}

// Bilinear, `offset` texels away from the receiver or where the map ends.
fn moments_near(point: MapPoint, offset: vec2f, index: u32) -> Found {
    let level = level_at(point.layer, index);
    let at = clamp((point.texel + offset) / level.width - 0.5, vec2f(0.0), vec2f(f32(level.last)));
    let first = vec2i(at);
    let second = min(first + 1, vec2i(level.last));
    let f = at - vec2f(first);
    let upper = mix(moments_at(level, first), moments_at(level, vec2i(second.x, first.y)), f.x);
    let lower = mix(moments_at(level, vec2i(first.x, second.y)), moments_at(level, second), f.x);
    return Found(mix(upper, lower, f.y), (at + 0.5) * level.width - point.texel);
}
