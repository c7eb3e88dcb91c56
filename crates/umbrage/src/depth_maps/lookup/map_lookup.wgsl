// needs: map_layers
// Where a receiver lies in the maps of a light, and how the depth there slopes: the one place that
// bias comes from.

// A receiver: what a pixel shows, or whatever a shader of a host's asks about.
struct Pixel {
    // The pixel, whose taps differ from those of its neighbours.
    at: vec2f,
    is_drawn: bool,
    // Homogeneous, in the space that the light's matrices start from: the camera's normalised
    // device coordinates, or relative to the eye.
    place: vec4f,
    // The last coordinate of the place relative to the eye, homogeneous.
    w: f32,
    surface: Surface,
    // Metres that the place may be off in each coordinate, and metres times the length of the
    // normal that it may be off its surface.
    rounding: f32,
    off: f32,
}

// Interleaved gradient noise (Jimenez 2014), 0 to 1.
fn gradient_noise(at: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(at, vec2f(0.06711056, 0.00583715))));
}

struct MapPoint {
    // Texels; whole numbers are corners.
    texel: vec2f,
    // near / distance, or what is left of a parallel view: the depth that projective maps would
    // store there.
    depth: f32,
    // Change of depth per texel along the receiver's plane: `along` over `across`, kept apart to
    // spare a division.
    along: vec2f,
    across: f32,
    // Of a paraboloid: what bends that, see `plane_step`.
    bend: f32,
    // It faces away from the light and casts shadows itself: nothing has to be looked up.
    is_own_shadow: bool,
    // How much the depth may be off by rounding, and because the rasteriser of the receiver shifted
    // its surface; the latter times the size of `across`, to spare a division, too.
    rounding: f32,
    shifted: f32,
    // One over the homogeneous texel's last coordinate, the distance along the axis of a
    // perspective view; else 1.
    inverse_w: f32,
    layer: u32,
    is_covered: bool,
}

// Texels that the neighbouring surface at a crease may slope against the receiver's plane.
const CREASE: f32 = 0.5;
// How steeply a surface may rise above the receiver's plane within a wide filter: a tangent.
const BEND: f32 = 0.25;

// Share of a steady map's width over which it is blended with the next one.
const STEADY_FADE: f32 = 0.025;

// How far from the light a receiver's plane may be continued to, over its own distance: beside the
// light a filter meets its horizon, where there is no more of it.
const BEYOND: f32 = 2.0;

// Widest filter of a radius in metres.
const MOST_TEXELS: f32 = 64.0;

// Away from the axis, depth along it forgives more than depth along the ray: three times as much in
// the corners of a cube's face. Paraboloids forgive that everywhere.
const BENT: f32 = 3.0;

// A plane as the map sees it: `along` and `bend` over `across` are the change of its depth around
// the receiver.
struct MapPlane {
    along: vec2f,
    across: f32,
    bend: f32,
}

// Through a point whose texel and depth are known.
//
// On a plane with normal n depth is linear in the texel, in perspective too, since it is near /
// distance there. With m = (n · right, n · down, n · axis) the plane is m₀ u + m₁ v + m₂ = c · near
// / depth in perspective, so that its slope is depth · (m₀, m₁) / (m₀ u + m₁ v + m₂); for parallel
// light it is (m₀, m₁) / m₂.
//
// In a warped view w is another linear function of the texel times w, with the change a. Then the
// slope is (m₀, m₁) / m₂ − a s, with s the depth that the plane has at texel 0, (depth − (m₀ u + m₁
// v) / m₂) / (1 − a₀ u − a₁ v).
//
// A place q in a paraboloid's plane is the unit way (2q, 1 − q²) / (1 + q²), and depth is
// proportional to n times that.
fn plane_through(point: MapPoint, normal: vec3f) -> MapPlane {
    let layer = point.layer;
    let m = vec2f(dot(normal, map.layers[layer].slope_right), dot(normal, map.layers[layer].slope_down));
    var plane = MapPlane(m, dot(normal, map.layers[layer].slope_axis), 0.0);
    if LAYOUT == PARABOLOIDS {
        let q = plane_place(point);
        let inverse = 1.0 / (1.0 + dot(q, q));
        let ahead = plane.across;
        plane.across = -(2.0 * dot(m, q) + ahead * (1.0 - dot(q, q))) * inverse;
        let scale = point.depth * inverse;
        plane.bend = scale * (ahead - plane.across);
        plane.along = -2.0 * (scale * m - plane.bend * q) * map.layers[layer].axis.zw;
    } else if PERSPECTIVE {
        plane.across += dot(m, point.texel);
        plane.along *= point.depth;
    } else if WARPED {
        let warp = map.layers[layer].axis.xy;
        let first = (point.depth * plane.across - dot(m, point.texel)) / (1.0 - dot(warp, point.texel));
        plane.along -= warp * first;
    }
    return plane;
}

