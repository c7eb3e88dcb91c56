// Moments in 16 bits each: even steps from 0 to 1, finer near 1 than a half float's. Every device
// can draw into integers, and filtering is done by hand anyway. `packed` and `unpacked` of the
// technique make the most of the steps.

alias MomentTexture = texture_2d<u32>;
alias MomentArray = texture_2d_array<u32>;
alias StoredMoments = vec4u;

fn to_stored(m: vec4f) -> StoredMoments {
    return vec4u(round(clamp(packed(m), vec4f(0.0), vec4f(1.0)) * 65535.0));
}

fn from_stored(stored: StoredMoments) -> vec4f {
    return unpacked(vec4f(stored) / 65535.0);
}
