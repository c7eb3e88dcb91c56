// needs: light_kernel, map_taps, map_cells
// Filters that follow the light's size: how far to look, what is in the way, and which share of the
// light it hides.

@group(2) @binding(1) var<storage, read> map_bounds: MapBounds;

// Taps of the search; those of the filter follow them in the table.
override SEARCH: u32 = 16u;
override FILTER: u32 = 32u;
// Bounds of depth tell how far to look; else the nearest caster there can be.
override BOUNDED: bool = true;

// Base 2 logarithm of the cells across a box, at least.
const CELLS: u32 = 1u;
// How often the bounds are looked up, each time around a smaller box.
const ROUNDS: i32 = 2;

// Half a penumbra in texels that is not worth looking for.
const NARROW: f32 = 0.5;
// How much nearer than looked for a blocker may be and still hide the rim of the light.
const SLACK: f32 = 1.6;
// Reach of what is in the way, at least, however its depth is rounded.
const LEAST_REACH: f32 = 1e-6;
// Keeps a plane through few blockers from tilting by chance.
const LEAST_SPREAD: f32 = 0.02;

// Half the size of the box of texels that a light hides behind at this reach.
fn kernel_box(kernel: LightKernel, reach: f32) -> vec2f {
    let nearest = 1.0 - reach * (abs(kernel.nearer.x) + abs(kernel.nearer.y));
    return (abs(kernel.right) + abs(kernel.up)) * (reach / clamp(nearest, 0.25, 1.0));
}

// Reach of what hides the light from the receiver where `stored` was found; negative where that is
// not in the way.
fn blocker(point: MapPoint, kernel: LightKernel, stored: Stored) -> f32 {
    if is_lit(point, stored.offset, stored.depth) {
        return -1.0;
    }
    return max(reach_of(point, kernel, stored.offset, stored.depth), LEAST_REACH);
}

// Reach of a blocker of this depth somewhere in a cell of texels, or more. In perspective, by the
// triangle of receiver, blocker and light: a blocker at distance b of a light of radius R has (1 +
// reach) b ≤ d + reach R, with d the receiver's distance.
fn reach_of_cell(point: MapPoint, kernel: LightKernel, low: vec2f, high: vec2f, nearest: f32) -> f32 {
    if !PERSPECTIVE {
        return reach_of(point, kernel, vec2f(0.0), nearest);
    }
    let axis = map.layers[point.layer].axis;
    let off_axis = select((clamp(axis.xy, low, high) - axis.xy) * axis.zw, vec2f(0.0), LAYOUT == PARABOLOIDS);
    let distance = sqrt(1.0 + dot(off_axis, off_axis)) / (map.layers[point.layer].per_metre * max(nearest, 1e-30));
    return reach_beyond(kernel, distance);
}

// Of a blocker at this distance from a point light, or farther.
fn reach_beyond(kernel: LightKernel, distance: f32) -> f32 {
    return (kernel.distance - distance) / max(distance - kernel.radius, 1e-3 * distance);
}

// Largest reach that a blocker can have that hides a point of the light and lies within `reach`,
// from the cells of the pyramid that are a few to the box. What a cell holds counts only if the
// light, seen at its reach, gets as far as the cell.
fn reach_within(point: MapPoint, kernel: LightKernel, reach: f32) -> f32 {
    let half = kernel_box(kernel, reach);
    let last = vec2f(map.size - 1.0);
    let finest = map_bounds.head.finest;
    let a = vec2u(clamp(point.texel - half, vec2f(0.0), last)) >> vec2u(finest);
    let b = vec2u(clamp(point.texel + half, vec2f(0.0), last)) >> vec2u(finest);
    let across = max(b.x - a.x, b.y - a.y) >> CELLS;
    let level = select(min(firstLeadingBit(across) + 1u, map_bounds.head.levels - 1u), 0u, across == 0u);
    let first_cell = a >> vec2u(level);
    let last_cell = b >> vec2u(level);
    let width = f32(1u << (level + finest));
    let index = cell_index(map_bounds.head, point.layer, level, vec2u(0u));
    let row = map_bounds.head.cells >> level;
    var farthest = 0.0;
    for (var y = first_cell.y; y <= last_cell.y; y++) {
        for (var x = first_cell.x; x <= last_cell.x; x++) {
            let nearest = depth_of(map_bounds.nearest[index + y * row + x], map.farthest);
            let low = vec2f(f32(x), f32(y)) * width;
            let possible = min(reach_of_cell(point, kernel, low, low + width, nearest), reach);
            let gap = max(low - point.texel, point.texel - low - width);
            if possible > farthest && all(gap <= kernel_box(kernel, possible) + 1.0) {
                farthest = possible;
            }
        }
    }
    return farthest;
}

