// The bounds pyramid: nearest and farthest depth of ever larger cells of a map. Cells that lie beyond the map repeat its border.

@group(0) @binding(0) var map_level: texture_depth_2d;
@group(0) @binding(0) var below: texture_2d<f32>;

// Of 4 × 4 texels.
@fragment
fn bounds_of_map(@builtin(position) position: vec4f) -> @location(0) vec2f {
    let first = vec2i(position.xy) * 4;
    let last = vec2i(textureDimensions(map_level)) - 1;
    var bounds = vec2f(0.0, 1e9);
    for (var i = 0; i < 16; i++) {
        let depth = textureLoad(map_level, min(first + vec2i(i & 3, i >> 2), last), 0);
        bounds = vec2f(max(bounds.x, depth), min(bounds.y, depth));
    }
    return bounds;
}

// Of 2 × 2 cells.
@fragment
fn bounds_of_bounds(@builtin(position) position: vec4f) -> @location(0) vec2f {
    let first = vec2i(position.xy) * 2;
    let a = textureLoad(below, first, 0).xy;
    let b = textureLoad(below, first + vec2i(1, 0), 0).xy;
    let c = textureLoad(below, first + vec2i(0, 1), 0).xy;
    let d = textureLoad(below, first + vec2i(1, 1), 0).xy;
    return vec2f(max(max(a.x, b.x), max(c.x, d.x)), min(min(a.y, b.y), min(c.y, d.y)));
}
