// What a cell of the silhouette map holds: a number that is a depth as well, so that the depth test
// chooses among several points, always the same one whatever the order of drawing. 0 is none.

// Keys are floats from the first that is normal up to 1.
const FIRST_KEY: u32 = 0x00800000u;
const STEPS: f32 = 1006.0;

// Of a point in its cell, 0 to 1 right and down, where depth steps by `step`, 0 to 1; what is a
// larger part of a cell from its middle comes before others with such a step, and what is left goes
// by the point.
fn key_of(place: vec2f, step: f32, from_middle: f32) -> f32 {
    let steps = u32(sqrt(saturate(step)) * STEPS);
    let outermost = u32(clamp(8.0 + 11.0 * from_middle, 0.0, 15.0));
    let at = vec2u(round(saturate(place) * 255.0));
    return bitcast<f32>(FIRST_KEY + ((steps << 20u) | (outermost << 16u) | (at.x << 8u) | at.y));
}

// The middle where there is none: without points all is as in a map of depths.
fn place_of(key: f32) -> vec2f {
    let bits = bitcast<u32>(key);
    let at = vec2f(vec2u(bits >> 8u, bits) & vec2u(255u)) / 255.0;
    return select(at, vec2f(0.5), key == 0.0);
}
