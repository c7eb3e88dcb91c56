// What one light adds to a picture: Bevy's G-buffer, shaded as Bevy shades it, times the share of
// the light that each pixel sees.
//
// The formulas are those of Bevy's `pbr_lighting.wesl`: Burley 2012 ("Physically-based shading at
// Disney") for diffuse light, GGX (Walter et al. 2007) with the correlated Smith term for
// highlights, a representative point on spheres (Karis 2013, "Real shading in Unreal Engine 4") and
// the clear coat of Filament (Guy and Agopian, "Physically based rendering in Filament").

struct Emitter {
    /// Normalised device coordinates to space relative to the eye.
    eye_from_ndc: mat4x4f,
    /// Relative to the eye; the way to the light where it is directional.
    position: vec3f,
    radius: f32,
    /// Times exposure.
    color: vec3f,
    inverse_square_range: f32,
    /// The way the light of a spot travels.
    axis: vec3f,
    is_directional: u32,
    cone: vec2f,
    ndc_from_pixel: vec2f,
    /// The way to the eye where that is the same everywhere; `w` is 1 then and 0 otherwise.
    to_eye: vec4f,
}

@group(0) @binding(0) var depths: texture_depth_2d;
@group(0) @binding(1) var surfaces: texture_2d<u32>;
@group(0) @binding(2) var passes: texture_2d<u32>;
@group(0) @binding(3) var visibilities: texture_2d<f32>;
@group(0) @binding(4) var<uniform> emitter: Emitter;

const PI = 3.14159265;
/// Flags of a pixel of the G-buffer.
const UNLIT = 1u;
const RECEIVES_SHADOWS = 4u;

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

/// A surface as light sees it.
struct Surface {
    n: vec3f,
    v: vec3f,
    n_v: f32,
    diffuse: vec3f,
    f0: vec3f,
    /// Makes up for light that is scattered more than once.
    gain: vec3f,
    roughness: f32,
    coat: f32,
    coat_roughness: f32,
}

@fragment
fn shade(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let depth = textureLoad(depths, pixel, 0);
    let packed = textureLoad(surfaces, pixel, 0);
    let flags = packed.w >> 24u;
    // Nothing is there, or nothing that deferred lighting is for.
    if depth == 0.0 || textureLoad(passes, pixel, 0).x == 0u || (flags & UNLIT) != 0u {
        return vec4f();
    }
    let visible = textureLoad(visibilities, pixel, 0).x;
    let visibility = select(1.0, visible, (flags & RECEIVES_SHADOWS) != 0u);
    let ndc = position.xy * emitter.ndc_from_pixel + vec2f(-1.0, 1.0);
    let place = emitter.eye_from_ndc * vec4f(ndc, depth, 1.0);
    let p = place.xyz / place.w;
    let surface = unpack(packed, select(normalize(-p), emitter.to_eye.xyz, emitter.to_eye.w == 1.0));
    return vec4f(reflected(surface, p) * emitter.color * visibility, 0.0);
}

fn unpack(packed: vec4u, v: vec3f) -> Surface {
    let base = unpack4x8unorm(packed.x);
    let props = unpack4x8unorm(packed.z);
    let coat = packed.z >> 24u;
    let color = pow(base.rgb, vec3f(2.2));
    let n = direction(vec2f(vec2u(packed.w, packed.w >> 12u) & vec2u(0xfffu)) / 4095.0);
    let n_v = max(dot(n, v), 1e-4);
    let f0 = mix(vec3f(0.16 * props.x * props.x), color, props.y);
    let gain = 1.0 + f0 * (1.0 / both_parts(base.a, n_v) - 1.0);
    return Surface(
        n,
        v,
        n_v,
        color * (1.0 - props.y),
        f0,
        gain,
        squared_roughness(base.a),
        f32(coat & 15u) / 15.0,
        squared_roughness(f32(coat >> 4u) / 30.0),
    );
}

fn squared_roughness(perceptual: f32) -> f32 {
    let clamped = clamp(perceptual, 0.089, 1.0);
    return clamped * clamped;
}

/// Sum of the two parts of what a rough mirror reflects of all directions (Karis 2014, "Physically
/// based shading on mobile").
fn both_parts(perceptual: f32, n_v: f32) -> f32 {
    let r = perceptual * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    let parts = max(vec2f(-1.04, 1.04) * a + r.zw, vec2f(0.00005));
    return parts.x + parts.y;
}