// Where a receiver is in the paraboloid's plane.
fn plane_place(point: MapPoint) -> vec2f {
    let axis = map.layers[point.layer].axis;
    return (point.texel - axis.xy) * axis.zw;
}

// Change of a plane's depth `offset` texels away, times its `across`.
fn plane_step(point: MapPoint, along: vec2f, bend: f32, offset: vec2f) -> f32 {
    let step = dot(along, offset);
    if LAYOUT == PARABOLOIDS {
        let q = plane_place(point);
        let way = offset * map.layers[point.layer].axis.zw;
        let square = dot(way, way);
        return (step + bend * square) / (1.0 + (2.0 * dot(q, way) + square) / (1.0 + dot(q, q)));
    }
    return step;
}

// How a small way of the receiver's moves its homogeneous texel; `unit` is the unit way to it from
// the light.
fn texel_change(layer: u32, way: vec3f, unit: vec3f) -> vec3f {
    let change = vec3f(
        dot(map.layers[layer].texel_right, way),
        dot(map.layers[layer].texel_down, way),
        dot(map.layers[layer].texel_w, way),
    );
    if LAYOUT == PARABOLOIDS {
        return change + vec3f(map.layers[layer].axis.xy, 1.0) * dot(unit, way);
    }
    return change;
}

// The last coordinate of the homogeneous texel of a place that `map_from_place` gave.
fn texel_w(place: vec4f) -> f32 {
    return place.w + select(0.0, length(place.xyw), LAYOUT == PARABOLOIDS);
}

// Change of the homogeneous texel along with a change of that place.
fn texel_step(layer: u32, place: vec4f, change: vec4f) -> vec3f {
    if LAYOUT == PARABOLOIDS {
        let axis = map.layers[layer].axis;
        let w = change.w + dot(normalize(place.xyw), change.xyw);
        return vec3f(change.xy / axis.zw + axis.xy * w, w);
    }
    return change.xyw;
}

// The split of a place. A steady map covers a sphere around its split, so it is used beyond the
// split's end for as long as it covers what is there, and is blended with the next one towards its
// own border.
fn split_of(pixel: Pixel, first: MapPoint) -> Split {
    var split = split_at(dot(map.view_distance, pixel.place) / pixel.w);
    if STEADY {
        let layer = min(split.layer, MOST_LAYERS - 1u);
        let finer = max(layer, 1u) - 1u;
        let share = steady_share(first, finer);
        let next = split.next * (1.0 - steady_share(first, layer));
        let goes_on = finer < layer && share > 0.0;
        split.layer = select(split.layer, finer, goes_on);
        split.next = select(next, 1.0 - share, goes_on);
    }
    return split;
}

// The texel of a steady split.
fn steady_texel(first: MapPoint, layer: u32) -> vec2f {
    let from_first = map.layers[layer].from_first;
    return first.texel * from_first.x + from_first.zw;
}

// Share of a place that a steady split's map has: all within its borders, and where splits are
// mixed none at them.
fn steady_share(first: MapPoint, layer: u32) -> f32 {
    let texel = steady_texel(first, layer);
    let inside = min(texel, map.size - texel) - map.layers[layer].border;
    let room = min(inside.x, inside.y);
    let share = select(select(0.0, 1.0, room >= 0.0), saturate(room / (STEADY_FADE * map.size)), BLEND != 0u);
    return select(0.0, share, first.is_covered);
}

// The side of a post-perspective cube that covers a pixel, the one with most room around it.
fn side_of(pixel: Pixel) -> u32 {
    var most = -1.0;
    var side = 0u;
    for (var i = 0u; i < 6u; i++) {
        let p = map.layers[i].map_from_place * pixel.place;
        let texel = p.xy / p.w;
        let inside = min(texel, map.size - texel);
        let room = select(-1.0, min(inside.x, inside.y), p.w * pixel.w > 0.0);
        side = select(side, i, room > most);
        most = max(most, room);
    }
    return side;
}

