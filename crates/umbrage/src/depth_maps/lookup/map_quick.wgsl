// needs: map_visibility, map_decide
// The first phase of a look-up in two: what is quick to decide. The second phase, `visibility`, is
// drawn where this one discards.

@fragment
fn quick_visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let share = quick_share_of_light(pixel_at(at.xy));
    if share < 0.0 {
        discard;
    }
    return share;
}