/// The share of the emitter's colour that goes to the eye.
fn reflected(s: Surface, p: vec3f) -> vec3f {
    if emitter.is_directional != 0u {
        return all_lobes(s, emitter.position, Highlight(emitter.position, s.roughness, 1.0),
            Highlight(emitter.position, s.coat_roughness, 1.0));
    }
    let to_light = emitter.position - p;
    let squared = dot(to_light, to_light);
    let share = squared * emitter.inverse_square_range;
    let smooth_end = saturate(1.0 - share * share);
    let l = normalize(to_light);
    let in_cone = saturate(dot(-emitter.axis, l) * emitter.cone.x + emitter.cone.y);
    let strength = smooth_end * smooth_end * in_cone * in_cone / max(squared, 1e-4);
    return strength * all_lobes(s, l, of_sphere(s, to_light, s.roughness), of_sphere(s, to_light, s.coat_roughness));
}

/// A direction to light from, with the roughness and strength that stand for all of a light.
struct Highlight {
    l: vec3f,
    roughness: f32,
    strength: f32,
}

fn of_sphere(s: Surface, to_light: vec3f, roughness: f32) -> Highlight {
    let r = reflect(-s.v, s.n);
    let distance = length(to_light);
    let to_ray = max(1e-4, dot(to_light, r)) * r - to_light;
    let l = normalize(to_light + to_ray * saturate(emitter.radius / max(length(to_ray), 1e-6)));
    let wider = saturate(roughness + emitter.radius / (2.0 * distance));
    let narrow = (1.0 - roughness) * (1.0 - roughness);
    let ratio = roughness / wider;
    let n_l = saturate(dot(s.n, l));
    let above = saturate(n_l / max(n_l + emitter.radius * emitter.radius / (distance * distance), 1e-4));
    let strength = ratio * ratio * select(1.0, above, emitter.radius > 0.0);
    return Highlight(l, mix(roughness, wider, 1.0 - narrow * narrow), strength);
}

/// Diffuse light from `l`, and highlights of the surface and its coat.
fn all_lobes(s: Surface, l: vec3f, own: Highlight, coat: Highlight) -> vec3f {
    let n_l = saturate(dot(s.n, l));
    let diffuse = s.diffuse * burley(s, n_l, saturate(dot(l, normalize(l + s.v))));
    let through = 1.0 - fresnel(0.04, 1.0, saturate(dot(coat.l, normalize(coat.l + s.v)))) * s.coat;
    let below = diffuse * n_l + mirror(s, own) * through;
    return below * through + coated(s, coat) * (1.0 - through);
}

fn burley(s: Surface, n_l: f32, l_h: f32) -> f32 {
    let f90 = 0.5 + 2.0 * s.roughness * l_h * l_h;
    return fresnel(1.0, f90, n_l) * fresnel(1.0, f90, s.n_v) / PI;
}

fn fresnel(f0: f32, f90: f32, cosine: f32) -> f32 {
    return f0 + (f90 - f0) * pow(1.0 - cosine, 5.0);
}

/// The highlight of the surface, times the cosine.
fn mirror(s: Surface, light: Highlight) -> vec3f {
    let h = normalize(light.l + s.v);
    let n_l = saturate(dot(s.n, light.l));
    let l_h = saturate(dot(light.l, h));
    let a2 = light.roughness * light.roughness;
    let smith = n_l * sqrt((s.n_v - a2 * s.n_v) * s.n_v + a2) + s.n_v * sqrt((n_l - a2 * n_l) * n_l + a2);
    let f90 = saturate(dot(s.f0, vec3f(16.5)));
    let f = s.f0 + (f90 - s.f0) * pow(1.0 - l_h, 5.0);
    return light.strength * facets(light.roughness, saturate(dot(s.n, h))) * 0.5 / smith * n_l * f * s.gain;
}

/// The highlight of a clear coat, times the cosine, apart from what it reflects at all.
fn coated(s: Surface, light: Highlight) -> f32 {
    let h = normalize(light.l + s.v);
    let l_h = max(saturate(dot(light.l, h)), 1e-4);
    let n_l = saturate(dot(s.n, light.l));
    return light.strength * facets(light.roughness, saturate(dot(s.n, h))) * 0.25 / (l_h * l_h) * n_l;
}

/// How many of the little mirrors that a surface is made of face a direction.
fn facets(roughness: f32, n_h: f32) -> f32 {
    let a = n_h * roughness;
    let k = roughness / (1.0 - n_h * n_h + a * a);
    return k * k / PI;
}
