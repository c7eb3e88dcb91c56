// needs: map_depth
// Renders casters into a paraboloid map (Brabec, Annen and Seidel 2002).
//
// A way d from the light, z ahead, stands at d.xy / (|d| + d.z) in the paraboloid's plane. Only
// corners of triangles are put there; edges between them are straight where they should be arcs of
// circles. Depth is exact nevertheless: each fragment meets its triangle's plane along the ray of
// its own texel.

struct Bent {
    @invariant @builtin(position) position: vec4f,
    @location(0) uv: vec3f,
    @location(1) @interpolate(flat) material: u32,
    // From the light: right, up, ahead.
    @location(2) way: vec3f,
}

// How far from a texel's ray may be what the rasteriser found there, in distances. Triangles that
// reach around to the back of the light turn inside out; what they would smear over the map is left
// out.
const LONGEST_LEAP: f32 = 1.0;
const PLANE_ROUNDING: f32 = 1e-6;

fn bent(way: vec3f, uv: vec3f, material: u32) -> Bent {
    let distance = length(way);
    let w = max(distance + way.z, 1e-6 * distance);
    let plane = map_view.clip_from_plane;
    return Bent(vec4f(way.xy * plane.xy + plane.zw * w, 0.5 * w, w), uv, material, way);
}

@vertex
fn opaque_bent(@location(0) position: vec3f, @location(1) instance: u32) -> Bent {
    return bent(map_position(instance, position).xyw, vec3f(0.0), 0u);
}

@vertex
fn masked_bent(@location(0) position: vec3f, @location(1) instance: u32, @location(3) uv: vec3f) -> Bent {
    return bent(map_position(instance, position).xyw, with_opacity(uv), instances[instance].material);
}

@vertex
fn opaque_bent_many(@location(0) position: vec3f, @location(1) instance: u32, many: Many) -> Bent {
    return bent(map_position(instance, placed_by(many, position)).xyw, vec3f(0.0), 0u);
}

@vertex
fn masked_bent_many(
    @location(0) position: vec3f,
    @location(1) instance: u32,
    @location(3) uv: vec3f,
    many: Many,
) -> Bent {
    let at = map_position(instance, placed_by(many, position));
    return bent(at.xyw, with_opacity(uv), instances[instance].material);
}

// near / distance; 0 where there is nothing to be drawn.
fn bent_depth(in: Bent) -> f32 {
    let plane = in.position.xy * map_view.plane_from_texel.xy + map_view.plane_from_texel.zw;
    let square = dot(plane, plane);
    let ray = vec3f(2.0 * plane, 1.0 - square) / (1.0 + square);
    let across = dpdx(in.way);
    let down = dpdy(in.way);
    let normal = cross(across, down);
    let facing = dot(normal, ray);
    let share = facing / dot(normal, in.way);
    let distance = length(in.way);
    let leap = length(ray * distance - in.way);
    if !(share > 0.0) || leap > LONGEST_LEAP * distance {
        return 0.0;
    }
    // The plane is known from one pixel to the next; what is rounded there grows with the way to
    // the ray.
    let rounding = PLANE_ROUNDING * leap * max(length(across), length(down)) / abs(facing);
    return map_view.near * share * (1.0 - min(rounding, 0.01));
}

@fragment
fn written_bent(in: Bent) -> @builtin(frag_depth) f32 {
    let depth = bent_depth(in);
    if depth == 0.0 || depth > 1.0 {
        discard;
    }
    return stored_of(depth, map_view.farthest);
}

@fragment
fn written_bent_cut_out(in: Bent) -> @builtin(frag_depth) f32 {
    let depth = bent_depth(in);
    if depth == 0.0 || depth > 1.0 || is_cut_out(in.material, base_color(in.material, in.uv).a) {
        discard;
    }
    return stored_of(depth, map_view.farthest);
}
