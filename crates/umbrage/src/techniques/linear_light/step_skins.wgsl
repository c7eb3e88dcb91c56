// needs: step_list, skin
// Skins from steps in the other point's map.

struct Steps {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
    found: u32,
    pad: vec2u,
    entries: array<vec2u>,
}

@group(0) @binding(0) var<storage, read> steps: Steps;
@group(0) @binding(1) var other_map: texture_depth_2d_array;
@group(0) @binding(2) var<uniform> other: LightPoint;

// Skins end far away where the map shows nothing behind the blocker: a receiver that ends there may
// be seen from elsewhere.
override ENDLESS: bool = true;
const FAR: f32 = 1000.0;

fn ray(layer: u32, texel: vec2f) -> vec3f {
    return other.views[layer].light_from_texel * vec3f(texel, 1.0);
}

// The middle between both ends of a cell's side.
fn middle_of(cell: vec2u, side: u32) -> vec2f {
    return 0.5 * vec2f(corner_of(cell, side) + corner_of(cell, side + 1u)) + 0.5;
}

fn depth_of(layer: u32, texel: vec2u) -> f32 {
    return textureLoad(other_map, texel, layer, 0);
}

// Corners 0 and 3 are at the blocker, 1 and 2 at its shadow; 0 and 1 where the border goes down.
@vertex
fn step_skin(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Skin {
    let at = group * GROUP + vertex / 4u;
    if at >= min(steps.found, arrayLength(&steps.entries)) {
        return NO_SKIN;
    }
    let entry = steps.entries[at];
    let cell = vec2u(entry.x & 0xffffu, entry.x >> 16u);
    let layer = entry.y & 15u;
    let down = (entry.y >> 4u) & 3u;
    let up = (entry.y >> 6u) & 3u;
    // Blockers and receivers at both sides.
    let near = array(corner_of(cell, down), corner_of(cell, up + 1u));
    let far = array(corner_of(cell, down + 1u), corner_of(cell, up));
    let starts = ray(layer, middle_of(cell, down));
    let ends = ray(layer, middle_of(cell, up));
    // The plane through the border, turned away from the blocker. Rays from this point enter the
    // other one's shadow only where this point is in front of the plane.
    let normal = cross(starts, ends);
    let outward = ray(layer, vec2f(far[0])) - ray(layer, vec2f(near[0]));
    if dot(normal, outward) * dot(normal, into.to_other) >= 0.0 {
        return NO_SKIN;
    }
    let corner = vertex & 3u;
    let is_up = corner >= 2u;
    let distances = other.views[layer].near / vec2f(depth_of(layer, near[0]), depth_of(layer, near[1]));
    let distance = select(distances.x, distances.y, is_up);
    let near_ray = ray(layer, vec2f(select(near[0], near[1], is_up)) + 0.5);
    let far_texel = select(far[0], far[1], is_up);
    let far_depth = depth_of(layer, far_texel);
    if far_depth == 0.0 && !ENDLESS {
        return NO_SKIN;
    }
    let behind = select(other.views[layer].near / max(far_depth, LEAST), FAR * distance, far_depth == 0.0);
    return skin_corner(
        skin_clip(into.to_other + near_ray * distance),
        skin_clip(into.to_other + ray(layer, vec2f(far_texel) + 0.5) * behind),
        corner == 1u || corner == 2u,
        into.to_other + starts * distances.x,
        into.to_other + ends * distances.y,
    );
}
