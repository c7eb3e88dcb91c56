// The geometric normal of each pixel, packed as umbrage reads it. Bevy's G-buffer has the one that
// surfaces are shaded with; depth has the true one, except where a surface is narrower than two
// pixels.

struct Eye {
    /// Normalised device coordinates to space relative to the eye.
    eye_from_ndc: mat4x4f,
    /// The way to the eye where that is the same everywhere; `w` is 1 then and 0 otherwise.
    to_eye: vec4f,
    ndc_from_pixel: vec2f,
    pad: vec2f,
}

@group(0) @binding(0) var depths: texture_depth_2d;
@group(0) @binding(1) var surfaces: texture_2d<u32>;
@group(0) @binding(2) var<uniform> eye: Eye;

/// The cosine to the normal that is shaded with below which neighbours do not tell the true one.
const ALIKE = 0.5;

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn normals(@builtin(position) position: vec4f) -> @location(0) u32 {
    let pixel = vec2i(position.xy);
    let depth = depth_at(pixel);
    if depth == 0.0 {
        return 0u;
    }
    let packed = textureLoad(surfaces, pixel, 0).w;
    let shaded = direction(vec2f(vec2u(packed, packed >> 12u) & vec2u(0xfffu)) / 4095.0);
    let here = place(pixel, depth);
    let n = cross(along(pixel, depth, here, vec2i(1, 0)), along(pixel, depth, here, vec2i(0, 1)));
    let to_eye = select(-here, eye.to_eye.xyz, eye.to_eye.w == 1.0);
    let size = length(n) * select(-1.0, 1.0, dot(n, to_eye) > 0.0);
    let found = select(vec3f(), n / size, size != 0.0);
    return pack_normal(select(shaded, found, dot(found, shaded) > ALIKE), true);
}

fn depth_at(pixel: vec2i) -> f32 {
    return textureLoad(depths, clamp(pixel, vec2i(0), vec2i(textureDimensions(depths)) - 1), 0);
}

/// Relative to the eye.
fn place(pixel: vec2i, depth: f32) -> vec3f {
    let ndc = (vec2f(pixel) + 0.5) * eye.ndc_from_pixel + vec2f(-1.0, 1.0);
    let p = eye.eye_from_ndc * vec4f(ndc, depth, 1.0);
    return p.xyz / p.w;
}

/// A step on the surface, by the one of two neighbours that lies on it more surely: depth is linear
/// on a plane, so the next one beyond tells.
fn along(pixel: vec2i, depth: f32, here: vec3f, step: vec2i) -> vec3f {
    let after = vec2f(depth_at(pixel + step), depth_at(pixel + 2 * step));
    let before = vec2f(depth_at(pixel - step), depth_at(pixel - 2 * step));
    let bends = abs(vec2f(2.0 * after.x - after.y, 2.0 * before.x - before.y) - depth);
    let to_after = place(pixel + step, after.x) - here;
    let to_before = here - place(pixel - step, before.x);
    // The border of the picture repeats its last pixel, and leads nowhere.
    let is_after = (bends.x <= bends.y && any(to_after != vec3f())) || all(to_before == vec3f());
    return select(to_before, to_after, is_after);
}
