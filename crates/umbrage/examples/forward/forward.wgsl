// The host's shader. The look-ups of its two lights stand before it; positions are relative to the
// eye, with the axes of the world.

struct Light {
    // Of a point its place relative to the eye and 1, of parallel light the way to it and 0.
    center: vec4f,
    color: vec4f,
}

struct Frame {
    clip_from_eye: mat4x4f,
    lights: array<Light, 2>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    @location(3) @interpolate(flat) kind: u32,
}

// A surface that casts shadows, one that casts none and lets light through, or smoke.
const SOLID: u32 = 0u;
const PANE: u32 = 1u;

@vertex
fn corner(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    @location(3) kind: u32,
) -> Corner {
    return Corner(frame.clip_from_eye * vec4f(position, 1.0), position, normal, color, kind);
}

// The share of a light that a point sees: the only lines that shadows take in this shader.
fn share_of(light: u32, in: Corner) -> f32 {
    if in.kind == SOLID {
        return lights_visibility(light, in.position, in.normal);
    }
    if in.kind == PANE {
        return lights_visibility_of_pane(light, in.position, in.normal);
    }
    return lights_visibility_in_air(light, in.position);
}

fn lit(light: u32, in: Corner) -> vec3f {
    let center = frame.lights[light].center;
    let way = center.xyz - in.position * center.w;
    let toward = way / length(way);
    let turned = select(in.normal, -in.normal, dot(in.normal, in.position) > 0.0);
    let cosine = dot(turned, toward);
    let facing = select(select(0.6, abs(cosine), in.kind == PANE), max(cosine, 0.0), in.kind == SOLID);
    let falloff = select(1.0, 1.0 / dot(way, way), center.w > 0.0);
    return in.color.rgb * frame.lights[light].color.rgb * (facing * falloff * share_of(light, in));
}

@fragment
fn shaded(in: Corner) -> @location(0) vec4f {
    let ambient = in.color.rgb * vec3f(0.05, 0.06, 0.08);
    return vec4f(ambient + lit(0u, in) + lit(1u, in), in.color.a);
}

// To be compared with the truth: one light's share alone.
override LIGHT: u32 = 0u;

@fragment
fn share(in: Corner) -> @location(0) vec4f {
    return vec4f(share_of(LIGHT, in), 0.0, 0.0, 1.0);
}
