// needs: resolve, term_picture
// Of the picture on the square between −1 and 1 the share where x a + y b + c < 0: the half plane
// is covered by a caster with one long edge, and lies on the left of it.
fn beyond_on_square(line: vec3f) -> f32 {
    let normal = line.xy / max(length(line.xy), 1e-30);
    let foot = normal * (-line.z / max(length(line.xy), 1e-30));
    let along = 4.0 * vec2f(-normal.y, normal.x);
    let covers_center = line.z < 0.0;
    let c = across_square(vec3f(foot - along, 1.0), vec3f(foot + along, 1.0));
    let all = f32(covers_center);
    return select(all, all + square_term(c, covers_center), c.hit);
}