// Largest reach that any blocker can have: starts at that of the nearest caster, and no more than
// the whole map, and shrinks to what is really there. 0 where there is none.
fn farthest_reach(point: MapPoint, kernel: LightKernel) -> f32 {
    let box = kernel_box(kernel, 1.0);
    let whole = map.size / max(max(box.x, box.y), 1e-6);
    let nearest = map.layers[point.layer].nearest;
    var reach = whole;
    if PERSPECTIVE {
        reach = min(whole, reach_beyond(kernel, 1.0 / (map.layers[point.layer].per_metre * max(nearest, 1e-30))));
    } else {
        reach = min(whole, reach_of(point, kernel, vec2f(0.0), nearest));
    }
    for (var i = 0; BOUNDED && i < ROUNDS && reach > 0.0; i++) {
        reach = reach_within(point, kernel, reach);
    }
    return max(reach, 0.0);
}

// What the search found: blockers as a plane, whose reach is a linear function of the place in the
// search.
struct Blockers {
    count: f32,
    // Reach in the middle, and its change over the light's half axes at the reach of the search.
    reach: f32,
    change: vec2f,
    least: f32,
    most: f32,
}

// Looks for blockers within `reach`. A mean of their reaches alone would be that of the middle of
// what was found, and shadows end at its border.
fn search_blockers(point: MapPoint, kernel: LightKernel, first: u32, reach: f32) -> Blockers {
    var any = vec2f(0.0);
    var count = 0.0;
    var sum = vec3f(0.0);
    var products = vec3f(0.0);
    var with_reach = vec2f(0.0);
    var least = 1e30;
    var most = 0.0;
    for (var i = 0u; i <= SEARCH; i++) {
        // The light's centre is always among the taps, so that no umbra is missed.
        let at = select(taps.offsets[first + min(i, SEARCH - 1u)], vec2f(0.0), i == SEARCH);
        let stored = stored_near(point, kernel_offset(kernel, at, reach));
        let found = blocker(point, kernel, stored);
        any += select(vec2f(0.0), vec2f(found, 1.0), found > 0.0);
        // What is nearer to the receiver hides points of the light further out: beyond its rim it
        // hides nothing.
        if found > 0.0 && found >= reach * rim(at) {
            count += 1.0;
            sum += vec3f(at, found);
            products += vec3f(at.x * at.x, at.x * at.y, at.y * at.y);
            with_reach += at * found;
            least = min(least, found);
            most = max(most, found);
        }
    }
    if count == 0.0 {
        // Nothing that surely hides the light; what there is nearer to the receiver may extend to
        // where it does.
        let mean = any.x / max(any.y, 1.0);
        return Blockers(any.y, mean, vec2f(0.0), mean, mean);
    }
    let mean = sum / count;
    let spread = products / count - vec3f(mean.x * mean.x, mean.x * mean.y, mean.y * mean.y) + vec3f(LEAST_SPREAD, 0.0, LEAST_SPREAD);
    let slope = with_reach / count - mean.xy * mean.z;
    let change = vec2f(spread.z * slope.x - spread.y * slope.y, spread.x * slope.y - spread.y * slope.x)
        / (spread.x * spread.z - spread.y * spread.y);
    return Blockers(count, mean.z - dot(change, mean.xy), change / reach, least, most);
}

// Reach at which the blockers' plane is met on the way to the point `at` of the light.
fn reach_toward(found: Blockers, at: vec2f) -> f32 {
    let reach = found.reach / max(1.0 - dot(found.change, at), 1e-3);
    return clamp(reach, found.least, found.most);
}

// How far out on the light a point is: 1 on its rim.
fn rim(at: vec2f) -> f32 {
    return select(length(at), max(abs(at.x), abs(at.y)), taps.head.is_square != 0u);
}

// Whether the tap finds the point `at` of the light in sight. What was found much nearer to the
// receiver than was looked for hides a point farther out; beyond the rim that is none.
fn is_seen(point: MapPoint, kernel: LightKernel, at: vec2f, reach: f32) -> bool {
    let found = blocker(point, kernel, stored_near(point, kernel_offset(kernel, at, reach)));
    return is_above_horizon(kernel, at) && !(found > 0.0 && found * SLACK >= reach * rim(at));
}
