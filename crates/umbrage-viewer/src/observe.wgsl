// The scene from outside, with the visibility that a technique found for a camera that stands
// still.

struct Params {
    // Clip space of the observer to that of the camera that stands still.
    frozen_from_observer: mat4x4f,
    // 0 for the shaded scene, 1 for visibility, 2 for its error.
    picture: f32,
    gain: f32,
    unused_0: f32,
    unused_1: f32,
}

// The scene without shadows, and its depth, as the observer sees it.
@group(0) @binding(0) var lit: texture_2d<f32>;
@group(0) @binding(1) var depth: texture_2d<f32>;
// As the camera that stands still sees it.
@group(0) @binding(2) var frozen_depth: texture_2d<f32>;
@group(0) @binding(3) var visibility: texture_2d<f32>;
// As the observer sees it, -1 where a pixel is not scored.
@group(0) @binding(4) var truth: texture_2d<f32>;
@group(0) @binding(5) var<uniform> params: Params;

// Where the frozen camera sees nothing.
const UNSEEN = vec3f(0.11, 0.13, 0.22);

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The visibility that was found for a point of the observer's picture; -1 where there is none.
fn found(pixel: vec2i) -> f32 {
    let size = vec2f(textureDimensions(depth));
    let here = textureLoad(depth, pixel, 0).r;
    let place = (vec2f(pixel) + 0.5) / size;
    let clip = params.frozen_from_observer * vec4f(place.x * 2.0 - 1.0, 1.0 - place.y * 2.0, here, 1.0);
    let ndc = clip.xyz / select(1.0, clip.w, clip.w > 0.0);
    let outside = here <= 0.0 || clip.w <= 0.0 || any(abs(ndc.xy) >= vec2f(1.0));
    let last = vec2i(size) - 1;
    let at = clamp(vec2i((ndc.xy * vec2f(0.5, -0.5) + 0.5) * size), vec2i(0), last);
    // Between the pixels around it a surface may have any depth.
    var low = 1e9;
    var high = 0.0;
    for (var i = 0; i < 9; i++) {
        let other = textureLoad(frozen_depth, clamp(at + vec2i(i % 3, i / 3) - 1, vec2i(0), last), 0).r;
        low = min(low, other);
        high = max(high, other);
    }
    let hidden = ndc.z < low * 0.995 - 1e-6 || ndc.z > high * 1.005 + 1e-6 || high <= 0.0;
    return select(textureLoad(visibility, at, 0).r, -1.0, outside || hidden);
}

fn encoded(linear: vec3f) -> vec3f {
    let curve = 1.055 * pow(max(linear, vec3f(0.0)), vec3f(1.0 / 2.4)) - 0.055;
    return clamp(select(curve, linear * 12.92, linear <= vec3f(0.0031308)), vec3f(0.0), vec3f(1.0));
}

@fragment
fn observe(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let found = found(pixel);
    let is_seen = found >= 0.0;
    let color = textureLoad(lit, pixel, 0).rgb;
    let shaded = encoded(select(color * 0.12 + vec3f(0.0, 0.002, 0.012), color * (0.25 + 0.75 * found), is_seen));
    let grey = select(UNSEEN, vec3f(found), is_seen);
    let expected = textureLoad(truth, pixel, 0).r;
    let error = found - expected;
    let full = select(vec3f(30.0, 90.0, 255.0), vec3f(255.0, 40.0, 20.0), error > 0.0) / 255.0;
    let wrong = mix(vec3f((70.0 + 130.0 * expected) / 255.0), full, min(abs(error) * params.gain, 1.0));
    let is_scored = is_seen && expected >= 0.0;
    let difference = select(UNSEEN, wrong, is_scored);
    return vec4f(select(select(shaded, grey, params.picture > 0.5), difference, params.picture > 1.5), 1.0);
}
