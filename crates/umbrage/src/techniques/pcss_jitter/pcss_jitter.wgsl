// The combined method (ZA 4.4.3): a jittered search for blockers, then jittered taps as wide as the penumbra, the first few on the
// rim and the rest only where these differ.

override TESTS: u32 = 8u;

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let kernel = light_kernel(point, pixel);
    let first = first_tap(pixel.at);
    let reach = farthest_reach(point, kernel);
    let above = kernel.horizon.x - abs(kernel.horizon.y) - abs(kernel.horizon.z);
    if reach <= 0.0 && above > 0.0 {
        return 1.0;
    }
    let found = search_blockers(point, kernel, first, reach);
    if found.count == 0.0 && above > 0.0 {
        return 1.0;
    }
    let tests = min(TESTS, FILTER);
    var seen = 0u;
    for (var i = 0u; i < FILTER; i++) {
        if i == tests && (seen == 0u || seen == tests) {
            return select(0.0, 1.0, seen > 0u);
        }
        let at = taps.offsets[first + SEARCH + i];
        seen += select(0u, 1u, is_seen(point, kernel, at, reach_toward(found, at)));
    }
    return f32(seen) / f32(FILTER);
}
