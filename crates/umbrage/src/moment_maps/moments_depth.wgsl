// Linear depth of filterable maps: 0 at the nearest caster, 1 at the farthest receiver, so that
// moments have the precision where depths differ.

struct Moments {
    // Stored depth s to linear depth: (x + y s) / (z + w s).
    depth: vec4f,
    // Weights of the blur's taps: the middle, its neighbours, theirs.
    taps: vec3f,
    // Texels of the map across one of the finest level of moments.
    scale: f32,
    // Of the filter along each axis, in texels of the map, squared.
    variance: f32,
    // Texels across the finest level, how many levels there are, and views in all.
    side: u32,
    levels: u32,
    views: u32,
}

fn linear_depth(m: Moments, stored: f32) -> f32 {
    return clamp((m.depth.x + m.depth.y * stored) / max(m.depth.z + m.depth.w * stored, 1e-30), 0.0, 1.0);
}

// Change of linear depth with stored depth.
fn linear_depth_change(m: Moments, stored: f32) -> f32 {
    let below = max(m.depth.z + m.depth.w * stored, 1e-18);
    return (m.depth.y * m.depth.z - m.depth.x * m.depth.w) / (below * below);
}

// The other way round.
fn stored_depth(m: Moments, depth: f32) -> f32 {
    let below = m.depth.y - m.depth.w * depth;
    return (m.depth.z * depth - m.depth.x) / select(below, -1e-30, below == 0.0);
}
