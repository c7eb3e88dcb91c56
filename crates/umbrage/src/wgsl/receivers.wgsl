// The visible surfaces: where they are relative to the eye, and which way they face.

struct Eye {
    // Camera's normalised device coordinates to space relative to the eye, with world axes.
    eye_from_ndc: mat4x4f,
    ndc_from_pixel: vec2f,
    background_depth: f32,
    spare: f32,
}

@group(0) @binding(0) var receiver_depth: texture_depth_2d;
@group(0) @binding(1) var receiver_normal: texture_2d<f32>;

override HAS_NORMALS: bool = true;

fn position_eye(eye: Eye, pixel: vec2f, depth: f32) -> vec3f {
    let ndc = pixel * eye.ndc_from_pixel + vec2f(-1.0, 1.0);
    let p = eye.eye_from_ndc * vec4f(ndc, depth, 1.0);
    return p.xyz / p.w;
}

// How far, in metres, a position may be off because the depth buffer rounds: one step of single precision (or of 24 bits)
// around `depth`. Next to nothing for a reversed projection, a millimetre and more for others.
fn position_rounding(eye: Eye, pixel: vec2f, depth: f32, position: vec3f) -> f32 {
    let ndc = pixel * eye.ndc_from_pixel + vec2f(-1.0, 1.0);
    let m = eye.eye_from_ndc;
    let w = m[0].w * ndc.x + m[1].w * ndc.y + m[2].w * depth + m[3].w;
    let relative = 1.2e-7 * (1.0 + depth * abs(m[2].w / w));
    // A normal taken from neighbouring depths is off by their rounding, too.
    return relative * (abs(position.x) + abs(position.y) + abs(position.z)) * select(8.0, 1.0, HAS_NORMALS);
}

// From `here` to the neighbour along `step`, nothing where that is off the picture or shows no surface.
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

// Change of position along `step` on the surface itself: towards the neighbour that is nearer, since the other one may
// be across an edge.
fn along_surface(eye: Eye, pixel: vec2f, here: vec3f, step: vec2i) -> vec3f {
    let after = toward(eye, pixel, here, step);
    let before = -toward(eye, pixel, here, -step);
    let a = dot(after, after);
    let b = dot(before, before);
    return select(before, after, b == 0.0 || (a > 0.0 && a < b));
}

// Geometric normal, either side, unit length.
fn normal_world(eye: Eye, pixel: vec2f, depth: f32) -> vec3f {
    if HAS_NORMALS {
        return textureLoad(receiver_normal, vec2i(pixel), 0).xyz;
    }
    let here = position_eye(eye, pixel, depth);
    let across = along_surface(eye, pixel, here, vec2i(1, 0));
    let down = along_surface(eye, pixel, here, vec2i(0, 1));
    let n = cross(across, down);
    let squared = dot(n, n);
    return select(vec3f(0.0), n * inverseSqrt(squared), squared > 0.0);
}
