// needs: map_visibility
// Behind the map there is shadow, behind a smoothie what that says, before both there is light.

@group(2) @binding(0) var smoothie_share: texture_2d_array<f32>;
// How far the nearest smoothie is before what the map holds, see `before` in `fins.wgsl`; negative.
@group(2) @binding(1) var smoothie_before: texture_2d_array<f32>;

// The texel of the point, or the four around it, each with a decision of its own.
override FOUR: bool = false;
override REMAP: bool = true;

// What is rounded in a half float.
const ROUNDED: f32 = 1.0 - 1.0 / 1024.0;

// Depth of the nearest smoothie.
fn fin_depth(texel: vec2i, layer: u32, stored: f32) -> f32 {
    let before = -textureLoad(smoothie_before, texel, layer, 0).x * ROUNDED;
    let alone = before / select(1.0, map.layers[layer].per_metre, PERSPECTIVE);
    let over = select(stored + before, stored / (1.0 - before), PERSPECTIVE);
    return select(select(over, alone, stored == 0.0), 0.0, before == 0.0);
}

// What one texel says; `bend` is forgiven besides.
fn share_by(point: MapPoint, texel: vec2i, bend: f32) -> f32 {
    let offset = vec2f(texel) + 0.5 - point.texel;
    let stored = load_depth(texel, point.layer);
    let fin = fin_depth(texel, point.layer, stored);
    let share = textureLoad(smoothie_share, texel, point.layer, 0).x;
    // The map holds no receiver there, but there is one: a surface that casts no shadow.
    let own = share * fin / max(fin - point.depth, 1e-30);
    let through = saturate(select(share, own, REMAP && stored == 0.0));
    let lit = select(through, 1.0, is_lit_beyond(point, offset, fin, bend));
    return select(0.0, lit, is_lit_beyond(point, offset, stored, bend));
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    if !FOUR {
        return share_by(point, vec2i(point.texel), 0.0);
    }
    let base = floor(point.texel - 0.5);
    let f = point.texel - 0.5 - base;
    let low = vec2i(max(base, vec2f(0.0)));
    let high = vec2i(min(base + 1.0, vec2f(map.size - 1.0)));
    // These texels may be half a texel farther away.
    let slope = map_slope(point);
    let bend = map.bias * 0.5 * (abs(slope.x) + abs(slope.y));
    let above = mix(share_by(point, low, bend), share_by(point, vec2i(high.x, low.y), bend), f.x);
    let below = mix(share_by(point, vec2i(low.x, high.y), bend), share_by(point, high, bend), f.x);
    return mix(above, below, f.y);
}
