// needs: fullscreen, plane_finder
// Looks up the textures of planes.

// Taps along each side of the grid.
override KERNEL: u32 = 7u;
// Shadows are as soft as the light makes them.
override BY_LIGHT: bool = true;

// What is in shadow is below this, see `cast.wgsl`.
const SHADOWED: f32 = 1.5;

struct PlaneTexture {
    // From places relative to the eye to texels.
    across: vec4f,
    down: vec4f,
    normal: vec3f,
    // One over the light's height, 0 for parallel light.
    inverse_height: f32,
    // The light relative to the eye over its height; see `plane_shadow.wgsl`.
    light: vec3f,
    // What 1 stands for in the texture, metres of `cast.wgsl`.
    highest: f32,
    // Half axes of the light, metres over its height, of which those of a sphere turn with the
    // receiver; of a fixed blur, metres.
    right: vec3f,
    radius: f32,
    up: vec3f,
    is_round: f32,
}

struct Textures {
    // Half axes of the light; a sphere has a radius instead.
    right: vec3f,
    radius: f32,
    up: vec3f,
    is_round: f32,
    planes: array<PlaneTexture, MOST_PLANES>,
}

@group(2) @binding(0) var<uniform> textures: Textures;
@group(2) @binding(1) var shadows: texture_2d_array<f32>;
@group(2) @binding(2) var nearest: sampler;

// Half axes of the blur in texels, for a reach of 1.
struct Blur {
    middle: vec2f,
    right: vec2f,
    up: vec2f,
    is_round: bool,
    plane: u32,
}

fn blur_at(plane: u32, position: vec3f) -> Blur {
    let p = textures.planes[plane];
    // From the receiver to the light, for each metre of height.
    let toward = p.light - position * p.inverse_height;
    var right = p.right;
    var up = p.up;
    if p.radius > 0.0 {
        let way = normalize(toward);
        right = normalize(cross(way, select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(way.x) > 0.7))) * p.radius;
        up = cross(way, right);
    }
    // A point that moves along the light moves the shadow in the plane.
    right = (right - toward * dot(p.normal, right)) * p.highest;
    up = (up - toward * dot(p.normal, up)) * p.highest;
    let in_texels = mat2x2f(
        vec2f(dot(p.across.xyz, right), dot(p.down.xyz, right)), vec2f(dot(p.across.xyz, up), dot(p.down.xyz, up)),
    );
    let at = vec4f(position, 1.0);
    let middle = vec2f(dot(p.across, at), dot(p.down, at));
    return Blur(middle, in_texels[0], in_texels[1], p.is_round > 0.5, plane);
}

// A point of the light, −1 to 1: squares become discs by Shirley and Chiu's concentric map.
fn on_light(square: vec2f, is_round: bool) -> vec2f {
    let is_wide = abs(square.x) > abs(square.y);
    let longer = select(square.y, square.x, is_wide);
    let shorter = select(square.x, square.y, is_wide);
    let angle = 0.78539816 * shorter / select(longer, 1.0, longer == 0.0);
    let disc = longer * vec2f(cos(angle), sin(angle));
    return select(square, select(disc.yx, disc, is_wide), is_round);
}

fn tap(i: u32, side: u32) -> vec2f {
    return (vec2f(f32(i % side), f32(i / side)) + 0.5) * (2.0 / f32(side)) - 1.0;
}

// The share of light at a place of the texture, in texels, between the middles of four.
fn light_at(texel: vec2f, plane: u32) -> f32 {
    let size = vec2f(textureDimensions(shadows));
    let corner = floor(texel - 0.5) + 1.0;
    let share = texel + 0.5 - corner;
    let lit = step(vec4f(SHADOWED), textureGather(0, shadows, nearest, corner / size, plane));
    let rows = mix(lit.wx, lit.zy, share.x);
    let inside = all(texel > vec2f(0.0)) && all(texel < size);
    return select(1.0, mix(rows.x, rows.y, share.y), inside);
}

