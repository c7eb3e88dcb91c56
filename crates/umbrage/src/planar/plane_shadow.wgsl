// needs: casters, materials, many
// Casters projected through the light on a plane.

struct PlaneShadow {
    // From points relative to the eye.
    clip_from_eye: mat4x4f,
    // Unit normal on the light's side and offset, relative to the eye.
    plane: vec4f,
    // The light relative to the eye over its height above the plane, and one over that height; for
    // parallel light the direction to it over the sine of its angle, and 0.
    light: vec3f,
    inverse_height: f32,
    // Relative to the scene's origin.
    eye: vec3f,
    // Clip coordinates have at least this w where something is seen.
    nearest: f32,
    // What is no higher than this lies in the plane.
    least: f32,
    // Of all casters, h / (1 − h / H) is at most this, h their height and H the light's.
    highest: f32,
    // What the depth buffer rounds, and what rasterisers shift surfaces, see `plane_finder.wgsl`.
    rounding: f32,
    snapped: f32,
    // The distance of what a pixel shows from the plane, and its w; both times w, from the pixel
    // and its depth.
    off_plane: vec4f,
    eye_w: vec4f,
}

@group(0) @binding(0) var<uniform> shadow: PlaneShadow;

// What is nearer to the light's level than this share of its height casts no shadow: it would fall
// ten thousand times as far away.
const LEVEL: f32 = 1e-4;

struct Projected {
    @builtin(position) position: vec4f,
    // Of the caster over the plane, metres.
    @location(0) height: f32,
    @location(1) uv: vec3f,
    @location(2) @interpolate(flat) material: u32,
}

// The shadow of a point, homogeneous: M = (P · l) I − l Pᵀ over P · l.
//
// Depth is not needed, so its two clipping planes serve otherwise. The near one, z ≥ 0, cuts what
// is above the light, whose projection would be a shadow on the wrong side. The far one, z ≤ w,
// then cuts what falls behind the eye.
fn project(instance: u32, position: vec3f, uv: vec3f) -> Projected {
    let p = world_from_mesh(instance, position) - shadow.eye;
    let height = dot(shadow.plane.xyz, p) + shadow.plane.w;
    let w = 1.0 - shadow.inverse_height * height;
    let clip = shadow.clip_from_eye * vec4f(p - shadow.light * height, w);
    let place = vec4f(clip.xy, shadow.nearest * (w - LEVEL), clip.w);
    return Projected(place, height, uv, instances[instance].material);
}

@vertex
fn opaque(@location(0) position: vec3f, @location(1) instance: u32) -> Projected {
    return project(instance, position, vec3f(0.0));
}

@vertex
fn masked(@location(0) position: vec3f, @location(1) instance: u32, @location(3) uv: vec3f) -> Projected {
    return project(instance, position, with_opacity(uv));
}

@vertex
fn opaque_many(@location(0) position: vec3f, @location(1) instance: u32, many: Many) -> Projected {
    return project(instance, placed_by(many, position), vec3f(0.0));
}

@vertex
fn masked_many(
    @location(0) position: vec3f,
    @location(1) instance: u32,
    @location(3) uv: vec3f,
    many: Many,
) -> Projected {
    return project(instance, placed_by(many, position), with_opacity(uv));
}

// It lies in the plane or behind it.
fn is_below(in: Projected) -> bool {
    return in.height <= shadow.least;
}

fn is_hole(in: Projected) -> bool {
    return is_cut_out(in.material, base_color(in.material, in.uv).a);
}
