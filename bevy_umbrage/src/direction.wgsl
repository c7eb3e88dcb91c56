
/// From the octahedral map of directions that Bevy's G-buffer has, each coordinate in 0…1.
fn direction(folded: vec2f) -> vec3f {
    let f = folded * 2.0 - 1.0;
    let z = 1.0 - abs(f.x) - abs(f.y);
    let t = saturate(-z);
    return normalize(vec3f(f + select(vec2f(t), vec2f(-t), f >= vec2f(0.0)), z));
}
