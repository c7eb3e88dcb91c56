// needs: plane_shadow
// Marks where shadows fall on a plane, in the stencil alone.

@fragment
fn whole() -> @location(0) f32 {
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
fn cut_out(in: Projected) -> @location(0) f32 {
    if is_below(in) || is_hole(in) {
        discard;
    }
    return 0.0;
}
