// needs: map_visibility, moments_lookup, moments
// Moment shadow maps with four moments (Peters and Klein 2015): the smallest share of shadow that
// fits the moments.

// How much of another distribution is mixed in, against rounding.
override MOMENT_BIAS: f32 = 1e-6;

// Mixed in: half at each end, in all but a quarter.
const FLATTEST: vec4f = vec4f(0.0, 0.375, 0.0, 0.375);

// Own plane: see `README.md`.
const PLANE_BIAS: f32 = 150.0;

// The smallest share of a distribution with these moments that can lie nearer than `z` (Hamburger's
// problem). Among all distributions the one that attains it has three depths: z and the roots of
// the polynomial that is orthogonal to it.
fn smallest_shadow(b: vec4f, z: f32) -> f32 {
    // Hankel matrix (1 b₁ b₂; b₁ b₂ b₃; b₂ b₃ b₄) = L D Lᵀ, solved for (1, z, z²).
    let l32d22 = b.z - b.x * b.y;
    let d22 = max(b.y - b.x * b.x, 1e-12);
    let l32 = l32d22 / d22;
    let d33 = max(b.w - b.y * b.y - l32d22 * l32, 1e-14);
    var c = vec3f(1.0, z, z * z);
    c.y -= b.x;
    c.z -= b.y + l32 * c.y;
    c.y /= d22;
    c.z /= d33;
    c.y -= l32 * c.z;
    c.x -= dot(c.yz, b.xy);
    // Roots of c₁ + c₂ x + c₃ x².
    let p = c.y / c.z;
    let q = c.x / c.z;
    let r = sqrt(max(0.25 * p * p - q, 0.0));
    let low = -0.5 * p - r;
    let high = -0.5 * p + r;
    if z <= low {
        return 0.0;
    }
    if z <= high {
        return (high * z - b.x * (z + high) + b.y) / ((high - low) * (z - low));
    }
    return 1.0 - (low * high - b.x * (low + high) + b.y) / ((z - low) * (z - high));
}

fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
    let level = level_of_pixel(point, pixel);
    let found = moments_between(point.texel, point.layer, level);
    let receiver = linear_point(point, found.offset, CREASE * exp2(level));
    let spread = 4.0 * variance_of(level) * dot(receiver.slope, receiver.slope);
    let bias = clamp(max(MOMENT_BIAS, PLANE_BIAS * spread * spread), 0.0, 0.25);
    let b = mix(found.moments, FLATTEST, bias);
    let shadow = smallest_shadow(b, 2.0 * receiver.depth - 1.0);
    // Not a number where depths are all the same.
    return without_bleeding(1.0 - select(0.0, clamp(shadow, 0.0, 1.0), shadow > 0.0));
}
