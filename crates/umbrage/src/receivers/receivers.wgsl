// needs: pack_normal, eye
// The visible surfaces: where they are relative to the eye, and which way they face.

@group(0) @binding(0) var receiver_depth: texture_depth_2d;
// Geometric normals as `pack_normal` leaves them.
@group(0) @binding(1) var receiver_normal: texture_2d<u32>;

override HAS_NORMALS: bool = true;

// How far, in metres, a position may be off because the depth buffer rounds: one step of single
// precision (or of 24 bits) around `depth`. Next to nothing for a reversed projection, a millimetre
// and more for others. `inverse_w` is one over the position's w before division.
fn position_rounding(eye: Eye, depth: f32, inverse_w: f32) -> f32 {
    let inverse = abs(inverse_w);
    // A normal taken from neighbouring depths is off by their rounding, too.
    let step = select(9.6e-7, 1.2e-7, HAS_NORMALS) * eye.rounding;
    return step * inverse * (1.0 + depth * abs(eye.eye_from_ndc[2].w) * inverse);
}

// From `here` to the neighbour along `step`, nothing where that is off the picture or shows no
// surface.
fn toward(eye: Eye, pixel: vec2f, here: vec3f, step: vec2i) -> vec3f {
    let size = vec2i(textureDimensions(receiver_depth));
    let at = vec2i(pixel) + step;
    if any(at < vec2i(0)) || any(at >= size) {
        return vec3f(0.0);
    }
    let depth = textureLoad(receiver_depth, at, 0);
    if depth == eye.background_depth {
        return vec3f(0.0);
    }
    return position_eye(eye, vec2f(at) + 0.5, depth) - here;
}

// Change of position along `step` on the surface itself: towards the neighbour that is nearer,
// since the other one may be across an edge.
fn along_surface(eye: Eye, pixel: vec2f, here: vec3f, step: vec2i) -> vec3f {
    let after = toward(eye, pixel, here, step);
    let before = -toward(eye, pixel, here, -step);
    let a = dot(after, after);
    let b = dot(before, before);
    return select(before, after, b == 0.0 || (a > 0.0 && a < b));
}

fn surface(eye: Eye, pixel: vec2f, depth: f32) -> Surface {
    if HAS_NORMALS {
        let bits = textureLoad(receiver_normal, vec2i(pixel), 0).x;
        return Surface(unpack_normal(bits), (bits & 1u) != 0u);
    }
    let here = position_eye(eye, pixel, depth);
    let across = along_surface(eye, pixel, here, vec2i(1, 0));
    let down = along_surface(eye, pixel, here, vec2i(0, 1));
    return Surface(eye.handed * cross(down, across), true);
}
