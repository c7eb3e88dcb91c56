// Exponential variance shadow maps whose filter follows the light: the search and the filter of `pcss`, of a few taps that each see all
// that lies between them and their neighbours.

// Taps a side of the two grids.
override SEARCH_SIDE: f32 = 4.0;
override FILTER_SIDE: f32 = 4.0;
// Texels of a level over the distance between taps.
override COARSE: f32 = 1.4;

// Share that is not worth counting.
const LEAST_SHARE: f32 = 1e-3;

// The receiver's plane.
struct Plane {
    slope: vec2f,
    bias: f32,
}

// Which share of a tap is in the way of the light, and its reach.
struct Cover {
    share: f32,
    reach: f32,
}

fn cover_near(point: MapPoint, kernel: LightKernel, plane: Plane, offset: vec2f, level: u32) -> Cover {
    let found = moments_near(point, offset, level);
    let m = found.moments;
    let receiver = linear_depth(moments, max(depth_along(point, plane.slope, found.offset) + plane.bias, 1e-30));
    let share = 1.0 - without_bleeding(share_of(m, receiver));
    // Receiver and blocker, two depths, have this mean.
    let depth = max(receiver - max(receiver - m.z, 0.0) / max(share, LEAST_SHARE), 0.0);
    return Cover(share, reach_of(point, kernel, found.offset, stored_depth(moments, depth)));
}

// How taps see a light at some reach.
struct Grid {
    // Of each tap's level, a share of 1 before it is the next.
    level: f32,
    // Shrinks the places of taps, so that with what each of them sees the light is as large as it is.
    shrink: vec2f,
}

fn grid_at(kernel: LightKernel, reach: f32, side: f32) -> Grid {
    let a = reach * length(kernel.right);
    let b = reach * length(kernel.up);
    let most = max(a, b);
    let least = min(a, b);
    let wide = max(min(2.0 * sqrt(most * least) / side, least), 2.0 * most / (side * side));
    let last = f32(moments.levels - 1u);
    let level = clamp(log2(max(COARSE * wide / moments.scale, 1e-6)), 0.0, last);
    let variance = variance_of_packed(level - 0.5);
    let full = select(0.25, 1.0 / 3.0, taps.head.is_square != 0u);
    let share = variance / (full * max(vec2f(a * a, b * b), vec2f(1e-12)));
    return Grid(level, sqrt(max(1.0 - share, vec2f(0.0))));
}

fn level_of_tap(grid: Grid, i: u32, count: u32) -> u32 {
    return u32(max(grid.level - (f32(i) + 0.5) / f32(count), 0.0));
}

fn search_moments(point: MapPoint, kernel: LightKernel, plane: Plane, reach: f32) -> Blockers {
    let grid = grid_at(kernel, reach, SEARCH_SIDE);
    var any = vec2f(0.0);
    var count = 0.0;
    var sum = vec3f(0.0);
    var products = vec3f(0.0);
    var with_reach = vec2f(0.0);
    var least = 1e30;
    var most = 0.0;
    for (var i = 0u; i <= SEARCH; i++) {
        let at = select(taps.offsets[min(i, SEARCH - 1u)], vec2f(0.0), i == SEARCH);
        let level = select(level_of_tap(grid, i, SEARCH), 0u, i == SEARCH);
        let cover = cover_near(point, kernel, plane, kernel_offset(kernel, at, reach), level);
        let found = clamp(cover.reach, 0.0, reach);
        let share = select(0.0, cover.share, cover.share > LEAST_SHARE);
        any += share * vec2f(found, 1.0);
        if share > 0.0 && found >= reach * rim(at) {
            count += share;
            sum += share * vec3f(at, found);
            products += share * vec3f(at.x * at.x, at.x * at.y, at.y * at.y);
            with_reach += share * at * found;
            least = min(least, found);
            most = max(most, found);
        }
    }
    if count == 0.0 {
        let mean = any.x / max(any.y, LEAST_SHARE);
        return Blockers(any.y, mean, vec2f(0.0), mean, mean);
    }
    let mean = sum / count;
    let spread = products / count - vec3f(mean.x * mean.x, mean.x * mean.y, mean.y * mean.y) + vec3f(LEAST_SPREAD, 0.0, LEAST_SPREAD);
    let slope = with_reach / count - mean.xy * mean.z;
    let change = vec2f(spread.z * slope.x - spread.y * slope.y, spread.x * slope.y - spread.y * slope.x)
        / (spread.x * spread.z - spread.y * spread.y);
    return Blockers(count, mean.z - dot(change, mean.xy), change / max(reach, 1e-30), least, most);
}

// Which part of the cell around a tap is above the receiver's horizon.
fn share_above_horizon(kernel: LightKernel, at: vec2f) -> f32 {
    let height = kernel.horizon.x + dot(kernel.horizon.yz, at);
    let half = (abs(kernel.horizon.y) + abs(kernel.horizon.z)) / FILTER_SIDE;
    return clamp(0.5 + 0.5 * height / max(half, 1e-30), 0.0, 1.0);
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let kernel = light_kernel(point, pixel);
    let slope = map_slope(point);
    let plane = Plane(slope, map_bias(point, slope, CREASE));
    let found = search_moments(point, kernel, plane, farthest_reach(point, kernel));
    let grid = grid_at(kernel, found.reach, FILTER_SIDE);
    var seen = 0.0;
    for (var i = 0u; i < FILTER; i++) {
        let at = taps.offsets[SEARCH + i] * grid.shrink;
        let reach = reach_toward(found, at);
        let cover = cover_near(point, kernel, plane, kernel_offset(kernel, at, reach), level_of_tap(grid, i, FILTER));
        let hidden = select(0.0, cover.share, max(cover.reach, 0.0) * SLACK >= reach * rim(at));
        seen += share_above_horizon(kernel, at) * (1.0 - hidden);
    }
    return seen / f32(FILTER);
}
