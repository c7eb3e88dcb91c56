// Percentage-closer soft shadows as they were published (ZA 3.5), without their traps: a grid of taps looks for blockers, their
// mean distance gives the width of the penumbra, and a grid of that width is compared.

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let kernel = light_kernel(point, pixel);
    let reach = farthest_reach(point, kernel);
    var sum = 0.0;
    var count = 0u;
    for (var i = 0u; i < SEARCH; i++) {
        let stored = stored_near(point, kernel_offset(kernel, taps.offsets[i], reach));
        let found = blocker(point, kernel, stored);
        sum += max(found, 0.0);
        count += select(0u, 1u, found > 0.0);
    }
    // No blocker, all lit; blockers wherever one looks, umbra.
    if (count == 0u || count == SEARCH) && !is_cut_by_horizon(kernel) {
        return select(0.0, 1.0, count == 0u);
    }
    let mean = sum / f32(max(count, 1u));
    var seen = 0u;
    for (var i = 0u; i < FILTER; i++) {
        seen += select(0u, 1u, is_seen(point, kernel, taps.offsets[SEARCH + i], mean));
    }
    return f32(seen) / f32(FILTER);
}
