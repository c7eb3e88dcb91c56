// needs: resolve, term_analytic
// Of the square between −1 and 1 the share where x a + y b + c < 0.
fn beyond_on_square(line: vec3f) -> f32 {
    // Relative to the largest, so that no product is too small to be divided by.
    let size = abs(line) / max(max(abs(line.x), abs(line.y)), max(abs(line.z), 1e-30));
    let a = max(max(size.x, size.y), 1e-6);
    let b = max(min(size.x, size.y), 1e-4 * a);
    let c = size.z;
    let one = max(a + b - c, 0.0);
    let other = max(a - b - c, 0.0);
    let share = (one * one - other * other) / (8.0 * a * b);
    return select(1.0 - share, share, line.z >= 0.0);
}
