// needs: map_visibility, map_taps
// Percentage-closer filtering over a jittered disc (ZA 3.4): a few taps on the rim first, the rest
// only where these differ.

override TAPS: u32 = 64u;
override TESTS: u32 = 8u;
override RADIUS: f32 = 4.0;

fn lit_taps(point: MapPoint, radius: f32, first: u32, from_tap: u32, to_tap: u32) -> u32 {
    let bend = map_bend(point, radius);
    var lit = 0u;
    for (var i = from_tap; i < to_tap; i++) {
        let stored = stored_near(point, radius * taps.offsets[first + i]);
        lit += select(0u, 1u, is_lit_beyond(point, stored.offset, stored.depth, bend));
    }
    return lit;
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let first = first_tap(pixel.at);
    let tests = min(TESTS, TAPS);
    let radius = filter_radius(point, RADIUS);
    let lit = lit_taps(point, radius, first, 0u, tests);
    if lit == 0u || lit == tests {
        return select(0.0, 1.0, lit > 0u);
    }
    return f32(lit + lit_taps(point, radius, first, tests, TAPS)) / f32(TAPS);
}
