// needs: resolve, term_analytic
// Of the square between −1 and 1 the share where x a + y b + c < 0.
fn beyond_on_square(line: vec3f) -> f32 {
    let a = max(max(abs(line.x), abs(line.y)), 1e-30);
    let b = max(min(abs(line.x), abs(line.y)), 1e-4 * a);
    let c = abs(line.z);
    let one = max(a + b - c, 0.0);
    let other = max(a - b - c, 0.0);
    let share = (one * one - other * other) / (8.0 * a * b);
    return select(1.0 - share, share, line.z >= 0.0);
}
