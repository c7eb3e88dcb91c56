// Pictures of volumes. After `extrude.wgsl`.

// Each end of a silhouette edge, as lines: of the six corners of a side only the first two are apart.
@vertex
fn listed_edge(@builtin(vertex_index) vertex: u32) -> Corner {
    let corner = vertex % 6u;
    return side_corner(list[vertex / 6u], select(1u, 0u, corner == 0u));
}

@vertex
fn any_edge(@builtin(vertex_index) vertex: u32) -> Corner {
    let entry = side_at(vertex / 6u, 0u);
    if entry == NO_ENTRY {
        return NOWHERE;
    }
    return side_corner(entry, select(1u, 0u, vertex % 6u == 0u));
}

// Fronts orange, backs blue; seen through, so that many of them are bright (GG 9.4).
@fragment
fn tint(@builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return vec4f(select(vec3f(0.015, 0.05, 0.12), vec3f(0.12, 0.05, 0.012), is_front), 0.0);
}

@fragment
fn one() -> @location(0) f32 {
    return 1.0;
}

@fragment
fn line() -> @location(0) vec4f {
    return vec4f(1.0, 0.75, 0.1, 1.0);
}
