// needs: draw, term_analytic
// Fragments of bodies for pictures of wedges. They share the bodies of `draw.wgsl`.

// Fronts in the first channel, backs in the second.
@fragment
fn tint(@builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return select(vec4f(0.0, 1.0, 0.0, 0.0), vec4f(1.0, 0.0, 0.0, 0.0), is_front);
}

@fragment
fn line() -> @location(0) vec4f {
    return vec4f(1.0, 0.0, 0.0, 0.0);
}

// Wedges that the point is in.
@fragment
fn count(in: Body) -> @location(0) vec2f {
    return vec2f(f32(met(in).hit), 0.0);
}

@fragment
fn fragment() -> @location(0) vec2f {
    return vec2f(1.0, 0.0);
}

// Edges that cross the light, with the point on the side of the shadow and on the other one.
@fragment
fn crossing(in: Body) -> @location(0) vec2f {
    let at = met(in);
    if !at.hit {
        discard;
    }
    let crosses = share_of_edge(light, at.p, in.start.xyz, in.end.xyz, at.inside) != 0.0;
    // On which side the shadow is goes by the sign of how often it counts.
    let is_dark = at.inside == (in.start.w + in.end.w > 0.0);
    return f32(crosses) * vec2f(f32(is_dark), f32(!is_dark));
}