fn reach_at(texel: vec2f, plane: u32) -> f32 {
    let size = vec2f(textureDimensions(shadows));
    let inside = all(texel > vec2f(0.0)) && all(texel < size);
    let at = clamp(vec2i(texel), vec2i(0), vec2i(size) - 1);
    return select(2.0, textureLoad(shadows, at, plane, 0).x, inside);
}

// Blockers are searched for within the widest penumbra, then closer and closer by, down to a texel.
const CLOSER: f32 = 0.3;
const SEARCH: u32 = 5u;

// The mean reach of what hides points of the light; negative where nothing does.
fn mean_reach(blur: Blur) -> f32 {
    var sum = 0.0;
    var count = 0.0;
    let widest = max(length(blur.right), length(blur.up));
    for (var within = 1.0; within * widest > 0.5; within *= CLOSER) {
        for (var i = 0u; i < SEARCH * SEARCH; i++) {
            let q = on_light(tap(i, SEARCH), blur.is_round);
            let reach = reach_at(blur.middle + (blur.right * q.x + blur.up * q.y) * within, blur.plane);
            // It hides the point q · within / reach of the light.
            let extent = select(max(abs(q.x), abs(q.y)), length(q), blur.is_round) * within;
            let hides = select(0.0, 1.0, reach < SHADOWED && extent <= reach);
            sum += hides * reach;
            count += hides;
        }
    }
    return select(-1.0, sum / max(count, 1.0), count > 0.0);
}

fn mean_light(blur: Blur, reach: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < KERNEL * KERNEL; i++) {
        let q = on_light(tap(i, KERNEL), blur.is_round) * reach;
        sum += light_at(blur.middle + blur.right * q.x + blur.up * q.y, blur.plane);
    }
    return sum / f32(KERNEL * KERNEL);
}

// The share of the light that is above the horizon of a surface.
fn above_horizon(position: vec3f, normal: vec3f) -> f32 {
    let to_light = finder.light.xyz - position * finder.light.w;
    let n = normalize(normal);
    let height = dot(n, to_light);
    let sine = height / length(to_light);
    let half = vec2f(dot(n, textures.right), dot(n, textures.up));
    let is_round = textures.is_round > 0.5;
    let flat = select(abs(half.x) + abs(half.y), length(half), is_round);
    let extent = select(flat, textures.radius * sqrt(max(1.0 - sine * sine, 0.0)), textures.radius > 0.0);
    let t = clamp(height / max(extent, 1e-9), -1.0, 1.0);
    let segment = 0.5 + (t * sqrt(1.0 - t * t) + asin(t)) * 0.31830989;
    return saturate(select(0.5 + 0.5 * t, segment, is_round));
}

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == finder.eye.background_depth {
        return 1.0;
    }
    let shown = shown_at(at.xy, depth);
    let position = position_eye(finder.eye, at.xy, depth);
    var share = 1.0;
    if HAS_NORMALS {
        share = select(1.0, above_horizon(position, shown.surface.normal), shown.surface.casts);
    }
    if share < 1e-6 {
        return 0.0;
    }
    return min(share, past_casters(shown, position));
}

fn past_casters(shown: Shown, position: vec3f) -> f32 {
    let plane = find_plane(shown);
    if plane >= finder.count {
        return 1.0;
    }
    let blur = blur_at(plane, position);
    // Beside all shadows.
    let size = vec2f(textureDimensions(shadows));
    let widest = abs(blur.right) + abs(blur.up) + 1.0;
    if any(blur.middle < -widest) || any(blur.middle > size + widest) {
        return 1.0;
    }
    if !BY_LIGHT {
        return mean_light(blur, 1.0);
    }
    let reach = mean_reach(blur);
    if reach < 0.0 {
        return light_at(blur.middle, blur.plane);
    }
    return mean_light(blur, reach);
}
