// Radiance to display: unchanged up to 0.8, then rolled off to 1, so that shadows are seen as they
// were computed.

// Whether the target holds sRGB values that the GPU does not encode by itself.
override ENCODES: bool = false;

const SHOULDER: f32 = 0.8;

fn srgb_encoded(linear: vec3f) -> vec3f {
    return select(12.92 * linear, 1.055 * pow(linear, vec3f(1.0 / 2.4)) - 0.055, linear > vec3f(0.0031308));
}

// `radiance.a` says how much of the pixel was drawn; `height` is where the pixel is, from 0 at the
// top to 1.
fn displayed(radiance: vec4f, height: f32) -> vec4f {
    // Where nothing was drawn: a quiet grey, a little lighter towards the top.
    let sky = mix(vec3f(0.08, 0.09, 0.11), vec3f(0.03, 0.034, 0.042), height);
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
