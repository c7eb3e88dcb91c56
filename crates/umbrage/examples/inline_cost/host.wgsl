// Positions relative to the eye, and the normals of triangles.

@group(0) @binding(0) var<uniform> clip_from_eye: mat4x4f;

struct Corner {
    @invariant @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
}

@vertex
fn corner(@location(0) position: vec3f, @location(1) normal: vec3f) -> Corner {
    return Corner(clip_from_eye * vec4f(position, 1.0), position, normal);
}

fn normal_of(in: Corner) -> vec3f {
    return select(in.normal, -in.normal, dot(in.normal, in.position) > 0.0);
}

@fragment
fn packed(in: Corner) -> @location(0) u32 {
    return pack_normal(normal_of(in), true);
}

// Uses both, as any shading does.
fn shaded(in: Corner) -> f32 {
    return saturate(-dot(normalize(in.position), normal_of(in)));
}

@fragment
fn own(in: Corner) -> @location(0) f32 {
    return shaded(in);
}
