// needs: receivers, area_light, coverage, cell, record
// Adds up how much of the light is covered: hard shadows by the sides of volumes, then what every
// edge's wedge adds to them.

@group(1) @binding(0) var<uniform> light: AreaLight;
@group(1) @binding(1) var<uniform> eye: Eye;
@group(1) @binding(2) var<storage, read> wedges: array<Wedge>;
@group(1) @binding(3) var<storage, read> caps: array<Cap>;
@group(1) @binding(4) var<storage, read> bundles: array<Bundle>;
// How many single wedges and how many bundles there are; then the numbers of the single ones.
@group(1) @binding(5) var<storage, read> singles: array<u32>;

const GROUP: u32 = 64u;

// Off the screen, so that the triangle is dropped.
const NOWHERE: vec4f = vec4f(4.0, 4.0, 0.0, 1.0);

fn depth_at(pixel: vec2f) -> f32 {
    return textureLoad(receiver_depth, vec2i(pixel), 0);
}

// Whether a point, relative to the eye, is on the shadow's side of the plane through light and
// edge. Hard shadow and wedge both go by this, so that they agree to the last bit; what rounding
// can't tell is where the eye is.
fn is_inside(p: vec3f, plane: vec4f, eye_inside: f32) -> bool {
    return is_inside_within(p, plane, eye_inside, 0.0);
}

// The same where the point is off by so much more.
fn is_inside_within(p: vec3f, plane: vec4f, eye_inside: f32, off: f32) -> bool {
    let height = dot(plane.xyz, p) - plane.w;
    let least = light.rounding * (abs(p.x) + abs(p.y) + abs(p.z)) + off;
    return select(height >= 0.0, eye_inside != 0.0, abs(height) < least);
}

struct Side {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) plane: vec4f,
    @location(1) @interpolate(flat) weights: vec2f,
    @location(2) @interpolate(flat) from_infinity: f32,
}

// Corner 0…3 of a quad: end, start, start's shadow, end's shadow, counter-clockwise seen from
// outside of the shadow. It has no depth: whether it is in front of what is seen the fragment
// shader finds.
@vertex
fn side(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Side {
    let number = group * GROUP + vertex / 4u;
    let corner = vertex % 4u;
    var out: Side;
    out.weights = wedges[number].weights;
    out.position = NOWHERE;
    if all(out.weights == vec2f(0.0)) {
        return out;
    }
    out.plane = wedges[number].plane;
    out.from_infinity = wedges[number].from_infinity;
    let is_start = corner == 1u || corner == 2u;
    let p = select(wedges[number].eye_end, wedges[number].eye_start, is_start);
    let from_here = select(wedges[number].end, wedges[number].start, is_start);
    let away = from_light(light, -way_to(light, wedges[number].anchor.place, from_here));
    let at = light.clip_from_eye * select(vec4f(p, 1.0), run(p, away, wedges[number].dark), corner >= 2u);
    out.position = vec4f(at.xy, 0.5 * at.w, at.w);
    return out;
}

// On which side the eye is goes by the rasteriser, which decides what a quad that is seen edge-on
// covers.
fn shadows_of_side(in: Side, from_outside: bool) -> vec2f {
    let pixel = full_pixel(light, in.position.xy);
    let depth = depth_at(pixel);
    if depth == eye.background_depth {
        return vec2f(0.0);
    }
    let eye_inside = f32(!from_outside);
    let inside = is_inside(position_eye(eye, pixel, depth), in.plane, eye_inside);
    // The other end of the line of sight is on the other side.
    return in.weights * (f32(inside) - select(eye_inside, 1.0 - eye_inside, in.from_infinity != 0.0));
}

@fragment
fn add_side(in: Side, @builtin(front_facing) from_outside: bool) -> @location(0) vec2f {
    return shadows_of_side(in, from_outside);
}

struct CapCorner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) plane: vec4f,
    @location(1) @interpolate(flat) weights: vec2f,
    // Where the shadow starts, and not where it ends.
    @location(2) @interpolate(flat) is_lit: f32,
    @location(3) @interpolate(flat) off: f32,
}