// The layer of a pixel. `first` is its place by layer 0's matrix: that in the maps of splits that
// stand still differs by scale and offset alone.
fn layer_of_pixel(pixel: Pixel, first: MapPoint) -> Split {
    if LAYOUT == SPLITS {
        var split = split_of(pixel, first);
        if BLEND == DITHER {
            split.layer += select(0u, 1u, split.next > gradient_noise(pixel.at));
        }
        split.next = select(0.0, split.next, BLEND == LERP);
        return split;
    }
    if LAYOUT == SINGLE {
        return Split(0u, 0.0, true);
    }
    if LAYOUT == SIDES {
        return Split(side_of(pixel), 0.0, true);
    }
    return Split(layer_of((map.from_light * pixel.place).xyz), 0.0, true);
}

// For the surface that a pixel shows.
fn map_point(pixel: Pixel, first: MapPoint, layer: u32) -> MapPoint {
    var point = first;
    if STEADY {
        point.layer = layer;
        point.texel = steady_texel(first, layer);
        point.along = first.along * map.layers[layer].from_first.y;
    } else {
        point = point_by_matrix(pixel, layer);
    }
    if CLASSIC {
        offset_by_hand(&point);
    }
    point.is_covered &= all(point.texel >= vec2f(0.0)) && all(point.texel < vec2f(map.size));
    return point;
}

// By a layer's own matrix; covered by all that is in front of the light.
fn point_by_matrix(pixel: Pixel, layer: u32) -> MapPoint {
    let surface = pixel.surface;
    var point: MapPoint;
    point.layer = layer;
    let p = map.layers[point.layer].map_from_place * pixel.place;
    // Parallel light leaves the camera's w as it is.
    var inverse_w = 1.0 / pixel.w;
    if LAYOUT == PARABOLOIDS {
        let axis = map.layers[point.layer].axis;
        inverse_w = 1.0 / texel_w(p);
        point.texel = axis.xy + p.xy * inverse_w / axis.zw;
        point.depth = p.z / length(p.xyw);
    } else {
        if PERSPECTIVE || WARPED {
            inverse_w = 1.0 / p.w;
        }
        point.texel = p.xy * inverse_w;
        point.depth = p.z * inverse_w;
    }
    var is_in_front = true;
    point.inverse_w = 1.0;
    if PERSPECTIVE || WARPED {
        point.inverse_w = inverse_w * pixel.w;
        is_in_front = point.inverse_w > 0.0;
    }
    let plane = plane_through(point, surface.normal);
    point.along = plane.along;
    point.across = plane.across;
    point.bend = plane.bend;
    point.is_covered = is_in_front;
    // Positive where the surface faces the light; 0 where there is no normal or no view.
    point.is_own_shadow = surface.casts && is_in_front && point.across < 0.0;
    point.rounding = depth_rounding(point, pixel.rounding + map.caster_rounding);
    // A surface seen edge-on is all off.
    point.shifted = min(pixel.off * depth_per_metre(point), abs(point.across));
    return point;
}

// The receiver counts as perpendicular to the light, which is all that one depth says, and what is
// forgiven are the offsets.
fn offset_by_hand(point: ptr<function, MapPoint>) {
    let slope = map_slope(*point);
    let z = (*point).depth;
    let per_metre = map.layers[(*point).layer].per_metre * select(1.0, z * z, PERSPECTIVE);
    let constant = map.offsets.x * per_metre * select(1.0, abs((*point).inverse_w), WARPED);
    (*point).rounding = constant + map.offsets.y * (abs(slope.x) + abs(slope.y));
    (*point).shifted = 0.0;
    (*point).along = vec2f(0.0);
    (*point).across = 1.0;
    (*point).bend = 0.0;
}

// Change of depth per metre along the light.
fn depth_per_metre(point: MapPoint) -> f32 {
    let per_metre = map.layers[point.layer].per_metre * select(1.0, point.depth * point.depth, PERSPECTIVE);
    return per_metre * select(1.0, abs(point.inverse_w), WARPED);
}

// How much depth may be off where positions are by `metres`, in each coordinate that the map's
// matrix gives.
fn depth_rounding(point: MapPoint, metres: f32) -> f32 {
    let z = abs(point.depth);
    var in_each = depth_per_metre(point);
    if WARPED {
        in_each += z * length(map.layers[point.layer].texel_w) * abs(point.inverse_w);
    }
    return map.rounding.x * z + map.rounding.y + metres * in_each;
}

