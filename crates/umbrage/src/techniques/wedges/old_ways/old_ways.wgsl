// Bodies and sides as the papers draw them: marked in the stencil, in halves, loop by loop. After
// `draw.wgsl`.

// Where bodies are cut in two, see `halves.wgsl`.
@group(3) @binding(0) var<storage, read> halves: array<Half>;

struct Half {
    // In clip space, those between the corners of the front and of the back face.
    corners: array<vec4f, 2>,
    // 1 where the front half is on the side of the hard shadow, else 0; 2 where it is all of the
    // body.
    front_inside: f32,
}

// One half of a body, by the instance. They overlap a little, so that no pixel falls between them.
@vertex
fn half_body(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Body {
    let number = vertex / 6u;
    let corner = vertex % 6u;
    // Of the corners that are cut off: 3 and 5 of the front half, 2 and 4 of the back half.
    let is_cut = corner >= 2u && (corner % 2u == 1u) == (instance == 0u);
    let middle = halves[number].corners[select(0u, 1u, corner >= 4u)];
    let own = wedges[number].corners[corner];
    return body_at(number, select(own, mix(middle, own, 0.01), is_cut));
}

// Marks what is in a body.
@fragment
fn mark(in: Body) -> @location(0) vec2f {
    if !met(in).hit {
        discard;
    }
    return vec2f(0.0);
}

// Marks all that is seen through a face.
@fragment
fn mark_all() -> @location(0) vec2f {
    return vec2f(0.0);
}

// Of the half that `half_body` drew, which goes by the sign of the plane: its own side's part.
// Nothing is discarded, since that would leave marks in the stencil.
fn add_half(in: Body, is_front: bool) -> vec2f {
    let at = met(in);
    let front_inside = halves[in.number].front_inside;
    let is_own = front_inside == 2.0 || (at.inside == (front_inside == 1.0)) == is_front;
    return select(vec2f(0.0), share(in, at) * vec2f(in.start.w, in.end.w), at.hit && is_own);
}

@fragment
fn add_front_half(in: Body) -> @location(0) vec2f {
    return add_half(in, true);
}

@fragment
fn add_back_half(in: Body) -> @location(0) vec2f {
    return add_half(in, false);
}

// Of one loop: the sum of what its wedges add, how often the hard shadow's sides count, how many
// wedges have the point outside, and how many there are at all.
@fragment
fn add_side_of_loop(in: Side, @builtin(front_facing) from_outside: bool) -> @location(0) vec4f {
    return vec4f(0.0, shadows_of_side(in, from_outside).x, 0.0, 0.0);
}

@fragment
fn add_wedge_of_loop(in: Body) -> @location(0) vec4f {
    let at = met(in);
    if !at.hit {
        discard;
    }
    let added = share(in, at);
    let counts = f32(added != 0.0);
    return vec4f(added, 0.0, select(counts, 0.0, at.inside), counts);
}