// Corner by corner; caps in the light, then in the dark. Without a depth, as sides, so that the
// near plane cuts nothing off.
@vertex
fn cap(@builtin(vertex_index) vertex: u32, @builtin(instance_index) end: u32) -> CapCorner {
    let number = vertex / 3u;
    var out: CapCorner;
    out.weights = caps[number].weights;
    out.position = NOWHERE;
    if all(out.weights == vec2f(0.0)) {
        return out;
    }
    out.plane = caps[number].plane;
    out.is_lit = f32(end == 0u);
    out.off = caps[number].off;
    var at = caps[number].lit[vertex % 3u];
    if end == 1u {
        at = caps[number].dark[vertex % 3u];
    }
    at = light.clip_from_eye * at;
    out.position = vec4f(at.xy, 0.5 * at.w, at.w);
    return out;
}

// Lines of sight leave the shadow through its dark end, going the light's way, and enter where it
// is no farther than the surface. The surface itself, where it is what is seen, is in front of its
// shadow on one side and behind it on the other.
@fragment
fn add_cap(in: CapCorner, @builtin(front_facing) from_outside: bool) -> @location(0) vec2f {
    let pixel = full_pixel(light, in.position.xy);
    let depth = depth_at(pixel);
    if depth == eye.background_depth {
        return vec2f(0.0);
    }
    if in.is_lit == 0.0 {
        return select(-in.weights, in.weights, from_outside);
    }
    let eye_inside = f32(!from_outside);
    let p = position_eye(eye, pixel, depth);
    let inverse_w = 1.0 / eye_w(eye, ndc_of(eye, pixel, depth));
    let off = in.off + position_rounding(eye, depth, inverse_w) + off_any_surface(eye, inverse_w);
    let inside = is_inside_within(p, in.plane, eye_inside, off);
    return in.weights * (f32(inside) - (1.0 - eye_inside));
}

struct Body {
    @builtin(position) position: vec4f,
    // With a weight each.
    @location(0) @interpolate(flat) start: vec4f,
    @location(1) @interpolate(flat) end: vec4f,
    @location(2) @interpolate(flat) plane: vec4f,
    @location(3) @interpolate(flat) front: vec4f,
    @location(4) @interpolate(flat) back: vec4f,
    @location(5) @interpolate(flat) low: vec4f,
    @location(6) @interpolate(flat) high: vec4f,
    @location(7) @interpolate(flat) eye_inside: f32,
    @location(8) @interpolate(flat) number: u32,
}

// Depth is clamped at the far plane, not clipped.
override CLAMPS: bool = true;

