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

// The neighbour along `step` that lies on the same surface: the one whose depth differs less.
fn along_surface(eye: Eye, pixel: vec2f, depth: f32, step: vec2i) -> vec3f {
    let size = vec2i(textureDimensions(receiver_depth));
    let at = vec2i(pixel);
    let before = clamp(at - step, vec2i(0), size - 1);
    let after = clamp(at + step, vec2i(0), size - 1);
    let depth_before = textureLoad(receiver_depth, before, 0);
    let depth_after = textureLoad(receiver_depth, after, 0);
    let here = position_eye(eye, pixel, depth);
    let use_after = any(before == at) || (any(after != at) && abs(depth_after - depth) < abs(depth_before - depth));
    if use_after {
        return position_eye(eye, vec2f(after) + 0.5, depth_after) - here;
    }
    return here - position_eye(eye, vec2f(before) + 0.5, depth_before);
}

// Geometric normal, either side, unit length.
fn normal_world(eye: Eye, pixel: vec2f, depth: f32) -> vec3f {
    if HAS_NORMALS {
        return textureLoad(receiver_normal, vec2i(pixel), 0).xyz;
    }
    let across = along_surface(eye, pixel, depth, vec2i(1, 0));
    let down = along_surface(eye, pixel, depth, vec2i(0, 1));
    let n = cross(across, down);
    let squared = dot(n, n);
    return select(vec3f(0.0), n * inverseSqrt(squared), squared > 0.0);
}
