// needs: receivers
// Which plane a pixel belongs to.

const MOST_PLANES: u32 = 32u;

struct FoundPlane {
    // Its equation in normalised device coordinates: the distance of a point is that over w.
    across: vec4f,
    // Of unit length.
    normal: vec3f,
    // What rasterisers shift surfaces, as `across` counts.
    snapped: f32,
    // A quad around it on the screen, two corners each, normalised device coordinates.
    corners: array<vec4f, 2>,
}

struct PlaneFinder {
    eye: Eye,
    // The light relative to the eye; w = 0: the direction to it.
    light: vec4f,
    // Metres that a point may be off its plane, beyond what the depth buffer rounds.
    slack: f32,
    // What the depth buffer rounds, see `position_rounding`.
    rounding: f32,
    count: u32,
    pad: u32,
    planes: array<FoundPlane, MOST_PLANES>,
    // Those that the light shines on from behind.
    behind: array<FoundPlane, MOST_PLANES>,
}

@group(1) @binding(0) var<uniform> finder: PlaneFinder;

// The cosine between the normals of a pixel and of its plane is at least this, where the host has
// normals: those from depths are no better than the place itself.
const LEAST_COSINE: f32 = 0.995;

// What a pixel shows.
struct Shown {
    ndc: vec4f,
    // Before the division.
    w: f32,
    // Metres that the place may be off, times w twice.
    off: f32,
    surface: Surface,
}

fn shown_at(pixel: vec2f, depth: f32) -> Shown {
    let ndc = ndc_of(finder.eye, pixel, depth);
    let w = abs(eye_w(finder.eye, ndc));
    // `position_rounding` without its divisions.
    let rounded = finder.rounding * (w + depth * abs(finder.eye.eye_from_ndc[2].w));
    var shown = Shown(ndc, w, rounded + finder.slack * w * w, Surface(vec3f(0.0), true));
    if HAS_NORMALS {
        shown.surface = surface(finder.eye, pixel, depth);
    }
    return shown;
}

// Neither place nor normal tells them apart. `across` is the plane's, `normal` its normal and what
// rasterisers shift.
fn is_in_plane(shown: Shown, across: vec4f, normal: vec4f) -> bool {
    let n = shown.surface.normal;
    let along = dot(normal.xyz, n);
    let is_near = abs(dot(across, shown.ndc)) * shown.w <= shown.off + normal.w * shown.w;
    return is_near && along * along >= LEAST_COSINE * LEAST_COSINE * dot(n, n);
}

// The distance of a pixel from a plane times its w, by which its planes are compared.
fn off_plane(shown: Shown, across: vec4f) -> f32 {
    return abs(dot(across, shown.ndc));
}

// The number of a pixel's plane, the nearest of those that it may be in; `finder.count`: none.
fn find_plane(shown: Shown) -> u32 {
    var found = finder.count;
    var least = 1e30;
    for (var plane = 0u; plane < finder.count; plane++) {
        let p = finder.planes[plane];
        let off = off_plane(shown, p.across);
        let is_nearer = off < least && is_in_plane(shown, p.across, vec4f(p.normal, p.snapped));
        found = select(found, plane, is_nearer);
        least = select(least, off, is_nearer);
    }
    return found;
}

// Whether a pixel is nearer to one of the planes that the light shines on than to this one.
fn is_nearer_to_another(shown: Shown, across: vec4f) -> bool {
    let plane = find_plane(shown);
    return plane < finder.count && off_plane(shown, finder.planes[plane].across) < off_plane(shown, across);
}
