// needs: plane_shadow
// Marks where shadows fall on a plane, in the stencil alone; or takes the light from the plane's
// pixels at once.

@group(0) @binding(1) var receiver_depth: texture_depth_2d;

// Whether a pixel shows the plane: as `is_in_plane` has it, where places alone tell. Nothing was
// drawn where depth is 0.
fn is_on_plane(in: Projected) -> bool {
    let depth = textureLoad(receiver_depth, vec2i(in.position.xy), 0);
    let shown = vec4f(in.position.xy, depth, 1.0);
    let w = abs(dot(shadow.eye_w, shown));
    let rounded = shadow.rounding * (w + depth * abs(shadow.eye_w.z));
    let off = rounded + (shadow.least * w + shadow.snapped) * w;
    return depth != 0.0 && abs(dot(shadow.off_plane, shown)) * w <= off;
}

@fragment
fn whole() -> @location(0) f32 {
    return 0.0;
}

@fragment
fn whole_at_once(in: Projected) -> @location(0) f32 {
    if !is_on_plane(in) {
        discard;
    }
    return 0.0;
}

@fragment
fn above(in: Projected) -> @location(0) f32 {
    if is_below(in) {
        discard;
    }
    return 0.0;
}

@fragment
fn above_at_once(in: Projected) -> @location(0) f32 {
    if is_below(in) || !is_on_plane(in) {
        discard;
    }
    return 0.0;
}

@fragment
fn cut_out(in: Projected) -> @location(0) f32 {
    if is_below(in) || is_hole(in) {
        discard;
    }
    return 0.0;
}

@fragment
fn cut_out_at_once(in: Projected) -> @location(0) f32 {
    if is_below(in) || is_hole(in) || !is_on_plane(in) {
        discard;
    }
    return 0.0;
}
