// The camera, how to get from its pixels to what they show, and what a surface is.

struct Eye {
    // Camera's normalised device coordinates to space relative to the eye, with world axes,
    // homogeneous.
    eye_from_ndc: mat4x4f,
    ndc_from_pixel: vec2f,
    // What the depth buffer holds where nothing was drawn.
    background_depth: f32,
    // Largest |x| + |y| + |z| of `eye_from_ndc` in the picture, before the division by w, times the
    // steps of single precision by which depth may be off.
    rounding: f32,
    // How far the rasteriser that made the depth buffer may shift surfaces to the right, in space
    // relative to the eye, times w.
    shift_right: vec3f,
    // −1 where the picture is mirrored, else 1.
    handed: f32,
    // The same downwards.
    shift_down: vec3f,
    pad: f32,
}

// Homogeneous normalised device coordinates of a pixel.
fn ndc_of(eye: Eye, pixel: vec2f, depth: f32) -> vec4f {
    return vec4f(pixel * eye.ndc_from_pixel + vec2f(-1.0, 1.0), depth, 1.0);
}

// The w of a position before division.
fn eye_w(eye: Eye, ndc: vec4f) -> f32 {
    let m = eye.eye_from_ndc;
    return dot(vec4f(m[0].w, m[1].w, m[2].w, m[3].w), ndc);
}

fn position_eye(eye: Eye, pixel: vec2f, depth: f32) -> vec3f {
    let p = eye.eye_from_ndc * ndc_of(eye, pixel, depth);
    return p.xyz / p.w;
}

// The way of the ray through a pixel, away from the eye, of any length.
fn line_of_sight(eye: Eye, pixel: vec2f) -> vec3f {
    let start = eye.eye_from_ndc * ndc_of(eye, pixel, 0.0);
    let change = eye.eye_from_ndc[2];
    return (change.xyz * start.w - start.xyz * change.w) * (2.0 * eye.background_depth - 1.0);
}

// Metres times the length of `normal` that a position may be off its surface: rasterisers snap
// corners of triangles, so that a pixel has the depth of its surface some part of a pixel aside.
fn off_surface(eye: Eye, normal: vec3f, inverse_w: f32) -> f32 {
    return (abs(dot(normal, eye.shift_right)) + abs(dot(normal, eye.shift_down))) * abs(inverse_w);
}

// The same in metres for a surface that lies in any way.
fn off_any_surface(eye: Eye, inverse_w: f32) -> f32 {
    return (length(eye.shift_right) + length(eye.shift_down)) * abs(inverse_w);
}

struct Surface {
    // Geometric normal with world axes, turned to the eye, of any length.
    normal: vec3f,
    // Whether it casts shadows. Without normals that is not known, and taken to be so.
    casts: bool,
}
