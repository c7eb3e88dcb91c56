// needs: plane_shadow
// Draws casters into the texture of a plane: the height h of the lowest one as h / (1 − h / H), H
// that of the light, over the largest such number. A light of half axis e has a penumbra of half
// width e / H times that.

// What is not in shadow.
const LIT: f32 = 2.0;

fn reach(in: Projected) -> f32 {
    let share = max(1.0 - shadow.inverse_height * in.height, LEVEL);
    let ratio = min(in.height / (share * shadow.highest), 1.0);
    return select(max(ratio, 0.0), LIT, is_below(in));
}

@fragment
fn low(in: Projected) -> @location(0) f32 {
    return reach(in);
}

@fragment
fn low_cut_out(in: Projected) -> @location(0) f32 {
    return select(reach(in), LIT, is_hole(in));
}