// Of the faces of wedges those are drawn that face away, which the eye sees each once wherever it
// is.
@vertex
fn body(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Body {
    let number = group * GROUP + vertex / 6u;
    return body_at(number, wedges[number].corners[vertex % 6u]);
}

// The same of a wedge that is in no bundle.
@vertex
fn single_body(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Body {
    let at = group * GROUP + vertex / 6u;
    if at >= singles[0] {
        var out: Body;
        out.position = NOWHERE;
        return out;
    }
    let number = singles[2u + at];
    return body_at(number, wedges[number].corners[vertex % 6u]);
}

fn body_at(number: u32, corner: vec4f) -> Body {
    var out: Body;
    out.position = corner;
    out.number = number;
    if !CLAMPS {
        out.position.z = 0.5 * out.position.w;
    }
    out.start = vec4f(wedges[number].start, wedges[number].weights.x);
    out.end = vec4f(wedges[number].end, wedges[number].weights.y);
    out.plane = wedges[number].plane;
    out.front = wedges[number].planes[0];
    out.back = wedges[number].planes[1];
    out.low = wedges[number].planes[2];
    out.high = wedges[number].planes[3];
    out.eye_inside = wedges[number].eye_inside;
    return out;
}

fn is_in_body(in: Body, p: vec3f) -> bool {
    let depths = vec4f(dot(in.front.xyz, p), dot(in.back.xyz, p), dot(in.low.xyz, p), dot(in.high.xyz, p));
    return all(depths >= vec4f(in.front.w, in.back.w, in.low.w, in.high.w));
}

struct Met {
    // In light space.
    p: vec3f,
    inside: bool,
    hit: bool,
}

// What is seen behind a fragment of a body, and whether it is in the body.
fn met(in: Body) -> Met {
    let pixel = full_pixel(light, in.position.xy);
    let depth = depth_at(pixel);
    let seen = position_eye(eye, pixel, depth);
    let p = to_light(light, seen);
    let hit = depth != eye.background_depth && is_in_body(in, p);
    return Met(p, is_inside(seen, in.plane, in.eye_inside), hit);
}

fn share(in: Body, at: Met) -> f32 {
    if SPLIT {
        return share_of_piece(light, at.p, in.start.xyz, in.end.xyz, wedges[in.number].anchor, at.inside);
    }
    return share_of_edge(light, at.p, in.start.xyz, in.end.xyz, at.inside);
}

// Away from the body an edge crosses no light, so only the dear shares of pieces ask first.
@fragment
fn add_wedge(in: Body) -> @location(0) vec2f {
    let pixel = full_pixel(light, in.position.xy);
    let depth = depth_at(pixel);
    let seen = position_eye(eye, pixel, depth);
    let p = to_light(light, seen);
    if depth == eye.background_depth || (SPLIT && !is_in_body(in, p)) {
        discard;
    }
    let at = Met(p, is_inside(seen, in.plane, in.eye_inside), true);
    return share(in, at) * vec2f(in.start.w, in.end.w);
}

// Wedges of a bundle, side by side. What a wedge is, see `Body`.
struct Bundled {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) start_a: vec4f,
    @location(1) @interpolate(flat) start_b: vec4f,
    @location(2) @interpolate(flat) start_c: vec4f,
    @location(3) @interpolate(flat) start_d: vec4f,
    @location(4) @interpolate(flat) end_a: vec4f,
    @location(5) @interpolate(flat) end_b: vec4f,
    @location(6) @interpolate(flat) end_c: vec4f,
    @location(7) @interpolate(flat) end_d: vec4f,
    @location(8) @interpolate(flat) plane_a: vec4f,
    @location(9) @interpolate(flat) plane_b: vec4f,
    @location(10) @interpolate(flat) plane_c: vec4f,
    @location(11) @interpolate(flat) plane_d: vec4f,
    @location(12) @interpolate(flat) eye_inside: vec4f,
}

@vertex
fn bundle_body(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Bundled {
    let number = group * GROUP + vertex / 6u;
    var out: Bundled;
    out.position = NOWHERE;
    if number >= singles[1] {
        return out;
    }
    out.position = bundles[number].corners[vertex % 6u];
    if !CLAMPS {
        out.position.z = 0.5 * out.position.w;
    }
    let members = bundles[number].members;
    out.start_a = start_and_weight(members.x);
    out.start_b = start_and_weight(members.y);
    out.start_c = start_and_weight(members.z);
    out.start_d = start_and_weight(members.w);
    out.end_a = end_and_weight(members.x);
    out.end_b = end_and_weight(members.y);
    out.end_c = end_and_weight(members.z);
    out.end_d = end_and_weight(members.w);
    out.plane_a = wedges[members.x].plane;
    out.plane_b = wedges[members.y].plane;
    out.plane_c = wedges[members.z].plane;
    out.plane_d = wedges[members.w].plane;
    out.eye_inside = vec4f(
        wedges[members.x].eye_inside,
        wedges[members.y].eye_inside,
        wedges[members.z].eye_inside,
        wedges[members.w].eye_inside,
    );
    return out;
}

fn start_and_weight(number: u32) -> vec4f {
    return vec4f(wedges[number].start, wedges[number].weights.x);
}

fn end_and_weight(number: u32) -> vec4f {
    return vec4f(wedges[number].end, wedges[number].weights.y);
}

@fragment
fn add_bundle(in: Bundled) -> @location(0) vec2f {
    let pixel = full_pixel(light, in.position.xy);
    let depth = depth_at(pixel);
    if depth == eye.background_depth {
        discard;
    }
    let seen = position_eye(eye, pixel, depth);
    let p = to_light(light, seen);
    return added(in.start_a, in.end_a, p, is_inside(seen, in.plane_a, in.eye_inside.x))
        + added(in.start_b, in.end_b, p, is_inside(seen, in.plane_b, in.eye_inside.y))
        + added(in.start_c, in.end_c, p, is_inside(seen, in.plane_c, in.eye_inside.z))
        + added(in.start_d, in.end_d, p, is_inside(seen, in.plane_d, in.eye_inside.w));
}

fn added(start: vec4f, end: vec4f, p: vec3f, inside: bool) -> vec2f {
    return share_of_edge(light, p, start.xyz, end.xyz, inside) * vec2f(start.w, end.w);
}
