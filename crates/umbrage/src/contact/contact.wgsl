// needs: fullscreen, receivers
// Contact shadows: rays from visible surfaces to the light, as short as the gap that a bias
// leaves, marched through the depth buffer.

// Points of a light with an extent.
const MOST_POINTS: u32 = 4u;

override STEPS: u32 = 16u;
override POINTS: u32 = 1u;

struct ContactMarch {
    eye: Eye,
    // From positions relative to the eye.
    ndc_from_eye: mat4x4f,
    // Relative to the eye and homogeneous: places, or directions to a light infinitely far away.
    lights: array<vec4f, MOST_POINTS>,
    // Along the camera's view.
    ahead: vec3f,
    // How long rays are: metres, or pixels where the next is 1.
    length: f32,
    length_in_pixels: f32,
    // How far behind what is seen a ray still is in it, likewise.
    thickness: f32,
    thickness_in_pixels: f32,
    pad: f32,
    size: vec2i,
    pad_a: vec2i,
}

@group(1) @binding(0) var<uniform> march: ContactMarch;

// Where rays start.
struct Start {
    place: vec3f,
    normal: vec3f,
    // Metres above the plane of the surface up to which a surface may be the same one.
    same: f32,
    length: f32,
    thickness: f32,
}

// The end of a step along a ray, also in normalised device coordinates, homogeneous; and how deep
// along the view the ray is where the step begins and ends.
struct Step {
    place: vec3f,
    clip: vec4f,
    before: f32,
    after: f32,
}

fn metres_per_pixel(eye: Eye, inverse_w: f32) -> f32 {
    let m = eye.eye_from_ndc;
    let across = length(m[0].xyz) * abs(eye.ndc_from_pixel.x);
    return max(across, length(m[1].xyz) * abs(eye.ndc_from_pixel.y)) * abs(inverse_w);
}

fn start_of(at: vec2f, depth: f32) -> Start {
    let eye = march.eye;
    let ndc = ndc_of(eye, at, depth);
    let inverse_w = 1.0 / eye_w(eye, ndc);
    let place = (eye.eye_from_ndc * ndc).xyz * inverse_w;
    let pixel = metres_per_pixel(eye, inverse_w);
    let normal = surface(eye, at, depth).normal;
    let unit = normal / max(length(normal), 1e-30);
    let reach = march.length * select(1.0, pixel, march.length_in_pixels > 0.5);
    let thickness = march.thickness * select(1.0, pixel, march.thickness_in_pixels > 0.5);
    // Without normals the plane is as far off as the depths of neighbours round.
    let turn = select(reach / max(pixel, 1e-30), 1.0, HAS_NORMALS);
    let same = 2.0 * off_surface(eye, unit, inverse_w) + 4.0 * (1.0 + turn) * position_rounding(eye, depth, inverse_w);
    return Start(place, unit, same, reach, thickness);
}

// A surface that casts shadows, at the pixel that shows the end of the step, is where the step is:
// the ray went behind it, or is no farther behind it than things are thick (McGuire and Mara,
// "Efficient GPU Screen-Space Ray Tracing", 2014, section 3).
fn is_hit(start: Start, step: Step) -> bool {
    let eye = march.eye;
    let pixel = (step.clip.xy / step.clip.w - vec2f(-1.0, 1.0)) / eye.ndc_from_pixel;
    let at = vec2i(clamp(floor(pixel), vec2f(0.0), vec2f(march.size - 1)));
    let depth = textureLoad(receiver_depth, at, 0);
    if depth == eye.background_depth || any(vec2f(at) != floor(pixel)) {
        return false;
    }
    let seen = position_eye(eye, vec2f(at) + 0.5, depth);
    let along = dot(march.ahead, seen);
    let is_within = step.after > along && min(step.before, step.after) < along + start.thickness;
    if !is_within || dot(start.normal, seen - start.place) <= start.same {
        return false;
    }
    // What the pixel shows is beside the ray, by up to half a pixel: its plane is compared.
    let hit = surface(eye, vec2f(at) + 0.5, depth);
    return hit.casts && dot(hit.normal, step.place - seen) < 0.0;
}

// 0 where the ray to a point of the light hits something.
fn is_free(start: Start, light: vec4f) -> f32 {
    let way = light.xyz - start.place * light.w;
    let distance = length(way);
    let toward = way / max(distance, 1e-30);
    if distance == 0.0 || dot(toward, start.normal) <= 0.0 {
        return 1.0;
    }
    let reach = select(start.length, min(start.length, distance), light.w != 0.0);
    var before = dot(march.ahead, start.place);
    for (var i = 1u; i <= STEPS; i++) {
        let place = start.place + toward * (reach * f32(i) / f32(STEPS));
        let after = dot(march.ahead, place);
        let clip = march.ndc_from_eye * vec4f(place, 1.0);
        // No picture shows what is in the plane of the eye or behind it.
        if clip.w <= 0.0 {
            return 1.0;
        }
        if is_hit(start, Step(place, clip, before, after)) {
            return 0.0;
        }
        before = after;
    }
    return 1.0;
}

@fragment
fn contact_shadows(@builtin(position) position: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(position.xy), 0);
    if depth == march.eye.background_depth {
        return 1.0;
    }
    let start = start_of(position.xy, depth);
    var free = 0.0;
    for (var i = 0u; i < POINTS; i++) {
        free += is_free(start, march.lights[i]);
    }
    return free / f32(POINTS);
}
