// Skins: quads between an edge of a blocker and the border of its shadow from one point of the
// light, along the rays of that point. Drawn from another point they cover what the first point
// does not see and the other one does, the penumbra.

// A view of a point of the light. Positions are relative to the point.
struct PointView {
    // A texel to the place at distance 1 along the axis.
    light_from_texel: mat3x3f,
    // x, y and w of clip space.
    clip_from_light: mat3x3f,
    // The distance along the axis is this over the depth.
    near: f32,
    pad_a: f32,
    pad_b: vec2f,
}

struct LightPoint {
    views: array<PointView, VIEWS>,
    // Relative to the casters' origin.
    position: vec3f,
    // Texels across and down.
    size: f32,
    // The box around all receivers.
    lowest: vec3f,
    pad_a: f32,
    highest: vec3f,
    pad_b: f32,
}

struct SkinLayer {
    // From the point whose map is drawn over to the one whose shadows end at the skins.
    to_other: vec3f,
    // Of the map.
    layer: u32,
}

struct Skin {
    @builtin(position) position: vec4f,
    // Of the light that is seen past the blocker: 0 at it, 1 at the border of its shadow.
    @location(0) @interpolate(linear) share: f32,
    // What a few texels are of that. Numbers between corners behind the light would be none.
    @location(1) @interpolate(flat) slack: f32,
    // The ends of the blocker's edge, from the point that is drawn for.
    @location(2) @interpolate(flat) start: vec3f,
    @location(3) @interpolate(flat) end: vec3f,
}

@group(3) @binding(0) var target_map: texture_depth_2d_array;
@group(3) @binding(1) var<uniform> point: LightPoint;
@group(3) @binding(2) var<uniform> into: SkinLayer;

// Least penumbra ratio: what is nearer to the receiver belongs to it.
override THRESHOLD: f32 = 0.005;

// Faces of a cube.
const VIEWS: u32 = 6u;
// Texels that a skin is longer at both ends: maps are looked up at the middle of texels, and those
// of the other point may be larger.
const LONGER: f32 = 3.0;
// Least |w| of a corner as a share of its |x| or |y|, for each texel of the map, see
// `map_depth.wgsl`.
const LEAST_W: f32 = 1.5e-8;
// What a few texels may be of the light where a skin reaches behind it.
const UNKNOWN: f32 = 0.05;
const LEAST: f32 = 1e-30;
// More than all of the light, which no share is.
const NONE: f32 = 2.0;
const NO_SKIN: Skin = Skin(vec4f(2.0, 2.0, 0.0, 1.0), 0.0, 0.0, vec3f(0.0), vec3f(0.0));

// Of a place relative to the point, or with 0 of a direction.
fn skin_clip(place: vec3f) -> vec4f {
    let clip = point.views[into.layer].clip_from_light * place;
    let least = LEAST_W * point.size * max(abs(clip.x), abs(clip.y));
    let w = select(clip.z, select(-least, least, clip.z > 0.0), abs(clip.z) < least);
    return vec4f(clip.xy, point.views[into.layer].near, w);
}

// A corner of a skin, longer than from `near` to `far` where both are in front of the point.
fn skin_corner(near: vec4f, far: vec4f, is_far: bool, start: vec3f, end: vec3f) -> Skin {
    let way = (far.xy / far.w - near.xy / near.w) * 0.5 * point.size;
    let texels = max(length(way), 1e-6);
    let is_in_front = near.w > 0.0 && far.w > 0.0;
    let longer = select(0.0, select(-LONGER, LONGER, is_far) / texels, is_in_front);
    var position = select(near, far, is_far);
    position += vec4f(way * (2.0 / point.size) * longer * position.w, 0.0, 0.0);
    let slack = select(UNKNOWN, LONGER / texels, is_in_front);
    return Skin(position, select(0.0, 1.0, is_far) + longer, slack, start, end);
}

// What the map shows at a pixel, from its point.
fn receiver_at(position: vec4f, depth: f32) -> vec3f {
    let ray = point.views[into.layer].light_from_texel * vec3f(position.xy, 1.0);
    return ray * (point.views[into.layer].near / max(depth, LEAST));
}

// The share at a pixel where it is one; what is none is more than all, and changes nothing.
fn share_if(is_one: bool, share: f32) -> f32 {
    return select(NONE, saturate(share), is_one);
}

// The place of the edge that hides something of the light from a receiver: in the plane through
// that and the light.
fn blocker_of(receiver: vec3f, start: vec3f, end: vec3f) -> vec3f {
    let normal = cross(into.to_other, receiver);
    let way = end - start;
    let rise = dot(normal, way);
    let along = -dot(normal, start) / select(rise, 1.0, rise == 0.0);
    return start + way * select(saturate(along), 0.5, rise == 0.0);
}

fn is_behind(receiver: vec3f, blocker: vec3f) -> bool {
    return length(receiver) > length(blocker) * (1.0 + THRESHOLD);
}

// As the text has it: linear between blocker and receiver, where the skin is in front of what the
// map shows.
@fragment
fn linear_share(in: Skin) -> @location(0) f32 {
    let depth = textureLoad(target_map, vec2i(in.position.xy), into.layer, 0);
    let receiver = receiver_at(in.position, depth);
    let is_in_front = depth > 0.0 && depth <= in.position.z * (1.0 + THRESHOLD);
    let is_shadowed = is_behind(receiver, blocker_of(receiver, in.start, in.end));
    return share_if(is_in_front && is_shadowed, in.share);
}

// Where the way from the receiver past the blocker meets the light. The skin is in front of the
// receiver where that is before the other point.
@fragment
fn exact_share(in: Skin) -> @location(0) f32 {
    let depth = textureLoad(target_map, vec2i(in.position.xy), into.layer, 0);
    let receiver = receiver_at(in.position, depth);
    let blocker = blocker_of(receiver, in.start, in.end);
    let way = blocker - receiver;
    let across = cross(way, into.to_other);
    let square = dot(across, across);
    let share = dot(cross(way, receiver), across) / max(square, LEAST);
    let is_between = dot(way, into.to_other * share - receiver) > 0.0 && is_behind(receiver, blocker);
    let is_on_light = square > 0.0 && share >= -in.slack && share <= 1.0 + in.slack;
    return share_if(depth > 0.0 && is_between && is_on_light, share);
}

// For pictures: each skin adds a little, and a lot at the blocker's edge.
@fragment
fn shown_skin(in: Skin) -> @location(0) vec4f {
    let at_edge = select(0.0, 1.0, abs(in.share) <= in.slack);
    return vec4f(mix(vec3f(0.08, 0.16, 0.3), vec3f(0.9, 0.5, 0.1), at_edge), 1.0);
}
