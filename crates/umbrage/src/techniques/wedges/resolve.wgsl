// From covered shares to visibility.

@group(1) @binding(0) var<uniform> light: WedgeLight;
@group(1) @binding(1) var<uniform> eye: Eye;
@group(1) @binding(2) var covered: texture_2d<f32>;
// How many shadows the eye is in, see `Wedge::weights`.
@group(1) @binding(3) var<storage, read> eye_count: vec2u;

override SOFT: bool = true;

// Of a disc of radius 1 the share beyond a line at this distance from its centre.
fn beyond_on_disc(distance: f32) -> f32 {
    let d = clamp(distance, -1.0, 1.0);
    return (acos(d) - d * sqrt(1.0 - d * d)) / PI;
}

// The share of the light that is below the surface's own plane, whose normal is given in light space.
fn below_horizon(p: vec3f, normal: vec3f) -> f32 {
    let way = way_to_light(light, p);
    let height = dot(normal, way);
    if FACE == BALL {
        // Of the face that is perpendicular to the way.
        let aside = dot(normal, normal) - height * height / dot(way, way);
        return beyond_on_disc(height * inverseSqrt(max(aside, 1e-30)));
    }
    if FACE == DISC {
        return beyond_on_disc(height / max(length(normal.xy), 1e-30));
    }
    if FACE == LINE {
        return beyond_on_square(vec3f(normal.x, 0.0, height));
    }
    return beyond_on_square(vec3f(normal.xy, height));
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
    if SOFT {
        let surface = surface(eye, at.xy, depth);
        let n = surface.normal;
        // A plane's normal goes by the inverse transposed.
        let back = light.from_light;
        let normal = vec3f(
            n.x * back[0].x + n.y * back[1].x + n.z * back[2].x,
            n.x * back[0].y + n.y * back[1].y + n.z * back[2].y,
            n.x * back[0].z + n.y * back[1].z + n.z * back[2].z,
        );
        let p = to_light(light, position_eye(eye, at.xy, depth));
        share = max(share, select(0.0, below_horizon(p, normal), surface.casts));
    }
    return 1.0 - clamp(share, 0.0, 1.0);
}
