// needs: coverage
// Shares of discs by the look-ups of PX 4.2, see `SphereTable` in the core crate; those of squares
// have no table and are computed.

@group(2) @binding(0) var shares: texture_3d<f32>;
@group(2) @binding(1) var filtered: sampler;

// An end that was cut at the disc's border is looked up well outside, where the table has no bend.
fn outwards(end: f32, border: f32) -> f32 {
    return select(abs(end), 1.0, abs(end) >= border * 0.999999);
}

fn disc_term(c: Across, inside: bool) -> f32 {
    let size = f32(textureDimensions(shares).x);
    let border = sqrt(max(1.0 - c.distance * c.distance, 0.0));
    let distances = vec3f(abs(c.distance), outwards(c.start, border), outwards(c.end, border));
    // Values are at the middles of texels.
    let both = textureSampleLevel(shares, filtered, (distances * (size - 1.0) + 0.5) / size, 0.0).xy;
    let share = select(both.y, both.x, c.start * c.end > 0.0);
    return select(share, -share, inside);
}

fn square_term(c: Chord, inside: bool) -> f32 {
    return on_square(c, inside);
}
