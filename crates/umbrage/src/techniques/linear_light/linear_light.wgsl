// needs: map_visibility
// What a point of the light sees of a receiver: the shares of the light up to its neighbours on
// both sides, in the order of `lookup.neighbours`.

struct PointLookup {
    // Relative to the eye.
    here: vec3f,
    // Layers of shares for each neighbour.
    layers: u32,
    neighbours: array<vec4f, 2>,
}

@group(2) @binding(0) var<uniform> lookup: PointLookup;
@group(2) @binding(1) var shares: texture_2d_array<f32>;
// What the point before sees of each pixel.
@group(2) @binding(2) var before: texture_2d<f32>;

// Neighbours that points have.
override NEIGHBOURS: u32 = 2u;
// How far behind what a pixel shows the map may be and still show the same, as a share of the
// depth.
override THRESHOLD: f32 = 0.005;

// More than all of the light: no blocker was found between a point and its neighbour.
const NONE: f32 = 2.0;

// Of the piece up to a neighbour that a point sees without a blocker, half is counted with the one
// and half with the other.
fn counted(found: f32) -> f32 {
    return select(found, 0.5, found > 1.0);
}

// Of the piece up to one neighbour; `above` is how far the point is over the receiver's plane.
fn share_to(neighbour: u32, found: f32, receiver: vec3f, surface: Surface, above: f32) -> f32 {
    // The receiver's own plane hides what is behind it.
    let neighbour_above = dot(surface.normal, lookup.neighbours[neighbour].xyz - receiver);
    let is_cut = surface.casts && above > 0.0 && neighbour_above < 0.0;
    return counted(min(found, select(NONE, above / (above - neighbour_above), is_cut)));
}

fn shares_at(point: MapPoint, pixel: Pixel) -> vec2f {
    let texel = vec2i(point.texel);
    let stored = load_depth(texel, point.layer);
    let offset = vec2f(texel) + 0.5 - point.texel;
    if !is_lit(point, offset, stored) {
        return vec2f(0.0);
    }
    if NEIGHBOURS == 0u {
        return vec2f(1.0);
    }
    // The texel may show what is behind the receiver, and its shares are then no concern of it.
    let is_another = is_lit_beyond(point, offset, stored, -THRESHOLD * point.depth);
    let receiver = position_of(pixel);
    let above = dot(pixel.surface.normal, lookup.here - receiver);
    let first = select(textureLoad(shares, texel, point.layer, 0).x, NONE, is_another);
    let seen = share_to(0u, first, receiver, pixel.surface, above);
    if NEIGHBOURS == 1u {
        return vec2f(seen);
    }
    let second = select(textureLoad(shares, texel, point.layer + lookup.layers, 0).x, NONE, is_another);
    return vec2f(seen, share_to(1u, second, receiver, pixel.surface, above));
}

fn shares_of(pixel: Pixel) -> vec2f {
    let first = point_by_matrix(pixel, 0u);
    let split = layer_of_pixel(pixel, first);
    let point = map_point(pixel, first, split.layer);
    if is_settled(pixel, point) {
        return vec2f(0.5 * settled_share(pixel, point));
    }
    return shares_at(point, pixel);
}

@fragment
fn point_shares(@builtin(position) at: vec4f) -> @location(0) vec2f {
    return shares_of(pixel_at(at.xy));
}

// What both ends see of the last piece of the light, as `pieces.wgsl` has it.
@fragment
fn last_piece(@builtin(position) at: vec4f) -> @location(0) f32 {
    let first = textureLoad(before, vec2i(at.xy), 0).x;
    return min(first + shares_of(pixel_at(at.xy)).x, 1.0);
}

// A light that is one point.
fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    return shares_at(point, pixel).x;
}
