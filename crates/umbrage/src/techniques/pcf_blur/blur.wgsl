// A Gaussian along rows or columns (ZA 3.3), two by two pixels at a time: `fn quad_at(quad: vec2i) -> vec4u` gives those of a quad as words in
// the order of `quad_pixels`, so that the axis runs from the first to the second and from the third to the fourth.
//
// A word is a visibility in its low 8 bits, on top of that the distance of the depth from that of the background, and as its sign
// whether the surface faces away from the light.

@group(1) @binding(0) var<uniform> blur: Blur;
@group(1) @binding(1) var<storage, read> list: TileList;

// Two standard deviations, pixels.
override RADIUS: f32 = 4.0;
// Only what lies on the surface of the pixel counts.
override DEPTH_AWARE: bool = true;

// How far a neighbour may be off the plane of the pixel, as a share of how far away it is.
override OFF_PLANE: f32 = 0.5;

const VALUE: u32 = 0xffu;
const SIGN: u32 = 0x80000000u;

// Four pixels of a quad.
struct Pixels {
    words: vec4u,
    depth: vec4f,
    // Of depth per pixel along the axis: change, and what is still on the surface.
    slope: vec4f,
    tolerance: vec4f,
    // Weighted visibility, and weights.
    sum: vec4f,
    total: vec4f,
}

fn depth_of(words: vec4u) -> vec4f {
    return bitcast<vec4f>(words & vec4u(~(SIGN | VALUE)));
}

fn value_of(words: vec4u) -> vec4f {
    return vec4f(words & vec4u(VALUE));
}

// Depth is linear on a plane. The surface goes on to the side where it changes least.
fn pixels_of(words: vec4u, before: vec4u, after: vec4u) -> Pixels {
    let depth = depth_of(words);
    let back = depth - depth_of(vec4u(before.y, words.x, before.w, words.z));
    let ahead = depth_of(vec4u(words.y, after.x, words.w, after.z)) - depth;
    let slope = select(back, ahead, abs(ahead) < abs(back));
    let off = OFF_PLANE * (blur.pixel_depth.x * depth + blur.pixel_depth.y + abs(slope));
    let rounding = blur.rounding.x * depth + blur.rounding.y;
    return Pixels(words, depth, slope, off + rounding, value_of(words), vec4f(1.0));
}

fn weight(offset: f32) -> f32 {
    return select(0.0, exp2(-2.885390082 * offset * offset / (RADIUS * RADIUS)), abs(offset) <= RADIUS);
}

fn add(pixels: ptr<function, Pixels>, words: vec4u, offset: vec4f, weights: vec4f) {
    let depth = depth_of(words);
    var counts = depth > vec4f(0.0);
    if DEPTH_AWARE {
        let off = depth - (*pixels).depth - (*pixels).slope * offset;
        counts &= abs(off) <= (*pixels).tolerance * abs(offset);
        counts &= ((words ^ (*pixels).words) & vec4u(SIGN)) == vec4u(0u);
    }
    let counted = select(vec4f(0.0), weights, counts);
    (*pixels).sum += counted * value_of(words);
    (*pixels).total += counted;
}

// Adds what a quad so many quads away has.
fn add_quad(pixels: ptr<function, Pixels>, words: vec4u, quads: i32) {
    let offset = f32(2 * quads) - vec4f(0.0, 1.0, 0.0, 1.0);
    let weights = vec3f(weight(f32(2 * quads - 1)), weight(f32(2 * quads)), weight(f32(2 * quads + 1)));
    add(pixels, words.xxzz, offset, weights.yxyx);
    add(pixels, words.yyww, offset + 1.0, weights.zyzy);
}

fn blurred_quad(quad: vec2i, axis: vec2i) -> Pixels {
    let own = quad_at(quad);
    let before = quad_at(quad - axis);
    let after = quad_at(quad + axis);
    var pixels = pixels_of(own, before, after);
    // The other one of the pair.
    add(&pixels, own.yxwz, vec4f(1.0, -1.0, 1.0, -1.0), vec4f(weight(1.0)));
    add_quad(&pixels, before, -1);
    add_quad(&pixels, after, 1);
    for (var i = 2; i <= i32(ceil(0.5 * RADIUS)); i++) {
        add_quad(&pixels, quad_at(quad - i * axis), -i);
        add_quad(&pixels, quad_at(quad + i * axis), i);
    }
    return pixels;
}

fn value(pixels: Pixels) -> vec4f {
    let own = value_of(pixels.words);
    return select(pixels.sum / pixels.total, own, pixels.depth == vec4f(0.0));
}

// Quads that a workgroup blurs.
const QUADS: u32 = 64u;

// The quad that an invocation is for: in which tile, and where in it.
struct Place {
    tile: u32,
    quad: vec2u,
}

fn place_of(group: vec3u, groups: vec3u, index: u32) -> Place {
    let number = (group.y * groups.x + group.x) * QUADS + index;
    let in_tile = number % (BLOCK * BLOCK);
    return Place(number / (BLOCK * BLOCK), vec2u(in_tile % BLOCK, in_tile / BLOCK));
}
