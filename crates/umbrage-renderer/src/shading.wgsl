// needs: fullscreen, receivers
// The standard lighting model (PX 2.2.4) for one light.

struct ShadingLight {
    eye: Eye,
    center: vec4f,
    color: vec3f,
    range: f32,
    attenuation: vec3f,
    inner_cos: f32,
    direction: vec3f,
    outer_cos: f32,
}

@group(1) @binding(0) var surface_shading: texture_2d<f32>;
@group(1) @binding(1) var surface_color: texture_2d<f32>;
@group(2) @binding(0) var<uniform> light: ShadingLight;
@group(2) @binding(1) var visibility_texture: texture_2d<f32>;

// Both are chosen without branches: Mesa 22's software driver compiles a shader in which branches
// meet again once more for every frame, and keeps all of it.

// With the distance; 1 for parallel light.
fn falloff(distance: f32) -> f32 {
    let a = light.attenuation;
    let share = min(1.0, 1.0 / max(a.x + distance * (a.y + distance * a.z), 1e-20));
    let within = select(0.0, share, distance <= light.range);
    return select(1.0, within, light.center.w > 0.0);
}

// Of a spot's cone that a way from the light is in; 1 for other lights.
fn spot_share(way: vec3f) -> f32 {
    let t = saturate((dot(way, light.direction) - light.outer_cos) / max(light.inner_cos - light.outer_cos, 1e-6));
    return select(1.0, t * t * (3.0 - 2.0 * t), light.outer_cos > -1.5);
}

@fragment
fn shade(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    let depth = textureLoad(receiver_depth, pixel, 0);
    if depth == light.eye.background_depth {
        return vec4f(0.0);
    }
    let position = position_eye(light.eye, at.xy, depth);
    let to_light = light.center.xyz - position * light.center.w;
    let distance = length(to_light);
    let l = to_light / max(distance, 1e-20);
    let geometric = unpack_normal(textureLoad(receiver_normal, pixel, 0).x);
    if dot(geometric, l) <= 0.0 {
        return vec4f(0.0);
    }
    let attenuation = falloff(distance) * spot_share(-l);
    // No shadow falls on what does not receive.
    let shading = textureLoad(surface_shading, pixel, 0);
    let visibility = select(1.0, textureLoad(visibility_texture, pixel, 0).x, shading.w > 0.0);
    let color = textureLoad(surface_color, pixel, 0);
    let n = shading.xyz;
    let diffuse = max(dot(n, l), 0.0);
    let mirrored = 2.0 * dot(n, l) * n - l;
    let toward_eye = max(dot(mirrored, -normalize(line_of_sight(light.eye, at.xy))), 0.0);
    let specular = select(0.0, color.w * pow(toward_eye, abs(shading.w)), diffuse > 0.0 && color.w > 0.0);
    return vec4f(attenuation * visibility * light.color * (color.rgb * diffuse + specular), 0.0);
}
