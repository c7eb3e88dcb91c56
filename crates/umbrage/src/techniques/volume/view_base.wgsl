// needs: fullscreen, inspect
// What pictures of volumes are drawn over, and numbers as colours.

struct ViewBase {
    eye: Eye,
    // What a number is divided by before it is a share of the scale.
    scale: f32,
    pad_a: f32,
    pad_b: f32,
    pad_c: f32,
}

@group(1) @binding(0) var<uniform> base: ViewBase;
@group(1) @binding(1) var numbers: texture_2d<f32>;

@fragment
fn scene(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(grey(base.eye, at), 1.0);
}

@fragment
fn heated(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let number = textureLoad(numbers, vec2i(at.xy), 0).x;
    return vec4f(select(heat(log2(1.0 + number) / log2(1.0 + base.scale)), vec3f(0.0), number == 0.0), 1.0);
}

// Fronts orange, backs blue, added to the scene: the more the brighter, but never so bright that
// nothing is told apart.
@fragment
fn volumes(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let surfaces = textureLoad(numbers, vec2i(at.xy), 0).xy;
    let both = surfaces / (surfaces + 3.0);
    return vec4f(grey(base.eye, at) + both.x * vec3f(0.8, 0.34, 0.05) + both.y * vec3f(0.06, 0.3, 0.8), 1.0);
}

// Lit surfaces grey, shadows by how many there are: a colour for each number up to seven, then
// brighter to white; a number below zero, which none should be, magenta.
@fragment
fn numbered(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let number = i32(round(textureLoad(numbers, vec2i(at.xy), 0).x));
    if number == 0 {
        return vec4f(grey(base.eye, at) * 2.0, 1.0);
    }
    if number < 0 {
        return vec4f(1.0, 0.0, 1.0, 1.0);
    }
    var colors = array<vec3f, 7>(
        vec3f(0.10, 0.30, 0.75), vec3f(0.05, 0.60, 0.60), vec3f(0.15, 0.65, 0.20), vec3f(0.70, 0.75, 0.10),
        vec3f(0.90, 0.55, 0.05), vec3f(0.85, 0.20, 0.10), vec3f(0.65, 0.10, 0.45),
    );
    let beyond = saturate(f32(number - 7) / 24.0);
    return vec4f(mix(colors[min(number, 7) - 1], vec3f(1.0), beyond), 1.0);
}
