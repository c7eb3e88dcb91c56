// needs: map_visibility, soft_taps
// Percentage-closer soft shadows on grids (ZA 3.5), without their traps: a grid of taps looks for
// blockers, their distance gives the width of the penumbra, and a grid of that width is compared.

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let kernel = light_kernel(point, pixel);
    let found = search_blockers(point, kernel, 0u, farthest_reach(point, kernel));
    // No blocker: all lit. Blockers wherever one looks: umbra.
    if (found.count == 0.0 || found.count > f32(SEARCH)) && !is_cut_by_horizon(kernel) {
        return select(0.0, 1.0, found.count == 0.0);
    }
    var seen = 0u;
    for (var i = 0u; i < FILTER; i++) {
        let at = taps.offsets[SEARCH + i];
        seen += select(0u, 1u, is_seen(point, kernel, at, reach_toward(found, at)));
    }
    return f32(seen) / f32(FILTER);
}
