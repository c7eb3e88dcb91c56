// From covered shares to visibility.

@group(1) @binding(0) var<uniform> light: WedgeLight;
@group(1) @binding(1) var<uniform> eye: Eye;
@group(1) @binding(2) var covered: texture_2d<f32>;
// How many shadows the eye is in.
@group(1) @binding(3) var<storage, read> eye_count: vec2u;

// The share of the light that is below the surface's own plane, as the edge of an endless half plane covers it.
fn below_horizon(p: vec3f, normal: vec3f) -> f32 {
    let to_light = select(light.center.xyz - p, light.center.xyz, light.parallel != 0u);
    let n = normalize(normal);
    let height = dot(n, to_light);
    // The horizon where it is nearest to the light.
    let ahead = to_light - n * height;
    let aside = cross(n, to_light) * 1e3;
    let seen = light_from(light, p);
    let c = chord(light.face >= RECT, on_face(seen, ahead - aside), on_face(seen, ahead + aside), true, false);
    if c.side == 0.0 {
        return select(1.0, 0.0, height >= 0.0);
    }
    // Of one sign, whichever way the edge runs, since only the centre's side is missing.
    let share = abs(term(Chord(c.start, c.end, sign(cross2(c.start, c.end)))));
    return select(1.0 - share, share, height >= 0.0);
}

@fragment
fn resolve(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == eye.background_depth {
        return 1.0;
    }
    // Both sides of a body cover the same, but for holes.
    let sides = vec2f(eye_count) + textureLoad(covered, vec2i(at.xy), 0).xy;
    var share = max(sides.x, sides.y);
    let surface = surface(eye, at.xy, depth);
    if surface.casts && share < 1.0 && SOFT {
        share = max(share, below_horizon(position_eye(eye, at.xy, depth), surface.normal));
    }
    return 1.0 - clamp(share, 0.0, 1.0);
}

override SOFT: bool = true;
