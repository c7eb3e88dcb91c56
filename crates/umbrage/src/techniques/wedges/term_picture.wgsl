// needs: coverage
// Shares of a square that shows a picture by a look-up over both ends of a chord (SG "Precomputed
// 4D textures"), see `TexturedTable` in the core crate.

// A of a chord: x and y are its start, z counts the places of its end, row by row.
@group(2) @binding(0) var triangles: texture_3d<f32>;
@group(2) @binding(1) var filtered: sampler;
// Shares on the way around the square from 0 to 1, evenly spaced.
@group(2) @binding(2) var<storage, read> sectors: array<f32>;

fn disc_term(c: Across, inside: bool) -> f32 {
    return disc_analytic(c, inside);
}

fn square_term(c: Chord, inside: bool) -> f32 {
    return triangle_on_picture(c) - sector_on_picture(c, inside);
}

fn triangle_on_picture(c: Chord) -> f32 {
    let size = textureDimensions(triangles);
    let side = f32(size.x);
    let start = saturate(c.start * 0.5 + 0.5) * (side - 1.0);
    let end = saturate(c.end * 0.5 + 0.5) * (side - 1.0);
    // Within a row the sampler mixes, between rows this does.
    let row = min(floor(end.y), side - 2.0);
    let layer = row * side + end.x;
    let at = (vec3f(start, layer) + 0.5) / vec3f(size);
    let low = textureSampleLevel(triangles, filtered, at, 0.0).x;
    let high = textureSampleLevel(triangles, filtered, at + vec3f(0.0, 0.0, 1.0 / side), 0.0).x;
    return mix(low, high, end.y - row);
}

fn sector_on_picture(c: Chord, inside: bool) -> f32 {
    let start = around_square(c.start);
    let end = around_square(c.end);
    let way = end - start;
    let turn = signed(way - round(way), 0.25, inside);
    // The way there may lead over the corner where counting starts, once.
    return light_up_to(end) - light_up_to(start) + round(turn - way);
}

fn light_up_to(around: f32) -> f32 {
    let last = arrayLength(&sectors) - 1u;
    let scaled = saturate(around) * f32(last);
    let low = min(u32(scaled), last - 1u);
    return mix(sectors[low], sectors[low + 1u], scaled - f32(low));
}
