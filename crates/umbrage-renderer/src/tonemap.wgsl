// needs: fullscreen
// Radiance to display: unchanged up to 0.8, then rolled off to 1, so that shadows are seen as they
// were computed.

@group(0) @binding(0) var radiance_texture: texture_2d<f32>;

// Whether the target holds sRGB values that the GPU does not encode by itself.
override ENCODES: bool = false;

const SHOULDER: f32 = 0.8;

fn srgb_encoded(linear: vec3f) -> vec3f {
    return select(12.92 * linear, 1.055 * pow(linear, vec3f(1.0 / 2.4)) - 0.055, linear > vec3f(0.0031308));
}

@fragment
fn tonemap(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let radiance = textureLoad(radiance_texture, vec2i(at.xy), 0);
    // Where nothing was drawn: a quiet grey, a little lighter towards the top.
    let size = vec2f(textureDimensions(radiance_texture));
    let sky = mix(vec3f(0.08, 0.09, 0.11), vec3f(0.03, 0.034, 0.042), at.y / size.y);
    let color = mix(sky, max(radiance.rgb, vec3f(0.0)), radiance.a);
    // The brightest channel is rolled off and the others follow, which keeps the hue.
    let peak = max(color.r, max(color.g, color.b));
    let room = 1.0 - SHOULDER;
    let over = max(peak - SHOULDER, 0.0);
    let rolled = min(peak, SHOULDER) + room * over / (over + room);
    let shown = color * (rolled / max(peak, 1e-6));
    if ENCODES {
        return vec4f(srgb_encoded(shown), 1.0);
    }
    return vec4f(shown, 1.0);
}
