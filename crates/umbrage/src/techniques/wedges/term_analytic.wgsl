// needs: coverage
fn disc_term(c: Across, inside: bool) -> f32 {
    return disc_analytic(c, inside);
}

fn square_term(c: Chord, inside: bool) -> f32 {
    return on_square(c, inside);
}
