// needs: fullscreen, receivers, surface, display
// The standard lighting model (PX 2.2.4) for lights whose visibility is known.

struct ShadingLight {
    center: vec4f,
    color: vec3f,
    range: f32,
    attenuation: vec3f,
    inner_cos: f32,
    direction: vec3f,
    outer_cos: f32,
}

struct ShadingInput {
    eye: Eye,
    ambient: vec3f,
    spare: f32,
    // Where lines of sight are parallel; else zero.
    toward_eye: vec3f,
    more_spare: f32,
    lights: array<ShadingLight, 4>,
}

@group(1) @binding(0) var surface_texture: texture_2d<u32>;
@group(2) @binding(0) var<uniform> input: ShadingInput;
@group(2) @binding(1) var first_visibility: texture_2d<f32>;
@group(2) @binding(2) var second_visibility: texture_2d<f32>;
@group(2) @binding(3) var third_visibility: texture_2d<f32>;
@group(2) @binding(4) var fourth_visibility: texture_2d<f32>;

// How many of the lights there are, 1 to 4.
override LIGHTS: u32 = 1;

// A visible point, relative to the eye.
struct Point {
    position: vec3f,
    // From there to the eye, of unit length.
    toward_eye: vec3f,
    geometric: vec3f,
    // Of unit length.
    normal: vec3f,
    look: Look,
}

fn point_at(at: vec4f, depth: f32) -> Point {
    let pixel = vec2i(at.xy);
    let bits = textureLoad(surface_texture, pixel, 0);
    let position = position_eye(input.eye, at.xy, depth);
    return Point(
        position,
        normalize(select(-position, input.toward_eye, any(input.toward_eye != vec3f(0.0)))),
        unpack_normal(textureLoad(receiver_normal, pixel, 0).x),
        normalize(unpack_normal(bits.x)),
        unpack_look(bits.yzw),
    );
}

// All that follows is chosen without branches: Mesa 22's software driver compiles a shader in which
// branches meet again once more for every frame, and keeps all of it.

// With the distance; 1 for parallel light.
fn falloff(light: ShadingLight, distance: f32) -> f32 {
    let a = light.attenuation;
    let share = min(1.0, 1.0 / max(a.x + distance * (a.y + distance * a.z), 1e-20));
    let within = select(0.0, share, distance <= light.range);
    return select(1.0, within, light.center.w > 0.0);
}

// Of a spot's cone that a way from the light is in; 1 for other lights.
fn spot_share(light: ShadingLight, way: vec3f) -> f32 {
    let t = saturate((dot(way, light.direction) - light.outer_cos) / max(light.inner_cos - light.outer_cos, 1e-6));
    return select(1.0, t * t * (3.0 - 2.0 * t), light.outer_cos > -1.5);
}

// What a point sends to the eye of one light.
fn reflected(light: ShadingLight, visibility: f32, point: Point) -> vec3f {
    let to_light = light.center.xyz - point.position * light.center.w;
    let distance = length(to_light);
    let l = to_light / max(distance, 1e-20);
    // No shadow falls on what does not receive.
    let seen = select(1.0, visibility, point.look.receives);
    let strength = falloff(light, distance) * spot_share(light, -l) * seen;
    let cosine = dot(point.normal, l);
    let mirrored = 2.0 * cosine * point.normal - l;
    let gloss = point.look.specular * pow(max(dot(mirrored, point.toward_eye), 0.0), point.look.shininess);
    let specular = select(0.0, gloss, cosine > 0.0 && point.look.specular > 0.0);
    let sent = strength * light.color * (point.look.base * max(cosine, 0.0) + specular);
    return select(vec3f(0.0), sent, dot(point.geometric, l) > 0.0);
}

fn of_lights(point: Point, pixel: vec2i) -> vec3f {
    var sum = reflected(input.lights[0], textureLoad(first_visibility, pixel, 0).x, point);
    if LIGHTS > 1u {
        sum += reflected(input.lights[1], textureLoad(second_visibility, pixel, 0).x, point);
    }
    if LIGHTS > 2u {
        sum += reflected(input.lights[2], textureLoad(third_visibility, pixel, 0).x, point);
    }
    if LIGHTS > 3u {
        sum += reflected(input.lights[3], textureLoad(fourth_visibility, pixel, 0).x, point);
    }
    return sum;
}

// What comes from a surface without any light.
fn own(look: Look) -> vec3f {
    return look.emissive + input.ambient * look.base;
}

// The light of all lights, to be added.
@fragment
fn add(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == input.eye.background_depth {
        return vec4f(0.0);
    }
    return vec4f(of_lights(point_at(at, depth), vec2i(at.xy)), 0.0);
}

// What lights are added to.
@fragment
fn start(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    let bits = textureLoad(surface_texture, vec2i(at.xy), 0);
    return select(vec4f(own(unpack_look(bits.yzw)), 1.0), vec4f(0.0), depth == input.eye.background_depth);
}

// All in one, as it is shown.
@fragment
fn picture(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let height = at.y / f32(textureDimensions(surface_texture).y);
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == input.eye.background_depth {
        return displayed(vec4f(0.0), height);
    }
    let point = point_at(at, depth);
    return displayed(vec4f(own(point.look) + of_lights(point, vec2i(at.xy)), 1.0), height);
}
