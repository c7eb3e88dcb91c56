// needs: moments_mean
// The first four powers of depth, from −1 to 1.

fn moments_of(depth: f32) -> vec4f {
    let z = 2.0 * depth - 1.0;
    let square = z * z;
    return vec4f(z, square, square * z, square * square);
}

// For even steps: combinations that each fill 0 to 1, chosen so that together they lose least
// (Peters and Klein 2015, section 4).
const ROOT: f32 = 1.7320508;

fn packed(m: vec4f) -> vec4f {
    return vec4f(
        0.5 + 1.5 * m.x - 2.0 * m.z,
        4.0 * (m.y - m.w),
        0.5 + ROOT * (0.5 * m.x - 2.0 / 9.0 * m.z),
        0.5 * (m.y + m.w),
    );
}

fn unpacked(stored: vec4f) -> vec4f {
    let a = stored.x - 0.5;
    let c = ROOT * (stored.z - 0.5);
    let b = 0.125 * stored.y;
    return vec4f(c - a / 3.0, stored.w + b, 0.75 * (c - a), stored.w - b);
}
