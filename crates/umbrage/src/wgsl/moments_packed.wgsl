// Moments of every width, each level half as fine as the one before: group 2, beside taps and bounds. Level 0 of a view fills a layer;
// the others share one with those of a second view, stacked in its left or right half. So a level of a pixel's own is a place
// and no level of the texture, which the software driver would take from the first of 2 × 2 pixels.

@group(2) @binding(2) var<uniform> moments: Moments;
@group(2) @binding(3) var moment_map: MomentArray;

// Variance that bilinear weights and the boxes that were averaged add, squared texels of the level.
const OF_LEVEL: f32 = 0.25;

// Of what is found on a level, squared texels of the map along each axis.
fn variance_of_packed(level: f32) -> f32 {
    return moments.variance + OF_LEVEL * moments.scale * moments.scale * exp2(2.0 * level);
}

// Bilinear, `offset` texels away from the receiver or where the map ends.
fn moments_near(point: MapPoint, offset: vec2f, level: u32) -> Found {
    let side = moments.side >> level;
    let width = moments.scale * f32(1u << level);
    let at = clamp((point.texel + offset) / width - 0.5, vec2f(0.0), vec2f(f32(side - 1u)));
    let first = vec2u(at);
    let second = min(first + 1u, vec2u(side - 1u));
    let f = at - vec2f(first);
    var layer = point.layer;
    var corner = vec2u(0u);
    if level > 0u {
        layer = moments.views + (point.layer >> 1u);
        corner = vec2u((point.layer & 1u) * (moments.side >> 1u), moments.side - (moments.side >> (level - 1u)));
    }
    let a = from_stored(textureLoad(moment_map, corner + first, layer, 0));
    let b = from_stored(textureLoad(moment_map, corner + vec2u(second.x, first.y), layer, 0));
    let c = from_stored(textureLoad(moment_map, corner + vec2u(first.x, second.y), layer, 0));
    let d = from_stored(textureLoad(moment_map, corner + second, layer, 0));
    return Found(mix(mix(a, b, f.x), mix(c, d, f.x), f.y), (at + 0.5) * width - point.texel);
}
