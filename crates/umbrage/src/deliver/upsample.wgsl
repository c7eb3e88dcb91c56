// needs: fullscreen, receivers
// Visibility at half the size to the full one: of the four nearest values those count that lie on
// the plane of the surface.

struct Upsampling {
    eye: Eye,
    // What one of the coarse pixels is across and down, in normalised device coordinates.
    ndc_from_coarse: vec2f,
    // Coarse pixels for each fine one.
    scale: vec2f,
    // Upper left pixel of the target.
    corner: vec2i,
    coarse_size: vec2i,
}

@group(1) @binding(0) var<uniform> upsampling: Upsampling;
@group(1) @binding(1) var coarse_depth: texture_depth_2d;
@group(1) @binding(2) var coarse_visibility: texture_2d<f32>;

// Distance from the surface, as a share of a coarse pixel's width, at which a value counts half.
const NEAR: f32 = 0.1;

struct Sum {
    visibility: f32,
    weight: f32,
}

// What the coarse pixel `at` adds for the surface through `here`; `weight` is that of the picture.
fn added(eye: Eye, at: vec2i, here: vec3f, across: vec3f, weight: f32) -> Sum {
    let pixel = clamp(at, vec2i(0), upsampling.coarse_size - 1);
    let depth = textureLoad(coarse_depth, pixel, 0);
    let off = dot(across, position_eye(eye, vec2f(pixel) + 0.5, depth) - here);
    let share = select(weight / (1.0 + off * off), 0.0, depth == eye.background_depth);
    return Sum(share * textureLoad(coarse_visibility, pixel, 0).x, share);
}

@fragment
fn upsample(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let fine = upsampling.eye;
    let pixel = position.xy - vec2f(upsampling.corner);
    let depth = textureLoad(receiver_depth, vec2i(pixel), 0);
    if depth == fine.background_depth {
        return vec4f(1.0);
    }
    let here = position_eye(fine, pixel, depth);
    let normal = surface(fine, pixel, depth).normal;
    var eye = fine;
    eye.ndc_from_pixel = upsampling.ndc_from_coarse;
    // Distances from the plane in units of `NEAR`.
    let m = fine.eye_from_ndc;
    let inverse_w = abs(1.0 / eye_w(fine, ndc_of(fine, pixel, depth)));
    let width = max(length(m[0].xyz), length(m[1].xyz)) * abs(upsampling.ndc_from_coarse.x) * inverse_w;
    let across = normal / max(length(normal) * NEAR * width, 1e-30);

    let from_corner = pixel * upsampling.scale - 0.5;
    let first = floor(from_corner);
    let share = from_corner - first;
    let at = vec2i(first);
    // None counts for nothing, so that one is found on the surface wherever there is one.
    let right = mix(0.02, 0.98, share.x);
    let below = mix(0.02, 0.98, share.y);
    let a = added(eye, at, here, across, (1.0 - right) * (1.0 - below));
    let b = added(eye, at + vec2i(1, 0), here, across, right * (1.0 - below));
    let c = added(eye, at + vec2i(0, 1), here, across, (1.0 - right) * below);
    let d = added(eye, at + vec2i(1, 1), here, across, right * below);
    let weight = a.weight + b.weight + c.weight + d.weight;
    let sum = a.visibility + b.visibility + c.visibility + d.visibility;
    return vec4f(select(1.0, sum / max(weight, 1e-30), weight > 1e-20));
}
