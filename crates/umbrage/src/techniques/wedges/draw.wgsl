// Adds up how much of the light is covered: hard shadows by the sides of volumes, then what every edge's wedge adds to them.

@group(1) @binding(0) var<uniform> light: WedgeLight;
@group(1) @binding(1) var<uniform> eye: Eye;
@group(1) @binding(2) var<storage, read> wedges: array<Wedge>;

const GROUP: u32 = 64u;

// Off the screen, so that the triangle is dropped.
const NOWHERE: vec4f = vec4f(2.0, 2.0, 0.0, 1.0);

// In light space.
fn receiver(pixel: vec2f, depth: f32) -> vec3f {
    return to_light(light, position_eye(eye, pixel, depth));
}

// Whether a point is on the shadow's side of the plane through light and edge. Hard shadow and wedge both go by this, so that they agree
// to the last bit; what rounding can't tell is where the eye is.
fn is_inside(p: vec3f, plane: vec4f, eye_inside: f32) -> bool {
    let height = dot(plane.xyz, p) - plane.w;
    let least = light.rounding * (abs(p.x) + abs(p.y) + abs(p.z));
    return select(height >= 0.0, eye_inside != 0.0, abs(height) < least);
}

struct Side {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) plane: vec4f,
    @location(1) @interpolate(flat) weights: vec2f,
}

// Corner 0…3 of a quad: end, start, start's shadow, end's shadow, counter-clockwise seen from outside of the shadow. It has no depth: whether it is in front of what is seen the
// fragment shader finds.
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
    let is_start = corner == 1u || corner == 2u;
    let p = select(wedges[number].eye_end, wedges[number].eye_start, is_start);
    let away = from_light(light, -way_to_light(light, select(wedges[number].end, wedges[number].start, is_start)));
    let at = light.clip_from_eye * select(vec4f(p, 1.0), run(p, away, wedges[number].dark), corner >= 2u);
    out.position = vec4f(at.xy, 0.5 * at.w, at.w);
    return out;
}

// On which side the eye is goes by the rasteriser, which decides what a quad that is seen edge-on covers.
@fragment
fn add_side(in: Side, @builtin(front_facing) from_outside: bool) -> @location(0) vec2f {
    let depth = textureLoad(receiver_depth, vec2i(in.position.xy), 0);
    if depth == eye.background_depth {
        discard;
    }
    let eye_inside = f32(!from_outside);
    let inside = is_inside(receiver(in.position.xy, depth), in.plane, eye_inside);
    return in.weights * (f32(inside) - eye_inside);
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
}

// Depth is clamped at the far plane, not clipped.
override CLAMPS: bool = true;

// Of the faces of wedges those are drawn that face away, which the eye sees each once wherever it is.
@vertex
fn body(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Body {
    let number = group * GROUP + vertex / 6u;
    var out: Body;
    out.position = wedges[number].corners[vertex % 6u];
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

@fragment
fn add_wedge(in: Body) -> @location(0) vec2f {
    let depth = textureLoad(receiver_depth, vec2i(in.position.xy), 0);
    if depth == eye.background_depth {
        discard;
    }
    let p = receiver(in.position.xy, depth);
    if !is_in_body(in, p) {
        discard;
    }
    let inside = is_inside(p, in.plane, in.eye_inside);
    return share_of_edge(light, p, in.start.xyz, in.end.xyz, inside) * vec2f(in.start.w, in.end.w);
}