// Change of depth per texel. A plane seen edge-on has no slope to speak of; the largest that helps
// spans all depth.
fn map_slope(point: MapPoint) -> vec2f {
    let slope = clamp(point.along / point.across, vec2f(-1.0), vec2f(1.0));
    return select(slope, vec2f(0.0), point.across == 0.0);
}

// A change of depth, no lower than where the plane is not to be continued.
fn before_horizon(change: f32, depth: f32) -> f32 {
    return select(change, max(change, (1.0 / BEYOND - 1.0) * depth), PERSPECTIVE);
}

// Depth of the receiver's plane `offset` texels away, by its slope.
fn depth_along(point: MapPoint, slope: vec2f, offset: vec2f) -> f32 {
    if LAYOUT == PARABOLOIDS {
        let bend = select(point.bend / point.across, 0.0, point.across == 0.0);
        return point.depth + before_horizon(plane_step(point, slope, bend, offset), point.depth);
    }
    return point.depth + before_horizon(dot(slope, offset), point.depth);
}

// What comparing has to forgive when the compared surface may be `texels` away from the receiver's
// own place.
fn map_bias(point: MapPoint, slope: vec2f, texels: f32) -> f32 {
    let shifted = point.shifted / max(abs(point.across), 1e-30);
    return map.bias * (texels * (abs(slope.x) + abs(slope.y)) + point.rounding + shifted);
}

// How deep a texel is wide.
fn texel_depth(point: MapPoint) -> f32 {
    let axis = map.layers[point.layer].axis;
    if WARPED {
        // Texels across and down as they change with the place, times w: what a texel spans, times
        // w over that, is at most this.
        let right = map.layers[point.layer].texel_right - point.texel.x * map.layers[point.layer].texel_w;
        let down = map.layers[point.layer].texel_down - point.texel.y * map.layers[point.layer].texel_w;
        return map.layers[point.layer].per_metre * sqrt(dot(right, right) + dot(down, down)) / length(cross(right, down));
    }
    let wide = max(axis.z, axis.w) * select(map.layers[point.layer].per_metre, point.depth, PERSPECTIVE);
    if LAYOUT == PARABOLOIDS {
        let q = plane_place(point);
        return BENT * 2.0 * wide / (1.0 + dot(q, q));
    }
    return wide;
}

// Radius of a filter: so many texels, or as many as `softness` is at the receiver. Less than half a
// texel is no filter, and more than MOST_TEXELS are not looked at.
fn filter_radius(point: MapPoint, texels: f32) -> f32 {
    let axis = map.layers[point.layer].axis;
    let distance = select(1.0, 1.0 / (map.layers[point.layer].per_metre * max(point.depth, 1e-30)), PERSPECTIVE);
    let soft = clamp(map.softness / (max(axis.z, axis.w) * distance), 0.5, MOST_TEXELS);
    return select(texels, soft, map.softness > 0.0);
}

// What comparing `texels` away from the receiver has to forgive besides, since curved surfaces bend
// away from its plane.
fn map_bend(point: MapPoint, texels: f32) -> f32 {
    return select(map.bias, 0.0, CLASSIC) * BEND * texels * texel_depth(point);
}

// How far a receiver is lit by the depth `stored` that lies `offset` texels away from it, shadowed
// where that is negative: its plane, continued to there, is compared with forgiveness for a crease
// between and for `bend`. All is multiplied by |across|, so that nothing is divided and a plane
// seen edge-on counts as lit.
fn lit_margin(point: MapPoint, offset: vec2f, stored: f32, bend: f32) -> f32 {
    let step = plane_step(point, point.along, point.bend, offset) * sign(point.across);
    let toward = before_horizon(step, point.depth * abs(point.across));
    let crease = map.bias * (CREASE * (abs(point.along.x) + abs(point.along.y)) + point.shifted);
    return (point.depth + map.bias * point.rounding + bend - stored) * abs(point.across) + toward + crease;
}

fn is_lit_beyond(point: MapPoint, offset: vec2f, stored: f32, bend: f32) -> bool {
    return lit_margin(point, offset, stored, bend) >= 0.0;
}

fn is_lit(point: MapPoint, offset: vec2f, stored: f32) -> bool {
    return is_lit_beyond(point, offset, stored, 0.0);
}
