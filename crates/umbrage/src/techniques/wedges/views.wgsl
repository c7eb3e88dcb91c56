// needs: fullscreen, inspect
// Pictures of wedges: numbers of each pixel as colours.

@group(1) @binding(0) var<uniform> eye: Eye;
@group(1) @binding(1) var numbers: texture_2d<f32>;
@group(1) @binding(2) var visibility: texture_2d<f32>;

// The number that is white in a picture of overdraw.
override MOST: f32 = 64.0;

fn numbers_at(at: vec4f) -> vec2f {
    return textureLoad(numbers, vec2i(at.xy), 0).xy;
}

fn heated(number: f32) -> vec4f {
    return vec4f(heat(log2(1.0 + number) / log2(1.0 + MOST)), 1.0);
}

// Single lines stand out, and where they are dense the denser are the brighter.
@fragment
fn wireframe(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let lines = numbers_at(at).x;
    let color = mix(vec3f(0.9, 0.5, 0.05), vec3f(1.0, 1.0, 0.9), lines / (lines + 16.0));
    return vec4f(mix(grey(eye, at), color, lines / (lines + 0.7)), 1.0);
}

// Fronts orange, backs blue, the more the brighter, but never so bright that nothing is told apart.
@fragment
fn wedges(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let both = numbers_at(at) / (numbers_at(at) + 3.0);
    return vec4f(grey(eye, at) + both.x * vec3f(0.8, 0.34, 0.05) + both.y * vec3f(0.06, 0.3, 0.8), 1.0);
}

// Inner penumbra orange, outer yellow, umbra blue, lit grey.
@fragment
fn penumbra(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let sides = numbers_at(at);
    let crossing = sides.x + sides.y;
    let lit = grey(eye, at) * 2.5;
    if crossing == 0.0 {
        let is_lit = textureLoad(visibility, vec2i(at.xy), 0).x > 0.5;
        return vec4f(select(vec3f(0.08, 0.14, 0.45), lit, is_lit), 1.0);
    }
    return vec4f(mix(vec3f(0.95, 0.85, 0.2), vec3f(0.9, 0.3, 0.08), sides.x / crossing), 1.0);
}

@fragment
fn overdraw(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return heated(numbers_at(at).x);
}

@fragment
fn fragments(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return heated(numbers_at(at).x);
}

// White is nothing, red half of the light taken, blue half of it added; grey where nothing is seen.
@fragment
fn correction(@builtin(position) at: vec4f) -> @location(0) vec4f {
    if textureLoad(receiver_depth, vec2i(at.xy), 0) == eye.background_depth {
        return vec4f(vec3f(0.4), 1.0);
    }
    // Sides of bodies with holes add up apart.
    let both = numbers_at(at);
    let taken = both.x + both.y;
    let strength = min(abs(taken), 1.0);
    return vec4f(mix(vec3f(1.0), select(vec3f(0.1, 0.25, 0.85), vec3f(0.85, 0.12, 0.1), taken > 0.0), strength), 1.0);
}

// Where no wedges are drawn, what is seen.
@fragment
fn pieces(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(grey(eye, at), 1.0);
}
