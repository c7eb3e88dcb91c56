// needs: map_edges, silhouette_key
// Draws silhouette edges into the silhouette map: where each crosses a cell, a point of it.

@group(3) @binding(0) var depths: texture_depth_2d;
@group(3) @binding(1) var plain: sampler;

struct CellEdge {
    @builtin(position) position: vec4f,
    // Cells right and down; whole numbers are corners.
    @location(0) @interpolate(flat) start: vec2f,
    @location(1) @interpolate(flat) end: vec2f,
    @location(2) @interpolate(flat) depth: vec2f,
    // A unit vector across the edge, away from the shadow.
    @location(3) @interpolate(flat) outward: vec2f,
}

// Corners of triangles may be rounded to a sixteenth of a texel, by 1/32 in each coordinate, so
// that the map of depths has an edge up to 0.044 aside. Cells that the true edge misses by no more
// have a point of it, too, on their side.
const SNAPPED: f32 = 0.05;

@vertex
fn corner(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> CellEdge {
    let seen = layer_edge(contour_edge(vertex, group), 4.0);
    if !seen.is_seen {
        return CellEdge(OFF_LAYER, vec2f(0.0), vec2f(0.0), vec2f(0.0), vec2f(0.0));
    }
    // As far as the middles of cells can be that have a point of it, both along and across, and by
    // how much its own corners may be snapped.
    let around = (0.5 + SNAPPED) * (abs(seen.along.x) + abs(seen.along.y)) + SNAPPED;
    // The middle of a depth texel is a corner of four cells.
    let at = quad_corner(seen, vertex, around, around) - 0.5;
    return CellEdge(clip_of_texel(at, 0.5), seen.start - 0.5, seen.end - 0.5, seen.depth, seen.outward);
}

// A place on the edge: 0 its start, 1 its end; and whether that is in the cell.
struct Crossing {
    at: f32,
    is_inside: bool,
}

fn is_in_cell(p: vec2f) -> bool {
    return all(p >= vec2f(-SNAPPED)) && all(p <= vec2f(1.0 + SNAPPED));
}

// Where the edge meets the line on which what is given at its ends is 0.
fn crossing(a: vec2f, b: vec2f, at_a: f32, at_b: f32) -> Crossing {
    let at = at_a / (at_a - at_b);
    return Crossing(at, at >= 0.0 && at <= 1.0 && is_in_cell(mix(a, b, at)));
}

// An end where one is inside, so that neighbours store the same; else where it crosses a diagonal,
// or the middle of both. An edge that crosses none has nothing in the cell.
fn place_in_cell(a: vec2f, b: vec2f) -> Crossing {
    if is_in_cell(a) {
        return Crossing(0.0, true);
    }
    if is_in_cell(b) {
        return Crossing(1.0, true);
    }
    let down = crossing(a, b, a.x - a.y, b.x - b.y);
    let up = crossing(a, b, a.x + a.y - 1.0, b.x + b.y - 1.0);
    let first = select(up.at, down.at, down.is_inside);
    let second = select(down.at, up.at, up.is_inside);
    return Crossing(0.5 * (first + second), down.is_inside || up.is_inside);
}

// Depths at the corners of a cell: left and right above, left and right below.
fn depths_around(cell: vec2f) -> vec4f {
    let gathered = textureGather(depths, plain, (cell + 1.0) / map_view.size).wzxy;
    let farthest = map_view.farthest;
    return vec4f(
        depth_of(gathered.x, farthest),
        depth_of(gathered.y, farthest),
        depth_of(gathered.z, farthest),
        depth_of(gathered.w, farthest),
    );
}

fn nearest_of(v: vec4f) -> f32 {
    return max(max(v.x, v.y), max(v.z, v.w));
}

fn farthest_of(v: vec4f) -> f32 {
    return min(min(v.x, v.y), min(v.z, v.w));
}

// Behind all four depths at the cell's corners. Between them depth may be as much farther as they
// differ: a surface seen at an angle does not hide its own edges, nor one that stands on it.
fn is_hidden(around: vec4f, depth: f32) -> bool {
    let farthest = farthest_of(around);
    let rounding = map_view.same.x * farthest + map_view.same.y;
    return depth < farthest - (nearest_of(around) - farthest) - rounding;
}

// From 1 at the light to 0 at the farthest, linear in the distance.
fn nearness(depth: f32) -> f32 {
    return select(depth, 1.0 - map_view.farthest / max(depth, map_view.farthest), PERSPECTIVE);
}

// Of the points of several edges in a cell one stays, whichever was drawn first: that of the edge
// between the corners where depth steps most. Most receivers see light turn to shadow there. Where
// edges part the corners alike it is the outermost: the shadow is that of both.
@fragment
fn point_of_edge(in: CellEdge) -> @builtin(frag_depth) f32 {
    let cell = floor(in.position.xy);
    let a = in.start - cell;
    let b = in.end - cell;
    let place = place_in_cell(a, b);
    if !place.is_inside {
        discard;
    }
    let around = depths_around(cell);
    if is_hidden(around, mix(in.depth.x, in.depth.y, place.at)) {
        discard;
    }
    let outward = in.outward;
    let from_corners = vec4f(0.0, outward.x, outward.y, outward.x + outward.y) - dot(outward, a);
    let is_outside = from_corners > vec4f(0.0);
    let outside = nearest_of(select(vec4f(0.0), around, is_outside));
    let inside = farthest_of(select(around, vec4f(1.0), is_outside));
    let step = select(nearness(inside) - nearness(outside), 0.0, all(is_outside) || !any(is_outside));
    let from_middle = dot(outward, a - 0.5);
    return key_of(mix(a, b, place.at), step, from_middle);
}
