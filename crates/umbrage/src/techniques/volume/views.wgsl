// needs: extrude
// Pictures of volumes.

// Half the width of a line, in normalised device coordinates.
override LINE_X: f32 = 0.001;
override LINE_Y: f32 = 0.001;

// The edge of a side as a thin quad.
fn edge_corner(entry: u32, corner: u32) -> Corner {
    let a = side_corner(entry, 1u).position;
    let b = side_corner(entry, 0u).position;
    let is_start = corner == 1u || corner == 2u;
    var p = select(b, a, is_start);
    // Ends behind the eye have no direction on the screen; any will do.
    let along = (b.xy * a.w - a.xy * b.w) / vec2f(LINE_X, LINE_Y);
    let across = vec2f(-along.y, along.x) / max(length(along), 1e-20);
    p = vec4f(p.xy + across * vec2f(LINE_X, LINE_Y) * select(-p.w, p.w, corner >= 2u), p.zw);
    return Corner(p, 1.0);
}

@vertex
fn listed_edge(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Corner {
    let entry = listed(vertex, group, 4u);
    if entry == NO_ENTRY {
        return NOWHERE;
    }
    return edge_corner(entry, vertex % 4u);
}

@vertex
fn any_edge(@builtin(vertex_index) vertex: u32, @builtin(instance_index) chunk: u32) -> Corner {
    let entry = side_at(chunk * CHUNK + (vertex % PART) / 4u, vertex / PART);
    if entry == NO_ENTRY {
        return NOWHERE;
    }
    return edge_corner(entry, vertex % 4u);
}

// Fronts in the first channel, backs in the second (GG 9.4).
@fragment
fn tint(@builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return select(vec4f(0.0, 1.0, 0.0, 0.0), vec4f(1.0, 0.0, 0.0, 0.0), is_front);
}

@fragment
fn one() -> @location(0) vec4f {
    return vec4f(1.0, 0.0, 0.0, 0.0);
}

@fragment
fn line() -> @location(0) vec4f {
    return vec4f(1.0, 0.75, 0.1, 1.0);
}
