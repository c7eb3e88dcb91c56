// A light in a space of its own: its centre is the origin and it is a ball of radius 1; or a disc of radius 1, or a square from −1 to
// 1, in the plane z = 0; or a line from −1 to 1 along x. Light from infinitely far away comes from the directions (x, y, 1) of a
// disc of radius 1.

struct WedgeLight {
    clip_from_eye: mat4x4f,
    // Rows of the way to and fro: light space is rows · (p − centre) for p relative to the eye.
    to_light: array<vec4f, 3>,
    from_light: array<vec4f, 3>,
    // Corners of the light's hull, or directions.
    corners: array<vec4f, 4>,
    // A box around all that is seen of receivers, relative to the eye.
    low: vec4f,
    high: vec4f,
    // Relative to the eye; 0 for light from infinitely far away.
    center: vec3f,
    // Around the corners.
    radius: f32,
    // What makes eye-relative coordinates of those of instances.
    eye_from_origin: vec3f,
    face: u32,
    parallel: u32,
    // A share of coordinates by which rounding moves things.
    rounding: f32,
    // Chunks of triangles that may be between eye and light.
    eye_chunks: u32,
    pad: u32,
}

const BALL: u32 = 0u;
const DISC: u32 = 1u;
const SQUARE: u32 = 2u;
const LINE: u32 = 3u;
const PICTURE: u32 = 4u;

// How wide a line is taken to be.
const LINE_WIDTH: f32 = 1e-3;

fn to_light(light: WedgeLight, p: vec3f) -> vec3f {
    let d = p - light.center;
    return vec3f(dot(light.to_light[0].xyz, d), dot(light.to_light[1].xyz, d), dot(light.to_light[2].xyz, d));
}

// Of a direction.
fn from_light(light: WedgeLight, d: vec3f) -> vec3f {
    return vec3f(dot(light.from_light[0].xyz, d), dot(light.from_light[1].xyz, d), dot(light.from_light[2].xyz, d));
}

// The way from a point to the light.
fn way_to_light(light: WedgeLight, p: vec3f) -> vec3f {
    return select(-p, vec3f(0.0, 0.0, 1.0), light.parallel != 0u);
}
