// needs: map_quick, soft_taps
// The combined method (ZA 4.4.3): a jittered search for blockers, then jittered taps as wide as the
// penumbra, the first few on the rim and the rest only where these differ.

override TESTS: u32 = 8u;

// What the bounds of depth decide: nothing in the way, or so close that the penumbra is lost in a
// texel. Negative where they leave it open.
fn narrow_share(point: MapPoint, kernel: LightKernel, reach: f32) -> f32 {
    let half = kernel_box(kernel, reach);
    if is_cut_by_horizon(kernel) || max(half.x, half.y) > NARROW {
        return -1.0;
    }
    let stored = stored_near(point, vec2f(0.0));
    return select(0.0, 1.0, is_lit(point, stored.offset, stored.depth));
}

fn quick_share(point: MapPoint, pixel: Pixel) -> f32 {
    let kernel = light_kernel(point, pixel);
    return narrow_share(point, kernel, farthest_reach(point, kernel));
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let kernel = light_kernel(point, pixel);
    let reach = farthest_reach(point, kernel);
    let narrow = narrow_share(point, kernel, reach);
    if narrow >= 0.0 {
        return narrow;
    }
    let first = first_tap(pixel.at);
    let found = search_blockers(point, kernel, first, reach);
    if found.count == 0.0 && !is_cut_by_horizon(kernel) {
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
