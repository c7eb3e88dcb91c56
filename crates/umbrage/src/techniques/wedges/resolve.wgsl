// needs: fullscreen, receivers, area_light, coverage
// From covered shares to visibility.

@group(1) @binding(0) var<uniform> light: AreaLight;
@group(1) @binding(1) var<uniform> eye: Eye;
// A layer for each piece of the light.
@group(1) @binding(2) var covered: texture_2d_array<f32>;
// Of each piece its share of the light, and twice how many of its shadows the eye is in, see
// `Wedge::weights`. Not in storage, which some drivers read pixel by pixel.
@group(1) @binding(3) var<uniform> pieces: array<vec4f, 9>;

// Of the light.
override PIECES: u32 = 1u;
// The buffer of shares is smaller than the picture.
override SCALED: bool = false;

override SOFT: bool = true;

// Of a disc of radius 1 the share beyond a line at this distance from its centre.
fn beyond_on_disc(distance: f32) -> f32 {
    let d = clamp(distance, -1.0, 1.0);
    return (acos(d) - d * sqrt(1.0 - d * d)) / PI;
}

// The share of the light that is below the surface's own plane, whose normal is given in light
// space.
fn below_horizon(p: vec3f, normal: vec3f) -> f32 {
    let way = way_to_light(light, p);
    let height = dot(normal, way);
    if FACE == SPHERE {
        // Of the face that is perpendicular to the way.
        let aside = dot(normal, normal) - height * height / dot(way, way);
        return beyond_on_disc(height * inverseSqrt(max(aside, 1e-30)));
    }
    if FACE == DISC {
        return beyond_on_disc(height / max(length(normal.xy), 1e-30));
    }
    if FACE == LINE {
        return beyond_on_square(vec3f(normal.x, 0.0, height));
    }
    return beyond_on_square(vec3f(normal.xy, height));
}

// What casters cover of a piece, of a place in the buffer of shares.
fn covered_of(piece: u32, at: vec2i) -> f32 {
    // Both sides of a body cover the same, but for holes.
    let sides = pieces[piece].yz + textureLoad(covered, at, piece, 0).xy;
    return clamp(max(sides.x, sides.y), 0.0, 1.0);
}

fn covered_at(at: vec2i) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < PIECES; i++) {
        sum += pieces[i].x * covered_of(i, at);
    }
    return sum;
}

// The most that shares around a pixel may differ in to be taken for the same.
const SAME: f32 = 1e-3;

// Shares of the place `first` in the smaller buffer and of those to the right, below and both.
fn covered_around(first: vec2f, last: vec2i) -> vec4f {
    let a = clamp(vec2i(first), vec2i(0), last);
    let b = clamp(vec2i(first) + 1, vec2i(0), last);
    return vec4f(covered_at(a), covered_at(vec2i(b.x, a.y)), covered_at(vec2i(a.x, b.y)), covered_at(b));
}

// Between places of the smaller buffer those count that lie in the surface's own plane; where none
// does, the one that is nearest to it. Where all have the same share, as mostly, that is left at
// once.
fn upsampled(pixel: vec2f, p: vec3f, normal: vec3f) -> f32 {
    let scale = f32(light.scale);
    let last = vec2i(textureDimensions(covered)) - 1;
    let place = (floor(pixel) - floor(0.5 * scale)) / scale;
    let first = floor(place);
    let part = place - first;
    let shares = covered_around(first, last);
    let least = min(min(shares.x, shares.y), min(shares.z, shares.w));
    let most = max(max(shares.x, shares.y), max(shares.z, shares.w));
    let n = normalize(normal);
    var sum = vec2f(0.0);
    var nearest = vec2f(least, 1e30);
    for (var i = 0u; i < 4u && most - least > SAME; i++) {
        let corner = vec2f(vec2u(i & 1u, i >> 1u));
        let at = clamp(vec2i(first + corner), vec2i(0), last);
        let full = full_pixel(light, vec2f(at));
        let depth = textureLoad(receiver_depth, vec2i(full), 0);
        if depth == eye.background_depth {
            continue;
        }
        let way = position_eye(eye, full, depth) - p;
        // From the plane, against what a surface bends over that way.
        let off = abs(dot(n, way)) / (0.05 * length(way) + 1e-4 * length(p));
        let share = shares[i];
        let sides = mix(1.0 - part, part, corner);
        let weight = sides.x * sides.y * max(1.0 - off, 0.0);
        sum += weight * vec2f(share, 1.0);
        if off < nearest.y {
            nearest = vec2f(share, off);
        }
    }
    return select(nearest.x, sum.x / sum.y, sum.y > 1e-3);
}

@fragment
fn resolve(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    if depth == eye.background_depth {
        return 1.0;
    }
    let here = position_eye(eye, at.xy, depth);
    let surface = surface(eye, at.xy, depth);
    var share = 0.0;
    if SCALED {
        share = upsampled(at.xy, here, surface.normal);
    } else {
        share = covered_at(vec2i(at.xy));
    }
    if SOFT {
        let n = surface.normal;
        // A plane's normal goes by the inverse transposed.
        let back = light.from_light;
        let normal = vec3f(
            n.x * back[0].x + n.y * back[1].x + n.z * back[2].x,
            n.x * back[0].y + n.y * back[1].y + n.z * back[2].y,
            n.x * back[0].z + n.y * back[1].z + n.z * back[2].z,
        );
        let p = to_light(light, here);
        share = max(share, select(0.0, below_horizon(p, normal), surface.casts));
    }
    return 1.0 - clamp(share, 0.0, 1.0);
}

// What is seen of each piece of the light, side by side.
@fragment
fn mosaic(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let columns = ceil(sqrt(f32(PIECES)));
    let rows = ceil(f32(PIECES) / columns);
    let size = vec2f(textureDimensions(covered));
    let place = at.xy / size * vec2f(columns, rows);
    let piece = u32(floor(place.y) * columns + floor(place.x));
    let seen = 1.0 - covered_of(min(piece, PIECES - 1u), vec2i(fract(place) * size));
    let is_piece = piece < PIECES && all(fract(place) > vec2f(0.004));
    return vec4f(vec3f(select(0.0, seen, is_piece)), 1.0);
}
