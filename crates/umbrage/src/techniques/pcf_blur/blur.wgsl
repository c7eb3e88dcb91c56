// needs: receivers, quads
// A Gaussian along rows or columns (ZA 3.3), a quad at a time: `fn values_at(quad: vec2i) -> vec4f`
// gives what is blurred.

// Two standard deviations, pixels.
override RADIUS: f32 = 4.0;
// Only what lies on the surface of the pixel counts.
override DEPTH_AWARE: bool = true;
// Along rows, or along columns.
override ALONG_ROWS: bool = true;

// How far a neighbour may be off the plane of the pixel, as a share of how far away it is.
const OFF_PLANE: f32 = 0.5;

// Pixels, ordered so that the axis goes from the first to the second and from the third to the
// fourth.
struct Quad {
    values: vec4f,
    // Distance from that of the background.
    depth: vec4f,
}

// Of depth per pixel along the axis: change, and what is still on the surface.
struct Plane {
    depth: vec4f,
    slope: vec4f,
    tolerance: vec4f,
}

struct Sum {
    values: vec4f,
    weights: vec4f,
}

fn ordered(of_pixels: vec4f) -> vec4f {
    return select(of_pixels.xzyw, of_pixels, vec4<bool>(ALONG_ROWS));
}

fn quad_at(quad: vec2i, steps: i32) -> Quad {
    let at = quad + select(vec2i(0, steps), vec2i(steps, 0), vec2<bool>(ALONG_ROWS));
    let middle = vec2f(2 * at + 1) / vec2f(textureDimensions(receiver_depth));
    let depth = textureGather(receiver_depth, nearest, middle).wzxy;
    return Quad(ordered(values_at(at)), ordered(abs(depth - blur.background_depth)));
}

// Depth is linear on a plane. The surface continues to the side where it changes least.
fn plane_of(own: Quad, before: Quad, after: Quad) -> Plane {
    let back = own.depth - vec4f(before.depth.y, own.depth.x, before.depth.w, own.depth.z);
    let ahead = vec4f(own.depth.y, after.depth.x, own.depth.w, after.depth.z) - own.depth;
    let slope = select(back, ahead, abs(ahead) < abs(back));
    let off = OFF_PLANE * (blur.pixel_depth.x * own.depth + blur.pixel_depth.y + abs(slope));
    let rounding = blur.rounding.x * own.depth + blur.rounding.y;
    return Plane(own.depth, slope, off + rounding);
}

fn weight(offset: f32) -> f32 {
    return select(0.0, exp2(-2.885390082 * offset * offset / (RADIUS * RADIUS)), abs(offset) <= RADIUS);
}

fn add(sum: ptr<function, Sum>, plane: Plane, other: Quad, offset: vec4f, weights: vec4f) {
    var counts = other.depth > vec4f(0.0);
    if DEPTH_AWARE {
        let off = other.depth - plane.depth - plane.slope * offset;
        counts &= abs(off) <= plane.tolerance * abs(offset);
        counts &= other.values > vec4f(0.0);
    }
    let counted = select(vec4f(0.0), weights, counts);
    (*sum).values += counted * max(other.values, vec4f(1.0));
    (*sum).weights += counted;
}

// Adds what a quad so many quads away has.
fn add_quad(sum: ptr<function, Sum>, plane: Plane, other: Quad, quads: i32) {
    let offset = f32(2 * quads) - vec4f(0.0, 1.0, 0.0, 1.0);
    let weights = vec3f(weight(f32(2 * quads - 1)), weight(f32(2 * quads)), weight(f32(2 * quads + 1)));
    add(sum, plane, Quad(other.values.xxzz, other.depth.xxzz), offset, weights.yxyx);
    add(sum, plane, Quad(other.values.yyww, other.depth.yyww), offset + 1.0, weights.zyzy);
}

fn blurred_quad(quad: vec2i) -> vec4f {
    let own = quad_at(quad, 0);
    let before = quad_at(quad, -1);
    let after = quad_at(quad, 1);
    let plane = plane_of(own, before, after);
    var sum = Sum(max(own.values, vec4f(1.0)), vec4f(1.0));
    // The other one of the pair.
    add(&sum, plane, Quad(own.values.yxwz, own.depth.yxwz), vec4f(1.0, -1.0, 1.0, -1.0), vec4f(weight(1.0)));
    add_quad(&sum, plane, before, -1);
    add_quad(&sum, plane, after, 1);
    for (var i = 2; i <= i32(ceil(0.5 * RADIUS)); i++) {
        add_quad(&sum, plane, quad_at(quad, -i), -i);
        add_quad(&sum, plane, quad_at(quad, i), i);
    }
    let stays = (own.depth == vec4f(0.0)) | ((own.values == vec4f(0.0)) & vec4<bool>(DEPTH_AWARE));
    return ordered(select(sum.values / sum.weights, own.values, stays));
}
