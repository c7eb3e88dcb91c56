// Adds what one loop, or one caster, covers to what all do.

@group(0) @binding(0) var sums: texture_2d<f32>;
// Of each slot two, see `Wedge::weights`.
@group(0) @binding(1) var<storage, read> eye_count: array<vec2u>;

struct Apart {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) slot: u32,
}

// The screen; an instance is a slot of `eye_count`.
@vertex
fn screen(@builtin(vertex_index) vertex: u32, @builtin(instance_index) slot: u32) -> Apart {
    let corner = vec2f(vec2u((vertex << 1u) & 2u, vertex & 2u)) * 2.0 - 1.0;
    return Apart(vec4f(corner, 0.5, 1.0), slot);
}

// A convex loop: where its wedges reach, the point is in the hard shadow if none of them has it
// outside (PX 4.4); elsewhere the sides of the volume say so.
@fragment
fn add_loop(in: Apart) -> @location(0) vec2f {
    let v = textureLoad(sums, vec2i(in.position.xy), 0);
    let counted = v.y + f32(eye_count[in.slot].x);
    let hard = select(counted, f32(v.z == 0.0), v.w > 0.0);
    return vec2f(v.x + hard);
}

// A caster, which counts no more than all of the light.
@fragment
fn most_of_casters(in: Apart) -> @location(0) vec2f {
    let sides = textureLoad(sums, vec2i(in.position.xy), 0).xy + vec2f(eye_count[in.slot]);
    return vec2f(clamp(max(sides.x, sides.y), 0.0, 1.0));
}
