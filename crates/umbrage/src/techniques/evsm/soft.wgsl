// needs: map_visibility, moments_soft, soft_bounds
// Exponential variance shadow maps whose filter follows the light. Blockers are looked for as
// `pcss` does. The filter's taps are few: each sees all that lies between it and its neighbours,
// with the receiver's plane continued to its own place.

// Texels of a level over the distance between taps.
const COARSE: f32 = 1.2;
// How far the receiver's plane reaches within a tap, texels of the level.
const SPREAD: f32 = 0.7;
// Reach of what surely hides nothing, and of what surely hides a point of the light, over that of
// the point. The reach of what a tap sees is an estimate, so that there is some way between the
// two.
const LOOSE: f32 = 0.7;
const TIGHT: f32 = 0.95;

// The receiver's plane.
struct Plane {
    slope: vec2f,
    bias: f32,
    // How much linear depth changes along it per texel, at most.
    change: f32,
}

// What is in the way of the light where a tap looks: which share of that it is, and its reach.
struct Cover {
    share: f32,
    reach: f32,
}

fn plane_of(point: MapPoint) -> Plane {
    let slope = map_slope(point);
    let change = (abs(slope.x) + abs(slope.y)) * abs(linear_depth_change(moments, point.depth));
    return Plane(slope, map_bias(point, slope, CREASE), change);
}

fn cover_near(point: MapPoint, kernel: LightKernel, plane: Plane, offset: vec2f, level: u32) -> Cover {
    let found = moments_near(point, offset, level);
    let stored = max(depth_along(point, plane.slope, found.offset) + plane.bias, LEAST_STORED);
    let receiver = linear_depth(moments, stored);
    // What slopes towards the light within the tap is no blocker: steep exponentials would take it
    // for one.
    let nearest = receiver - plane.change * moments.scale * f32(1u << level) * SPREAD;
    let lit = min(depth_share(found.moments, receiver), warped_share(found.moments, nearest));
    // A receiver and a blocker, two depths, have the mean that was found.
    let depth = max(receiver - max(receiver - found.moments.z, 0.0) / max(1.0 - lit, 1e-6), 0.0);
    return Cover(1.0 - without_bleeding(lit), reach_of(point, kernel, found.offset, stored_depth(moments, depth)));
}

// How taps see the light at some reach.
struct Filter {
    // Of each tap's level, and a share of 1 before it is the next.
    level: f32,
    // Shrinks the places of taps, so that with what each of them sees the light is as large as it
    // is.
    shrink: vec2f,
}

fn filter_at(kernel: LightKernel, reach: f32) -> Filter {
    let size = reach * vec2f(length(kernel.right), length(kernel.up));
    let most = max(size.x, size.y);
    let least = min(size.x, size.y);
    let count = f32(FILTER);
    let apart = max(min(2.0 * sqrt(most * least / count), least), 2.0 * most / count);
    let level = clamp(log2(max(COARSE * apart / moments.scale, 1e-6)), 0.0, f32(moments.levels - 1u));
    let full = select(0.25, 1.0 / 3.0, taps.head.is_square != 0u) * size * size;
    // Of what taps see: some are on this level, the others on the next finer one.
    let whole = floor(level);
    let variance = variance_of_level(max(exp2(2.0 * whole) * mix(0.25, 1.0, level - whole), 1.0));
    let share = variance / max(full, vec2f(1e-12));
    return Filter(level, sqrt(max(1.0 - share, vec2f(0.0))));
}

// The next coarser level is taken by more and more taps, so that nothing is seen of the step.
fn level_of_tap(level: f32, i: u32) -> u32 {
    return u32(max(level - fract(0.618034 * f32(i)), 0.0));
}

// Which part of the cell around a tap is above the receiver's horizon.
fn share_above_horizon(kernel: LightKernel, at: vec2f) -> f32 {
    let height = kernel.horizon.x + dot(kernel.horizon.yz, at);
    let half = (abs(kernel.horizon.y) + abs(kernel.horizon.z)) / sqrt(f32(FILTER));
    return clamp(0.5 + 0.5 * height / max(half, 1e-30), 0.0, 1.0);
}

// How much of what has this reach hides a point of the light, and not one beyond its rim: see
// `is_seen`.
fn share_within(reach: f32, least: f32) -> f32 {
    return clamp((reach - LOOSE * least) / max((TIGHT - LOOSE) * least, 1e-30), 0.0, 1.0);
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let kernel = light_kernel(point, pixel);
    let plane = plane_of(point);
    let found = search_blockers(point, kernel, 0u, farthest_reach(point, kernel));
    let filtered = filter_at(kernel, found.reach);
    var seen = 0.0;
    for (var i = 0u; i < FILTER; i++) {
        let place = taps.offsets[SEARCH + i];
        let at = place * filtered.shrink;
        let reach = reach_toward(found, at);
        let cover = cover_near(point, kernel, plane, kernel_offset(kernel, at, reach), level_of_tap(filtered.level, i));
        let hidden = cover.share * share_within(cover.reach, reach * rim(at));
        seen += share_above_horizon(kernel, place) * (1.0 - hidden);
    }
    return seen / f32(FILTER);
}
