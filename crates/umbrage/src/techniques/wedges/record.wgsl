// A silhouette edge and its wedge.

struct Wedge {
    // Its ends relative to the eye.
    eye_start: vec3f,
    // 1 where the eye is on the side of the edge's hard shadow, else 0.
    eye_inside: f32,
    eye_end: vec3f,
    pad_end: f32,
    // In light space.
    start: vec3f,
    // 1 where the hard shadow is counted from infinity, 0 where from the eye.
    from_infinity: f32,
    end: vec3f,
    pad_c: f32,
    // The plane n · p = w through edge and light, n towards the side of the shadow, relative to the
    // eye.
    plane: vec4f,
    // How often it counts: among the sides of bodies that face the light and among those that face
    // away. Sheets and closed bodies count on both.
    weights: vec2f,
    pad_d: vec2f,
    // Where the hard shadow may end since nothing that is seen lies beyond, n · p = w relative to
    // the eye; n = 0: nowhere.
    dark: vec4f,
    // Inside is n · p ≥ w, in light space.
    planes: array<vec4f, 4>,
    // Corners in clip space: the near ones, then for each of them those of the front and the back
    // face.
    corners: array<vec4f, 6>,
    anchor: Anchor,
}

// Wedges in one bundle, which are drawn as one.
const BUNDLE: u32 = 4u;

struct Bundle {
    // Of the body around them all, as those of a wedge.
    corners: array<vec4f, 6>,
    // Its wedges.
    members: vec4u,
}

// A triangle of a caster that is counted from infinity.
struct Cap {
    // Corners relative to the eye, counter-clockwise seen from the light, and their shadows,
    // homogeneous.
    lit: array<vec4f, 3>,
    dark: array<vec4f, 3>,
    // Its plane n · p = w relative to the eye, n away from the light.
    plane: vec4f,
    // As those of a wedge; 0 if it casts no shadow.
    weights: vec2f,
    // How far rounding moves it, metres.
    off: f32,
}

// Where a ray ends, homogeneous: at a plane or infinitely far away.
fn run(start: vec3f, way: vec3f, end: vec4f) -> vec4f {
    let speed = dot(end.xyz, way);
    if speed <= 0.0 {
        return vec4f(way, 0.0);
    }
    return vec4f(start + way * max((end.w - dot(end.xyz, start)) / speed, 0.0), 1.0);
}
