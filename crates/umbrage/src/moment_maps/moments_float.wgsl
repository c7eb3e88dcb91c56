// Moments in textures of floats, as they are.

alias MomentTexture = texture_2d<f32>;
alias MomentArray = texture_2d_array<f32>;
alias StoredMoments = vec4f;

fn to_stored(m: vec4f) -> StoredMoments {
    return m;
}

fn from_stored(stored: StoredMoments) -> vec4f {
    return stored;
}
