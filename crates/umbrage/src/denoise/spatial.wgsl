// needs: fullscreen, receivers
// Takes grain out of penumbras: a mean over the pixels around that show the same plane, no wider
// than the penumbra is even.

// Pairs of pixels, one on either side; those of the inner square come first.
const PAIRS: u32 = 12u;
const INNER: u32 = 4u;

// Pixels across a pair that the surface may leave its plane by, over their distance.
const FLAT: f32 = 0.1;
// Means of pairs that deviate by up to so many times what grain explains count as even; those that
// deviate twice as much do not at all.
const EVEN: f32 = 1.5;
// Change from pixel to pixel, times the pairs' reach, up to which a penumbra is wide; one of twice
// as much is narrow.
const WIDE: f32 = 0.06;
// Grain that is there even where next to all taps agree.
const LEAST: f32 = 0.01;

struct Spatial {
    eye: Eye,
    size: vec2i,
    // Standard deviation of the mean of two pixels that see half of the light.
    grain: f32,
    pad: f32,
    // One pixel of each pair, from the middle; the other one is across. Third: their distance.
    pairs: array<vec4f, PAIRS>,
}

@group(1) @binding(0) var<uniform> spatial: Spatial;
@group(1) @binding(1) var grainy: texture_2d<f32>;

// What two pixels on either side have in common.
struct Pair {
    mean: f32,
    // From the one to the other.
    change: f32,
    counts: f32,
}

// Sums over pairs.
struct Sums {
    mean: f32,
    square: f32,
    count: f32,
    // For the slope of visibility: of offset times change, and of twice the square of the offset.
    change: vec2f,
    offset: vec2f,
}

// Change of depth that moves a surface by as much as a pixel is wide.
fn depth_of_a_pixel(eye: Eye, at: vec2f, depth: f32) -> f32 {
    let m = eye.eye_from_ndc;
    let ndc = ndc_of(eye, at, depth);
    let inverse_w = 1.0 / eye_w(eye, ndc);
    let place = (m * ndc).xyz * inverse_w;
    let metres_per_depth = length(m[2].xyz - place * m[2].w);
    let pixel = max(length(m[0].xyz) * abs(eye.ndc_from_pixel.x), length(m[1].xyz) * abs(eye.ndc_from_pixel.y));
    return pixel / max(metres_per_depth, 1e-30);
}

// A pair counts as a whole or not at all: then a penumbra that is even stays what it is, also
// beside the edge of a surface. On a plane depth is linear over the screen.
fn pair(at: vec2i, offset: vec2i, depth: f32, off: f32) -> Pair {
    let a = at + offset;
    let b = at - offset;
    let first = clamp(a, vec2i(0), spatial.size - 1);
    let second = clamp(b, vec2i(0), spatial.size - 1);
    let depths = vec2f(textureLoad(receiver_depth, first, 0), textureLoad(receiver_depth, second, 0));
    let is_inside = all(a == first) && all(b == second);
    let is_drawn = all(depths != vec2f(spatial.eye.background_depth));
    let is_flat = abs(depths.x + depths.y - 2.0 * depth) <= off;
    let there = textureLoad(grainy, first, 0).x;
    let across = textureLoad(grainy, second, 0).x;
    return Pair(0.5 * (there + across), there - across, select(0.0, 1.0, is_inside && is_drawn && is_flat));
}

fn with_pair(sums: Sums, offset: vec2f, found: Pair) -> Sums {
    return Sums(
        sums.mean + found.counts * found.mean,
        sums.square + found.counts * found.mean * found.mean,
        sums.count + found.counts,
        sums.change + found.counts * found.change * offset,
        sums.offset + found.counts * 2.0 * offset * offset,
    );
}

// The mean of all pairs, which reach so many pixels far, and of the pixel itself, which is half of
// one; and how far that is a penumbra's: 0 where pairs differ by more than grain, as they do at an
// edge, and where the penumbra is narrower than they reach.
fn smoothed(own: f32, sums: Sums, reach: f32) -> vec2f {
    let mean = sums.mean / max(sums.count, 1.0);
    let deviation = sqrt(max(sums.square / max(sums.count, 1.0) - mean * mean, 0.0));
    let grain = LEAST + spatial.grain * 2.0 * sqrt(max(mean * (1.0 - mean), 0.0));
    let evenness = saturate(2.0 - deviation / (EVEN * grain));
    let slope = length(sums.change / max(sums.offset, vec2f(1.0)));
    let share = min(evenness, saturate(2.0 - slope * reach / WIDE));
    return vec2f((0.5 * own + sums.mean) / (0.5 + sums.count), select(0.0, share, sums.count > 0.0));
}

@fragment
fn smooth_penumbras(@builtin(position) position: vec4f) -> @location(0) f32 {
    let at = vec2i(position.xy);
    let own = textureLoad(grainy, at, 0).x;
    let depth = textureLoad(receiver_depth, at, 0);
    if depth == spatial.eye.background_depth {
        return own;
    }
    let flat = FLAT * depth_of_a_pixel(spatial.eye, position.xy, depth);
    var sums = Sums(0.0, 0.0, 0.0, vec2f(0.0), vec2f(0.0));
    var near = vec2f(own, 0.0);
    for (var i = 0u; i < PAIRS; i++) {
        let step = spatial.pairs[i];
        sums = with_pair(sums, step.xy, pair(at, vec2i(step.xy), depth, flat * step.z));
        if i == INNER - 1u {
            near = smoothed(own, sums, 1.0);
            // Most pixels see all or none of the light, as those beside them do.
            if own * (1.0 - own) == 0.0 && sums.mean == own * sums.count {
                break;
            }
        }
    }
    let far = smoothed(own, sums, 2.0);
    return mix(mix(own, near.x, near.y), far.x, far.y);
}
