// needs: fullscreen, receivers
// The mean of visibility over frames, for each visible point for as long as nothing changes that
// could change it.

// Most casters whose moves are told apart.
const MOVERS: u32 = 32u;

// A distance is kept in 12 bits: its base 2 logarithm, from here in so many octaves.
const LOWEST: f32 = -10.0;
const OCTAVES: f32 = 40.0;
// Share of its distance that a surface of the last frame may be off, at least, and pixels.
const NEAR: f32 = 0.015;
const PIXELS: f32 = 2.0;
// Pixels that a point may have moved by and count as still.
const STILL: f32 = 0.02;

struct History {
    eye: Eye,
    // Places relative to the eye to the last frame's clip space.
    last_clip_from_eye: mat4x4f,
    // The last frame's eye; its fourth is a pixel's width over its distance.
    last_eye: vec4f,
    // The light's centre relative to the eye, or the unit way to parallel light; the fourth is its
    // radius, or the tangent of its half angle.
    light: vec4f,
    size: vec2f,
    // Frames that a mean is of, at most.
    frames: f32,
    // 1 where there is a last frame.
    is_known: u32,
    is_parallel: u32,
    movers: u32,
    pad: vec2f,
    // Spheres around casters that moved, before and after, relative to the eye.
    spheres: array<vec4f, MOVERS>,
}

@group(1) @binding(0) var<uniform> history: History;
@group(1) @binding(1) var fresh: texture_2d<f32>;
@group(1) @binding(2) var last: texture_2d<u32>;

struct Kept {
    @location(0) visibility: f32,
    @location(1) bits: u32,
}

fn octave(distance: f32) -> f32 {
    return clamp((log2(max(distance, 1e-30)) - LOWEST) / OCTAVES, 0.0, 1.0);
}

// 14 bits of visibility, 6 of the number of frames less one, 12 of distance.
fn packed(visibility: f32, count: f32, distance: f32) -> u32 {
    let share = u32(saturate(visibility) * 16383.0 + 0.5);
    return (share << 18u) | (u32(clamp(count - 1.0, 0.0, 63.0)) << 12u) | u32(octave(distance) * 4095.0 + 0.5);
}

// Whether a sphere may hide some of the light from a point.
fn is_between(place: vec3f, sphere: vec4f) -> bool {
    let to_sphere = sphere.xyz - place;
    let to_light = history.light.xyz - place;
    let distance = select(length(to_light), 1e30, history.is_parallel != 0u);
    let way = select(to_light / max(distance, 1e-30), history.light.xyz, history.is_parallel != 0u);
    let along = clamp(dot(to_sphere, way), 0.0, distance);
    let reach = along + sphere.w;
    let wide = history.light.w * select(min(reach / max(distance, 1e-30), 1.0), reach, history.is_parallel != 0u);
    return length(to_sphere - along * way) <= sphere.w + wide;
}

// What the last frame knows: visibility, frames, and the share of the four texels that show this
// surface.
fn known(place: vec3f, distance: f32, facing: f32) -> vec3f {
    let clip = history.last_clip_from_eye * vec4f(place, 1.0);
    let at = (clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5) * history.size - 0.5;
    let is_still = all(abs(at - round(at)) < vec2f(STILL));
    let source = select(at, round(at), is_still);
    let first = floor(source);
    let share = source - first;
    let away = octave(length(place - history.last_eye.xyz));
    let off = max(NEAR, PIXELS * history.last_eye.w / max(facing, 0.02)) / (0.693 * OCTAVES);
    var sum = vec3f(0.0);
    for (var i = 0u; i < 4u; i++) {
        let step = vec2f(f32(i & 1u), f32(i >> 1u));
        let texel = first + step;
        let is_inside = all(texel >= vec2f(0.0)) && all(texel < history.size) && clip.w > 0.0;
        let bits = textureLoad(last, vec2i(clamp(texel, vec2f(0.0), history.size - 1.0)), 0).x;
        let weight = select(1.0 - share.x, share.x, step.x > 0.0) * select(1.0 - share.y, share.y, step.y > 0.0);
        let is_same = abs(f32(bits & 4095u) / 4095.0 - away) <= off;
        let count = select(0.0, f32((bits >> 12u) & 63u) + 1.0, bits != 0u);
        let counts = select(0.0, weight, is_inside && is_same && count > 0.0);
        sum += counts * vec3f(f32(bits >> 18u) / 16383.0, count, 1.0);
    }
    return select(vec3f(0.0), sum, history.is_known != 0u && clip.w > 0.0);
}

@fragment
fn accumulate(@builtin(position) position: vec4f) -> Kept {
    let own = textureLoad(fresh, vec2i(position.xy), 0).x;
    let depth = textureLoad(receiver_depth, vec2i(position.xy), 0);
    let place = position_eye(history.eye, position.xy, depth);
    let distance = length(place);
    let normal = surface(history.eye, position.xy, depth).normal;
    let facing = abs(dot(normal, place)) / max(length(normal) * distance, 1e-30);
    let found = known(place, distance, facing);
    var moved = 0u;
    for (var i = 0u; i < history.movers; i++) {
        moved |= select(0u, 1u, is_between(place, history.spheres[i]));
    }
    let is_kept = found.z > 0.01 && moved == 0u;
    let weight = 1.0 / max(found.z, 1e-3);
    let count = select(0.0, min(found.y * weight, history.frames - 1.0), is_kept) + 1.0;
    let mean = mix(select(own, found.x * weight, is_kept), own, 1.0 / count);
    let is_drawn = depth != history.eye.background_depth;
    return Kept(select(own, mean, is_drawn), select(0u, packed(mean, count, distance), is_drawn));
}
