// needs: map_visibility
// What a point of the light sees of a receiver: the shares of the light up to its neighbours on
// both sides, in the order of `lookup.neighbours`.

struct PointLookup {
    // Relative to the eye.
    here: vec3f,
    // Layers of shares for each neighbour.
    layers: u32,
    // The ways from here to the neighbours.
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

// Of the other one of two points, whose layers in `map` are those from the middle on.
@group(2) @binding(3) var other_shares: texture_2d_array<f32>;
@group(2) @binding(4) var other_depth: texture_depth_2d_array;
const FIRST_OF_OTHER: u32 = LOOKUP_LAYERS / 2u;

// More than all of the light: no blocker was found between a point and its neighbour.
const NONE: f32 = 2.0;

// Of the piece up to a neighbour that a point sees without a blocker, half is counted with the one
// and half with the other.
fn counted(found: f32) -> f32 {
    return select(found, 0.5, found > 1.0);
}

// How far a point is over the receiver's plane, and how much less a neighbour is, both times the
// length of the normal.
struct Rise {
    above: f32,
    below: f32,
}

fn rise_to(neighbour: u32, above: f32, surface: Surface) -> Rise {
    return Rise(above, -dot(surface.normal, lookup.neighbours[neighbour].xyz));
}

fn height_over(pixel: Pixel) -> f32 {
    return dot(pixel.surface.normal, lookup.here - position_of(pixel));
}

// Of the piece up to a neighbour. The receiver's own plane hides what is behind it.
fn share_to(found: f32, rise: Rise, casts: bool) -> f32 {
    let is_cut = casts && rise.above > 0.0 && rise.below > rise.above;
    return counted(min(found, select(NONE, rise.above / rise.below, is_cut)));
}

fn offset_to(texel: vec2i, point: MapPoint) -> vec2f {
    return vec2f(texel) + 0.5 - point.texel;
}

// The texel may show what is behind the receiver, and its shares are then no concern of it.
fn shows_another(point: MapPoint, offset: vec2f, stored: f32) -> bool {
    return is_lit_beyond(point, offset, stored, -THRESHOLD * point.depth);
}

fn shares_at(point: MapPoint, pixel: Pixel) -> vec2f {
    let texel = vec2i(point.texel);
    let stored = load_depth(texel, point.layer);
    let offset = offset_to(texel, point);
    if !is_lit(point, offset, stored) {
        return vec2f(0.0);
    }
    if NEIGHBOURS == 0u {
        return vec2f(1.0);
    }
    let is_another = shows_another(point, offset, stored);
    let above = height_over(pixel);
    let casts = pixel.surface.casts;
    let first = select(textureLoad(shares, texel, point.layer, 0).x, NONE, is_another);
    let seen = share_to(first, rise_to(0u, above, pixel.surface), casts);
    if NEIGHBOURS == 1u {
        return vec2f(seen);
    }
    let second = select(textureLoad(shares, texel, point.layer + lookup.layers, 0).x, NONE, is_another);
    return vec2f(seen, share_to(second, rise_to(1u, above, pixel.surface), casts));
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

// What one of two points sees of the whole light, where its map has `stored` and `found`.
fn share_of_end(pixel: Pixel, point: MapPoint, stored: f32, found: f32, rise: Rise) -> f32 {
    let offset = offset_to(vec2i(point.texel), point);
    let share = share_to(select(found, NONE, shows_another(point, offset, stored)), rise, pixel.surface.casts);
    let seen = select(0.0, share, is_lit(point, offset, stored));
    return select(seen, 0.5 * settled_share(pixel, point), is_settled(pixel, point));
}

// A light with two points, both at once.
@fragment
fn both_ends(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = pixel_at(at.xy);
    let first = point_by_matrix(pixel, 0u);
    let rise = rise_to(0u, height_over(pixel), pixel.surface);
    let here = map_point(pixel, first, layer_of_pixel(pixel, first).layer);
    let texel = vec2i(here.texel);
    let found = textureLoad(shares, texel, here.layer, 0).x;
    let seen = share_of_end(pixel, here, load_depth(texel, here.layer), found, rise);
    // The other one's way to the receiver, and the receiver's place in its maps.
    let way = (map.from_light * pixel.place).xyz - pixel.w * lookup.neighbours[0].xyz;
    let layer = layer_of(way);
    let there = map_point(pixel, first, FIRST_OF_OTHER + layer);
    let other_texel = vec2i(there.texel);
    let stored = depth_of(textureLoad(other_depth, other_texel, layer, 0), map.farthest);
    let other_found = textureLoad(other_shares, other_texel, layer, 0).x;
    let other_rise = Rise(rise.above - rise.below, -rise.below);
    return min(seen + share_of_end(pixel, there, stored, other_found, other_rise), 1.0);
}

// A light that is one point.
fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    return shares_at(point, pixel).x;
}
