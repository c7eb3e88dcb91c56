// A Gaussian over neighbouring pixels along rows or columns (ZA 3.3), only in tiles around which values differ.

struct Blur {
    eye: Eye,
    // The light relative to the eye, homogeneous.
    light: vec4f,
}

struct TileList {
    blurred: u32,
    beside: u32,
    tiles: array<u32>,
}

@group(1) @binding(0) var<uniform> blur: Blur;
@group(1) @binding(1) var source: texture_2d<f32>;
@group(1) @binding(2) var<storage, read> list: TileList;

// Pixels across and down a tile.
override TILE: i32 = 8;
// Draws tiles that are only read, else those that are blurred.
override BESIDE: bool = false;
// Along rows, or along columns.
override ALONG_ROWS: bool = true;
// Taps on each side, and pixels from one to the next.
override TAPS: i32 = 4;
override STEP: f32 = 1.0;
// Weight of the first tap on each side, where the middle has 1.
override FALLOFF: f32 = 0.88;
// Only what lies on the surface of the pixel counts.
override DEPTH_AWARE: bool = true;

const GROUP: u32 = 64u;

// How far a neighbour may be off the plane of the pixel, as a share of how far away it is.
override OFF_PLANE: f32 = 0.5;
override NORMALS: bool = true;

fn corner_of_tile(number: u32, corner: u32) -> vec4f {
    let across = u32((i32(textureDimensions(source).x) + TILE - 1) / TILE);
    let tile = vec2i(vec2u(number % across, number / across));
    let step = vec2i(i32(corner == 1u || corner >= 4u), i32(corner == 2u || corner == 3u || corner == 5u));
    return vec4f(vec2f((tile + step) * TILE) * blur.eye.ndc_from_pixel + vec2f(-1.0, 1.0), 0.0, 1.0);
}

const NOWHERE: vec4f = vec4f(2.0, 2.0, 0.0, 1.0);

// Two triangles a tile.
@vertex
fn fullscreen(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> @builtin(position) vec4f {
    let place = group * GROUP + vertex / 6u;
    if place >= select(list.blurred, list.beside, BESIDE) {
        return NOWHERE;
    }
    let index = select(place, arrayLength(&list.tiles) - 1u - place, BESIDE);
    return corner_of_tile(list.tiles[index], vertex % 6u);
}

// The plane that a pixel shows, over normalised device coordinates and times the length of its normal.
struct Plane {
    // Distance from it per pixel along the axis, and per depth.
    per_pixel: f32,
    per_depth: f32,
    depth: f32,
    // What counts as on it: per pixel, and by rounding.
    tolerance: f32,
    rounding: f32,
    // From the point to the light, and the side it is on.
    light: vec3f,
    facing: f32,
}

// Distances are times w: on perspective pictures what a pixel spans is then a constant, as it is on parallel ones.
fn plane_of(at: vec2f, depth: f32) -> Plane {
    let normal = surface(blur.eye, at, depth).normal;
    let m = blur.eye.eye_from_ndc;
    let p = m * ndc_of(blur.eye, at, depth);
    let here = p.xyz / p.w;
    let own = dot(normal, here);
    let along = select(m[1] * blur.eye.ndc_from_pixel.y, m[0] * blur.eye.ndc_from_pixel.x, ALONG_ROWS);
    let size = length(normal);
    var plane: Plane;
    plane.per_pixel = dot(normal, along.xyz) - own * along.w;
    plane.per_depth = dot(normal, m[2].xyz) - own * m[2].w;
    plane.depth = depth;
    plane.tolerance = OFF_PLANE * size * length(along.xyz);
    plane.rounding = size * position_rounding(blur.eye, depth, 1.0 / p.w) * abs(p.w);
    plane.light = blur.light.xyz - here * blur.light.w;
    plane.facing = dot(normal, plane.light);
    return plane;
}

fn is_on(plane: Plane, pixel: vec2i, offset: f32, depth: f32) -> bool {
    let off = plane.per_pixel * offset + plane.per_depth * (depth - plane.depth);
    let on = abs(off) <= plane.tolerance * abs(offset) + plane.rounding;
    if HAS_NORMALS && NORMALS {
        // Nor does the dark of what is turned away from the light reach what faces it.
        let normal = unpack_normal(textureLoad(receiver_normal, pixel, 0).x);
        return on && dot(normal, plane.light) * plane.facing >= 0.0;
    }
    return on;
}

fn neighbour(pixel: vec2i, tap: i32) -> vec2i {
    let offset = i32(round(f32(tap) * STEP));
    let last = vec2i(textureDimensions(source)) - 1;
    return clamp(pixel + select(vec2i(0, offset), vec2i(offset, 0), ALONG_ROWS), vec2i(0), last);
}

@fragment
fn unchanged(@builtin(position) at: vec4f) -> @location(0) f32 {
    return textureLoad(source, vec2i(at.xy), 0).x;
}

@fragment
fn blurred(@builtin(position) at: vec4f) -> @location(0) f32 {
    let pixel = vec2i(at.xy);
    let own = textureLoad(source, pixel, 0).x;
    let depth = textureLoad(receiver_depth, pixel, 0);
    var plane: Plane;
    if DEPTH_AWARE {
        plane = plane_of(at.xy, depth);
    }
    var sum = vec2f(own, 1.0);
    var weight = 1.0;
    var falloff = FALLOFF;
    for (var tap = 1; tap <= TAPS; tap++) {
        weight *= falloff;
        falloff *= FALLOFF * FALLOFF;
        for (var side = -1; side <= 1; side += 2) {
            let other = neighbour(pixel, side * tap);
            let other_depth = textureLoad(receiver_depth, other, 0);
            let steps = other - pixel;
            var counts = other_depth != blur.eye.background_depth;
            if DEPTH_AWARE {
                counts = counts && is_on(plane, other, f32(steps.x + steps.y), other_depth);
            }
            sum += select(0.0, weight, counts) * vec2f(textureLoad(source, other, 0).x, 1.0);
        }
    }
    return select(sum.x / sum.y, own, depth == blur.eye.background_depth);
}
