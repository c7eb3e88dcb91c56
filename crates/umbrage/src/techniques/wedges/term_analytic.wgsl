fn term(c: Chord) -> f32 {
    if light.face >= RECT {
        return on_square(c);
    }
    return on_disc(c);
}
