// needs: map_visibility
// What a point of the light sees of a receiver: the shares of the light up to its neighbours on
// both sides, in the order of `lookup.neighbours`.

struct PointLookup {
    // Relative to the eye.
    here: vec3f,
    // How many neighbours there are, and layers of shares for each of them.
    count: u32,
    neighbours: array<vec4f, 2>,
    layers: u32,
    // How far behind what a pixel shows the map may be and still show the same, as a share of the
    // depth.
    threshold: f32,
    pad: vec2u,
}

@group(2) @binding(0) var<uniform> lookup: PointLookup;
@group(2) @binding(1) var shares: texture_2d_array<f32>;

// More than all of the light: no blocker was found between a point and its neighbour.
const NONE: f32 = 2.0;

// Of the piece up to a neighbour that a point sees without a blocker, half is counted with the one
// and half with the other.
fn counted(found: f32) -> f32 {
    return select(found, 0.5, found > 1.0);
}

fn shares_at(point: MapPoint, pixel: Pixel) -> vec2f {
    let texel = vec2i(point.texel);
    let stored = load_depth(texel, point.layer);
    let offset = vec2f(texel) + 0.5 - point.texel;
    if !is_lit(point, offset, stored) {
        return vec2f(0.0);
    }
    // The texel may show what is behind the receiver, and its shares are then no concern of it.
    let is_another = is_lit_beyond(point, offset, stored, -lookup.threshold * point.depth);
    let receiver = position_eye(map.eye, pixel.at, pixel.depth);
    let above = dot(pixel.surface.normal, lookup.here - receiver);
    var seen = vec2f(0.5);
    for (var i = 0u; i < lookup.count; i++) {
        let found = textureLoad(shares, texel, point.layer + i * lookup.layers, 0).x;
        // The receiver's own plane hides what is behind it.
        let neighbour_above = dot(pixel.surface.normal, lookup.neighbours[i].xyz - receiver);
        let is_cut = pixel.surface.casts && above > 0.0 && neighbour_above < 0.0;
        let horizon = select(NONE, above / (above - neighbour_above), is_cut);
        seen[i] = counted(min(select(found, NONE, is_another), horizon));
    }
    return select(seen, vec2f(1.0), lookup.count == 0u);
}

@fragment
fn point_shares(@builtin(position) at: vec4f) -> @location(0) vec2f {
    let pixel = pixel_at(at.xy);
    let first = point_by_matrix(pixel, 0u);
    let split = layer_of_pixel(pixel, first);
    let point = map_point(pixel, first, split.layer);
    if is_settled(pixel, point) {
        return vec2f(settled_share(pixel, point) * select(0.5, 1.0, lookup.count == 0u));
    }
    return shares_at(point, pixel);
}

// A light that is one point.
fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    return shares_at(point, pixel).x;
}
