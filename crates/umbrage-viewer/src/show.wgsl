// Pictures of numbers, as a pane shows them.

struct Params {
    // Pixels of the source, and where in the pane its picture begins and ends.
    source: vec2f,
    begin: vec2f,
    end: vec2f,
    // Shown as black and as white.
    low: f32,
    high: f32,
    gain: f32,
}

@group(0) @binding(0) var source: texture_2d<f32>;
// Visibility, and -1 where a pixel is not scored.
@group(0) @binding(1) var truth: texture_2d<f32>;
@group(0) @binding(2) var<uniform> params: Params;

const AROUND = vec4f(0.07, 0.07, 0.1, 1.0);

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The texel of the source at a pixel of the pane; outside of the source there is none.
fn texel(position: vec4f) -> vec2f {
    return (position.xy - params.begin) / (params.end - params.begin) * params.source;
}

fn is_outside(texel: vec2f) -> bool {
    return any(texel < vec2f(0.0)) || any(texel >= params.source);
}

@fragment
fn numbers(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = texel(position);
    let value = textureLoad(source, vec2i(at), 0).r;
    // As in files of grey: the number itself, not encoded.
    let grey = clamp((value - params.low) / (params.high - params.low), 0.0, 1.0);
    return select(vec4f(vec3f(grey), 1.0), AROUND, is_outside(at));
}

@fragment
fn colors(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = texel(position);
    return select(vec4f(textureLoad(source, vec2i(at), 0).rgb, 1.0), AROUND, is_outside(at));
}

@fragment
fn difference(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = texel(position);
    let expected = textureLoad(truth, vec2i(at), 0).r;
    let error = textureLoad(source, vec2i(at), 0).r - expected;
    let grey = vec3f((70.0 + 130.0 * expected) / 255.0);
    let full = select(vec3f(30.0, 90.0, 255.0), vec3f(255.0, 40.0, 20.0), error > 0.0) / 255.0;
    let color = mix(grey, full, min(abs(error) * params.gain, 1.0));
    return select(vec4f(color, 1.0), AROUND, is_outside(at) || expected < 0.0);
}
