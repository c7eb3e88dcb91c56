// needs: map_picture, silhouette_cell
// Pictures of the silhouette map over the scene.

const POINTS: u32 = 0u;
const PIXELS: u32 = 1u;
const PARTS: u32 = 2u;

// Width of lines in cells, and of the points that they join.
const LINE: f32 = 0.03;
const DOT: f32 = 0.09;

fn distance_to(p: vec2f, a: vec2f, b: vec2f) -> f32 {
    let way = b - a;
    let along = saturate(dot(p - a, way) / max(dot(way, way), 1e-12));
    return distance(p, a + along * way);
}

// Borders of cells, points of silhouettes in orange and, between points of neighbours, the lines
// that part cells.
fn points(point: MapPoint, under: vec3f) -> vec3f {
    let cell = cell_of(point);
    let own = point_beside(cell, point.layer, vec2i(0));
    let from_border = min(cell.place, 1.0 - cell.place);
    var color = mix(under, vec3f(0.12, 0.2, 0.3), select(0.0, 0.6, min(from_border.x, from_border.y) < LINE));
    if !has_point(cell.number, point.layer) {
        return color;
    }
    let steps = array(vec2i(-1, 0), vec2i(0, -1), vec2i(1, 0), vec2i(0, 1));
    for (var i = 0; i < 4; i++) {
        let beside = point_beside(cell, point.layer, steps[i]);
        let is_line = has_point(cell.number + steps[i], point.layer) && distance_to(cell.place, own, beside) < LINE;
        color = select(color, vec3f(0.95, 0.55, 0.1), is_line);
    }
    return select(color, vec3f(1.0, 0.95, 0.7), distance(cell.place, own) < DOT);
}

// Red, green, blue and yellow: which corner of its cell a silhouette pixel goes by.
fn part(point: MapPoint, under: vec3f) -> vec3f {
    let mine = part_of(cell_of(point), point.layer, true).corner;
    let above = select(vec3f(0.8, 0.15, 0.1), vec3f(0.15, 0.6, 0.2), mine.y);
    let below = select(vec3f(0.15, 0.3, 0.85), vec3f(0.85, 0.75, 0.15), mine.w);
    return under + select(above, below, mine.z || mine.w);
}

fn picture(point: MapPoint, pixel: Pixel, at: vec4f) -> vec3f {
    let under = grey(map.eye, at);
    if PICTURE == POINTS {
        return points(point, under);
    }
    let lit = lit_at_corners(point, cell_of(point));
    let is_silhouette = any(lit) && !all(lit) && !point.is_own_shadow;
    if PICTURE == PIXELS {
        return select(under * select(1.0, 2.5, lit.x && !point.is_own_shadow), vec3f(0.1, 0.9, 0.2), is_silhouette);
    }
    return select(under, part(point, under), is_silhouette);
}
