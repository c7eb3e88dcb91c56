// A light as a face that points see: a disc, or a square between −1 and 1.

struct WedgeLight {
    clip_from_eye: mat4x4f,
    // Of the centre, relative to the eye; w = 0: the direction to it.
    center: vec4f,
    // Where wedges are built: light space is linear_row · (p − centre), and p there is relative to the eye with w = 0.
    linear: array<vec4f, 3>,
    inverse: array<vec4f, 3>,
    // The light's hull in that space: points, or directions to the light.
    corners: array<vec4f, 4>,
    // Axes of a flat light: two in its plane over half its size, and its normal.
    axes: array<vec4f, 3>,
    // A box around all that is seen of receivers, relative to the eye.
    low: vec4f,
    high: vec4f,
    // What makes eye-relative coordinates of those of instances.
    eye_from_origin: vec3f,
    // Around the corners.
    radius: f32,
    face: u32,
    // Depths are behind the light beyond 1 where it is at a place.
    parallel: u32,
    // A share of coordinates by which rounding moves things.
    rounding: f32,
    // Chunks of triangles that may be between eye and light.
    eye_chunks: u32,
}

// The face is perpendicular to the way to the light, and light space makes the light a ball of radius 1.
const BALL: u32 = 0u;
// Axes of the face are fixed.
const DISC: u32 = 1u;
const RECT: u32 = 2u;
// A square about one axis that is next to nothing wide.
const LINE: u32 = 3u;
const PICTURE: u32 = 4u;

fn light_linear(light: WedgeLight, d: vec3f) -> vec3f {
    return vec3f(dot(light.linear[0].xyz, d), dot(light.linear[1].xyz, d), dot(light.linear[2].xyz, d));
}

fn light_inverse(light: WedgeLight, d: vec3f) -> vec3f {
    return vec3f(dot(light.inverse[0].xyz, d), dot(light.inverse[1].xyz, d), dot(light.inverse[2].xyz, d));
}
