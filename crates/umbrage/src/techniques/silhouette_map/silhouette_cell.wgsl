// needs: map_visibility, silhouette_key
// A map of depths whose texels are moved to where silhouettes are (Sen, Cammarano and
// Hanrahan 2003).

@group(2) @binding(0) var silhouettes: texture_depth_2d_array;
@group(2) @binding(1) var plain: sampler;

// A cell between four depths: which one, and where in it the receiver is.
struct Cell {
    number: vec2i,
    place: vec2f,
}

// Corners of a cell: left and right above, left and right below.
const CORNERS: array<vec2f, 4> = array(vec2f(0.0, 0.0), vec2f(1.0, 0.0), vec2f(0.0, 1.0), vec2f(1.0, 1.0));

fn cell_of(point: MapPoint) -> Cell {
    let number = floor(point.texel - 0.5);
    return Cell(vec2i(number), point.texel - 0.5 - number);
}

// How far the receiver is lit by what each corner of the cell holds, its plane continued to there.
fn margins_at_corners(point: MapPoint, cell: Cell) -> vec4f {
    let middle = vec2f(cell.number + 1) / map.size;
    let gathered = textureGather(map_depth, plain, middle, point.layer);
    let corners = CORNERS;
    return vec4f(
        lit_margin(point, corners[0] - cell.place, depth_of(gathered.w, map.farthest), 0.0),
        lit_margin(point, corners[1] - cell.place, depth_of(gathered.z, map.farthest), 0.0),
        lit_margin(point, corners[2] - cell.place, depth_of(gathered.x, map.farthest), 0.0),
        lit_margin(point, corners[3] - cell.place, depth_of(gathered.y, map.farthest), 0.0),
    );
}

fn lit_at_corners(point: MapPoint, cell: Cell) -> vec4<bool> {
    return margins_at_corners(point, cell) >= vec4f(0.0);
}

// What rises no more than this above the receiver's plane, in texels, and hides it where no
// silhouette is, is a ledge whose sides all face the light. Alpha masks have outlines without
// silhouettes.
const LEDGE: f32 = 2.0;

// What the map of silhouettes has for a cell, nothing beyond its borders.
fn key_at(number: vec2i, layer: u32) -> f32 {
    let is_within = all(number >= vec2i(0)) && all(number < vec2i(i32(map.size)));
    let key = textureLoad(silhouettes, clamp(number, vec2i(0), vec2i(i32(map.size) - 1)), layer, 0);
    return select(0.0, key, is_within);
}

fn has_point(number: vec2i, layer: u32) -> bool {
    return key_at(number, layer) != 0.0;
}

// The point of a cell beside, in this cell's own places.
fn point_beside(cell: Cell, layer: u32, step: vec2i) -> vec2f {
    return place_of(key_at(cell.number + step, layer)) + vec2f(step);
}

fn across(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// The corner that a receiver goes by, and whether its cell has a point of its own.
struct Part {
    corner: vec4<bool>,
    has_point: bool,
}

// The corner whose part of the cell the receiver is in. Lines from the cell's own point to those of
// its neighbours are what parts are divided by. Each part is two triangles: of the point, a
// neighbour's point and the corner. A loop goes to the point, then around it from the left, since
// drivers that mask branches do leave a loop, after one round: where all is decided it is one of a
// cell that is always the same, whose point is in the caches.
fn part_of(at: Cell, layer: u32, is_open: bool) -> Part {
    let cell = Cell(select(vec2i(0), at.number, is_open), at.place);
    var own = vec2f(0.0);
    var has_point = false;
    var step = vec2i(0);
    var corner = -1.0;
    var parts = vec4<bool>(false);
    // The first neighbour ends the last part.
    let points = select(1u, 6u, is_open);
    for (var i = 0u; i < points; i++) {
        let key = key_at(cell.number + step, layer);
        let place = place_of(key) + vec2f(step);
        has_point = select(has_point, key != 0.0, i == 0u);
        own = select(own, place, i == 0u);
        let way = cell.place - own;
        let beside = across(place - own, way);
        parts.w |= corner >= 0.0 && beside < 0.0;
        let next = select(vec2i(-step.y, step.x), vec2i(-1, 0), i == 0u);
        corner = select(across(0.5 + 0.5 * vec2f(step + next) - own, way), -1.0, i == 0u);
        let begins = i > 0u && i < 5u;
        parts = select(parts, vec4<bool>(parts.yzw, beside >= 0.0 && corner < 0.0), begins);
        step = next;
    }
    return Part(parts.xywz, has_point);
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let cell = cell_of(point);
    let margins = margins_at_corners(point, cell);
    let lit = margins >= vec4f(0.0);
    let is_open = any(lit) && !all(lit);
    let part = part_of(cell, point.layer, is_open);
    // Where no silhouette is, what hides the receiver a little belongs to its own surface.
    let ledge = map.bias * map.outlined * LEDGE * texel_depth(point) * abs(point.across);
    let is_ledge = !part.has_point && all(margins >= vec4f(-ledge));
    return select(0.0, 1.0, select(lit.x, any(lit & part.corner) || is_ledge, is_open));
}
