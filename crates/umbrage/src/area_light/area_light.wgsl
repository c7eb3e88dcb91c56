// A light in a space of its own: its centre is the origin and it is a sphere of radius 1; or a disc
// of radius 1, or a square from −1 to 1, in the plane z = 0; or a line from −1 to 1 along x. Light
// from infinitely far away comes from the directions (x, y, 1) of a disc of radius 1.

struct AreaLight {
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
    parallel: u32,
    // A share of coordinates by which rounding moves things.
    rounding: f32,
    // Chunks of triangles whose caps are made, see `caps.wgsl`.
    cap_chunks: u32,
    // Pixels of the picture that one of the buffer of shares stands for, along each side.
    scale: u32,
    // −1 where light space is mirrored, else 1.
    handed: f32,
    // Wedges that are built, see `make.wgsl`.
    first_wedge: u32,
    most_wedges: u32,
    pad: vec2u,
    // Of a split disc the piece: see `Cell` in the core crate. Its rectangle, what its sides start
    // with, the arc's middle, what the arc starts with, and ∮ X × dX all around.
    cell: vec4f,
    cell_sides: vec4f,
    cell_arc: vec4f,
    // Where lines of sight start, relative to the eye and homogeneous: there, or for parallel ones
    // infinitely far away.
    toward_eye: vec3f,
    eye_w: f32,
}

// A piece of a disc or a sphere under one caster.
struct Anchor {
    // Where silhouettes are seen from: a point of the light in light space, or a direction to it.
    place: vec3f,
    pad_a: f32,
    // Projected to the face of a sphere its x.
    axis: vec3f,
    pad_b: f32,
}

const SPHERE: u32 = 0u;
const DISC: u32 = 1u;
const SQUARE: u32 = 2u;
const LINE: u32 = 3u;
const PICTURE: u32 = 4u;

// How wide a line is taken to be.
const LINE_WIDTH: f32 = 1e-3;

fn to_light(light: AreaLight, p: vec3f) -> vec3f {
    let d = p - light.center;
    return vec3f(dot(light.to_light[0].xyz, d), dot(light.to_light[1].xyz, d), dot(light.to_light[2].xyz, d));
}

// Of a direction.
fn from_light(light: AreaLight, d: vec3f) -> vec3f {
    return vec3f(dot(light.from_light[0].xyz, d), dot(light.from_light[1].xyz, d), dot(light.from_light[2].xyz, d));
}

// The middle of the picture's pixel that a place in the buffer of shares stands for.
fn full_pixel(light: AreaLight, at: vec2f) -> vec2f {
    let scale = f32(light.scale);
    return floor(at) * scale + floor(0.5 * scale) + 0.5;
}

// The way from a point to a place of the light, or the direction to it.
fn way_to(light: AreaLight, place: vec3f, p: vec3f) -> vec3f {
    return select(place - p, place, light.parallel != 0u);
}

// The way from a point to the light.
fn way_to_light(light: AreaLight, p: vec3f) -> vec3f {
    return select(-p, vec3f(0.0, 0.0, 1.0), light.parallel != 0u);
}
