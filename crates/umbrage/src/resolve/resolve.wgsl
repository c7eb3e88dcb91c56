// needs: fullscreen
// Depth and normals of one sample a pixel, out of a part of a host's buffers.

struct Resolving {
    // Upper left corner of the part, and its pixels across and down.
    corner: vec2i,
    size: vec2i,
    // Pixels of the host's buffer for each of ours.
    scale: vec2f,
    // Where in its pixel the sample lies that is read, from the middle.
    sample: vec2f,
    // Of the projection: what the distance along the view is multiplied by for z and for w, and
    // what is added to them.
    z_and_w: vec2f,
    z_and_w_at_eye: vec2f,
    // Depth where nothing was drawn.
    background: f32,
    pad_a: f32,
    pad_b: f32,
    pad_c: f32,
}

@group(0) @binding(0) var<uniform> resolving: Resolving;
// One sample a pixel: this format has no more.
@group(0) @binding(2) var normal_of_host: texture_2d<u32>;

// True where pixels are read elsewhere than in their middle.
override IS_OFF_CENTER: bool = false;

const NOTHING: f32 = 3e38;

fn depth_at(at: vec2i) -> f32 {
    return depth_of(host_depth(resolving.corner + at));
}

// Depth less that of `here`; `NOTHING` where no surface is known.
fn rise(at: vec2i, here: f32) -> f32 {
    if any(at < vec2i(0)) || any(at >= resolving.size) {
        return NOTHING;
    }
    let depth = depth_at(at);
    return select(depth - here, NOTHING, depth == resolving.background);
}

// Change of depth from one pixel to the next on the surface of `here`: towards the neighbour whose
// depth is nearer, since the other one may be across an edge. Depth is linear over a plane.
fn slope(at: vec2i, here: f32, step: vec2i) -> f32 {
    let after = rise(at + step, here);
    let before = rise(at - step, here);
    let nearer = select(-before, after, abs(after) < abs(before));
    return select(nearer, 0.0, abs(nearer) >= NOTHING);
}

struct Read {
    at: vec2i,
    depth: f32,
}

// The pixel that is read for one of ours, and its depth continued to our pixel's middle.
fn read(position: vec2f) -> Read {
    let middle = position * resolving.scale;
    let at = clamp(vec2i(ceil(middle)) - 1, vec2i(0), resolving.size - 1);
    let here = depth_at(at);
    if !IS_OFF_CENTER || here == resolving.background {
        return Read(at, here);
    }
    let off = vec2f(at) + 0.5 + resolving.sample - middle;
    let moved = here - off.x * slope(at, here, vec2i(1, 0)) - off.y * slope(at, here, vec2i(0, 1));
    return Read(at, select(here, moved, moved > 0.0 && moved < 1.0));
}

@fragment
fn resolve_depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return read(position.xy).depth;
}

struct Resolved {
    @builtin(frag_depth) depth: f32,
    @location(0) normal: u32,
}

@fragment
fn resolve_depth_and_normal(@builtin(position) position: vec4f) -> Resolved {
    let found = read(position.xy);
    return Resolved(found.depth, textureLoad(normal_of_host, resolving.corner + found.at, 0).x);
}
