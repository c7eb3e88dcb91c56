// needs: map_edges, skin
// Skins from the edges of casters that bound the other point's shadows.

// How many times as far from the other point as its edge a skin ends that leaves the receivers
// nowhere.
const FAR: f32 = 1000.0;

// Where a skin ends, as a multiple of the way from the other point to its edge: at a side of the
// box around all receivers that both ends leave it by. All within the box is on this side of it.
fn end_of(start: vec3f, end: vec3f) -> f32 {
    let lowest = point.lowest - into.to_other;
    let highest = point.highest - into.to_other;
    var times = FAR;
    for (var i = 0u; i < 3u; i++) {
        let wall = select(lowest[i], highest[i], start[i] > 0.0);
        let at = max(wall / start[i], wall / end[i]);
        times = select(times, min(times, at), start[i] * end[i] > 0.0);
    }
    return max(times, 1.0);
}

// Corners 1 and 2 are the edge's start, 0 and 3 its end; 0 and 1 are at the edge.
@vertex
fn edge_skin(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Skin {
    let edge = contour_edge(vertex, group);
    // Rays from this point enter the other one's shadow only where this point is in front of the
    // plane through the other one and the edge, turned away from the shadow.
    let outward = cross(way_of_light(edge.start), edge.end - edge.start);
    if !edge.is_there || dot(outward, into.to_other) >= 0.0 {
        return NO_SKIN;
    }
    let start = edge.start - point.position;
    let end = edge.end - point.position;
    let from_start = start - into.to_other;
    let from_end = end - into.to_other;
    let times = end_of(from_start, from_end);
    let is_end = is_at_end(vertex);
    return skin_corner(
        skin_clip(select(start, end, is_end)),
        skin_clip(into.to_other + times * select(from_start, from_end, is_end)),
        is_on_other_side(vertex),
        start,
        end,
    );
}
