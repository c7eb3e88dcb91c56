// needs: pack_normal
// The visible surfaces: where they are relative to the eye, and which way they face.

struct Eye {
    // Camera's normalised device coordinates to space relative to the eye, with world axes,
    // homogeneous.
    eye_from_ndc: mat4x4f,
    ndc_from_pixel: vec2f,
    // What the depth buffer holds where nothing was drawn.
    background_depth: f32,
    // Largest |x| + |y| + |z| of `eye_from_ndc` in the picture, before the division by w.
    reach: f32,
    // How far the rasteriser that made the depth buffer may shift surfaces, in normalised device
    // coordinates.
    snapped: vec2f,
    pad: vec2f,
}

@group(0) @binding(0) var receiver_depth: texture_depth_2d;
// Geometric normals as `pack_normal` leaves them.
@group(0) @binding(1) var receiver_normal: texture_2d<u32>;

override HAS_NORMALS: bool = true;

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

// How far, in metres, a position may be off because the depth buffer rounds: one step of single
// precision (or of 24 bits) around `depth`. Next to nothing for a reversed projection, a millimetre
// and more for others. `inverse_w` is one over the position's w before division.
fn position_rounding(eye: Eye, depth: f32, inverse_w: f32) -> f32 {
    let inverse = abs(inverse_w);
    // A normal taken from neighbouring depths is off by their rounding, too.
    let step = select(9.6e-7, 1.2e-7, HAS_NORMALS);
    return step * eye.reach * inverse * (1.0 + depth * abs(eye.eye_from_ndc[2].w) * inverse);
}

// Metres times the length of `normal` that a position may be off its surface: rasterisers snap
// corners of triangles, so that a pixel has the depth of its surface some part of a pixel aside.
fn off_surface(eye: Eye, normal: vec3f, inverse_w: f32) -> f32 {
    let m = eye.eye_from_ndc;
    return dot(eye.snapped, abs(vec2f(dot(normal, m[0].xyz), dot(normal, m[1].xyz)) * inverse_w));
}

// The same in metres for a surface that lies in any way.
fn off_any_surface(eye: Eye, inverse_w: f32) -> f32 {
    let m = eye.eye_from_ndc;
    return dot(eye.snapped, vec2f(length(m[0].xyz), length(m[1].xyz)) * abs(inverse_w));
}

// From `here` to the neighbour along `step`, nothing where that is off the picture or shows no
// surface.
fn toward(eye: Eye, pixel: vec2f, here: vec3f, step: vec2i) -> vec3f {
    let size = vec2i(textureDimensions(receiver_depth));
    let at = vec2i(pixel) + step;
    if any(at < vec2i(0)) || any(at >= size) {
        return vec3f(0.0);
    }
    let depth = textureLoad(receiver_depth, at, 0);
    if depth == eye.background_depth {
        return vec3f(0.0);
    }
    return position_eye(eye, vec2f(at) + 0.5, depth) - here;
}

// Change of position along `step` on the surface itself: towards the neighbour that is nearer,
// since the other one may be across an edge.
fn along_surface(eye: Eye, pixel: vec2f, here: vec3f, step: vec2i) -> vec3f {
    let after = toward(eye, pixel, here, step);
    let before = -toward(eye, pixel, here, -step);
    let a = dot(after, after);
    let b = dot(before, before);
    return select(before, after, b == 0.0 || (a > 0.0 && a < b));
}

struct Surface {
    // Geometric normal with world axes, turned to the eye, of any length.
    normal: vec3f,
    // Whether it casts shadows. Without normals that is not known, and taken to be so.
    casts: bool,
}

fn surface(eye: Eye, pixel: vec2f, depth: f32) -> Surface {
    if HAS_NORMALS {
        let bits = textureLoad(receiver_normal, vec2i(pixel), 0).x;
        return Surface(unpack_normal(bits), (bits & 1u) != 0u);
    }
    let here = position_eye(eye, pixel, depth);
    let across = along_surface(eye, pixel, here, vec2i(1, 0));
    let down = along_surface(eye, pixel, here, vec2i(0, 1));
    return Surface(cross(down, across), true);
}
