// needs: fullscreen, moments_depth
// From a depth map to its filtered moments: take moments, halve, blur along each axis. The
// technique gives `moments_of`.

@group(0) @binding(0) var<uniform> moments: Moments;
@group(0) @binding(1) var map_level: texture_depth_2d;
@group(0) @binding(1) var finer: MomentTexture;

// Texels of the map across one that is written.
override STEP: i32 = 1;
// Blurs down, else across.
override DOWN: bool = false;

fn moments_at_texel(texel: vec2i) -> vec4f {
    let last = vec2i(textureDimensions(map_level)) - 1;
    return moments_of(linear_depth(moments, textureLoad(map_level, clamp(texel, vec2i(0), last), 0)));
}

// Mean moments of STEP × STEP texels.
@fragment
fn take(@builtin(position) at: vec4f) -> @location(0) StoredMoments {
    let first = vec2i(at.xy) * STEP;
    let count = STEP * STEP;
    var top = moments_at_texel(first);
    for (var i = 1; i < count; i++) {
        top = max(top, moments_at_texel(first + vec2i(i % STEP, i / STEP)));
    }
    var sum = vec4f(0.0);
    for (var i = 0; i < count; i++) {
        sum += summand(moments_at_texel(first + vec2i(i % STEP, i / STEP)), top);
    }
    return to_stored(mean_of(sum / f32(count), top));
}

// Mean moments of the 3 × 3 texels around each, weighted.
@fragment
fn take_around(@builtin(position) at: vec4f) -> @location(0) StoredMoments {
    let middle = vec2i(at.xy);
    var top = moments_at_texel(middle);
    for (var i = 0; i < 9; i++) {
        top = max(top, moments_at_texel(middle + vec2i(i % 3, i / 3) - 1));
    }
    var sum = vec4f(0.0);
    for (var i = 0; i < 9; i++) {
        let step = vec2i(i % 3, i / 3) - 1;
        let weight = moments.taps[abs(step.x)] * moments.taps[abs(step.y)];
        sum += weight * summand(moments_at_texel(middle + step), top);
    }
    return to_stored(mean_of(sum, top));
}

fn finer_at(texel: vec2i) -> vec4f {
    let last = vec2i(textureDimensions(finer)) - 1;
    return from_stored(textureLoad(finer, clamp(texel, vec2i(0), last), 0));
}

// Mean of 2 × 2.
@fragment
fn halve(@builtin(position) at: vec4f) -> @location(0) StoredMoments {
    let first = vec2i(at.xy) * 2;
    let a = finer_at(first);
    let b = finer_at(first + vec2i(1, 0));
    let c = finer_at(first + vec2i(0, 1));
    let d = finer_at(first + vec2i(1, 1));
    let top = max(max(a, b), max(c, d));
    let sum = summand(a, top) + summand(b, top) + summand(c, top) + summand(d, top);
    return to_stored(mean_of(sum * 0.25, top));
}

// Five binomial taps along an axis.
@fragment
fn blur(@builtin(position) at: vec4f) -> @location(0) StoredMoments {
    let middle = vec2i(at.xy);
    let step = select(vec2i(1, 0), vec2i(0, 1), DOWN);
    let a = finer_at(middle - 2 * step);
    let b = finer_at(middle - step);
    let c = finer_at(middle);
    let d = finer_at(middle + step);
    let e = finer_at(middle + 2 * step);
    let top = max(max(max(a, b), max(d, e)), c);
    let near = summand(b, top) + summand(d, top);
    let far = summand(a, top) + summand(e, top);
    return to_stored(mean_of(moments.taps.x * summand(c, top) + moments.taps.y * near + moments.taps.z * far, top));
}
