// needs: receivers, map_layers
// Fits splits to the depths that are visible: finds their range, and crops one view of the light to
// each part of it.

struct SplitFit {
    eye: Eye,
    // The view that is cropped: it covers all parts.
    base: MapLayer,
    clip_from_world: mat4x4f,
    // Homogeneous texels (x, y and w) of the corners of the camera's view at distance 0, and their
    // change per metre of it.
    corners: array<vec4f, 4>,
    ways: array<vec4f, 4>,
    // As `MapLookup` has it.
    view_distance: vec4f,
    size: f32,
    // Texels of a crop that are kept free at its border, and of the view besides.
    border: f32,
    margin: f32,
    count: u32,
    lambda: f32,
    // Share of a split over which it is blended with the next one.
    overlap: f32,
    // Shadows end here.
    distance: f32,
    pad: f32,
}

// Bits of the least and the largest distance; positive numbers are in the order of their bits.
struct VisibleRange {
    near: atomic<u32>,
    far: atomic<u32>,
}

@group(2) @binding(0) var<uniform> fit: SplitFit;
@group(2) @binding(1) var<storage, read_write> visible: VisibleRange;
@group(2) @binding(2) var<storage, read_write> lookup: MapLookup;
@group(2) @binding(3) var<storage, read_write> views: array<mat4x4f, MOST_LAYERS>;

var<workgroup> group_near: atomic<u32>;
var<workgroup> group_far: atomic<u32>;

// Pixels across and down a thread.
const BLOCK: u32 = 4u;
// Threads across and down, and their pixels.
const THREADS: u32 = 8u;
const PIXELS: u32 = THREADS * BLOCK;

@compute @workgroup_size(THREADS, THREADS)
fn find_range(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) index: u32) {
    if index == 0u {
        atomicStore(&group_near, 0xffffffffu);
        atomicStore(&group_far, 0u);
    }
    workgroupBarrier();
    let size = textureDimensions(receiver_depth);
    var near = 0xffffffffu;
    var far = 0u;
    for (var i = 0u; i < BLOCK * BLOCK; i++) {
        let pixel = id.xy * BLOCK + vec2u(i % BLOCK, i / BLOCK);
        let depth = textureLoad(receiver_depth, min(pixel, size - 1u), 0);
        let ndc = ndc_of(fit.eye, vec2f(pixel) + 0.5, depth);
        let bits = bitcast<u32>(max(dot(fit.view_distance, ndc) / eye_w(fit.eye, ndc), 0.0));
        if all(pixel < size) && depth != fit.eye.background_depth {
            near = min(near, bits);
            far = max(far, bits);
        }
    }
    atomicMin(&group_near, near);
    atomicMax(&group_far, far);
    workgroupBarrier();
    if index == 0u {
        atomicMin(&visible.near, atomicLoad(&group_near));
        atomicMax(&visible.far, atomicLoad(&group_far));
    }
}

// The practical scheme, as `split_distances` has it.
fn border(near: f32, far: f32, i: u32) -> f32 {
    let share = f32(i) / f32(fit.count);
    let uniform_at = mix(near, far, share);
    let logarithmic = near * pow(max(far / near, 1.0), share);
    return select(uniform_at, mix(uniform_at, logarithmic, fit.lambda), near > 0.0);
}

// What a part of the view covers in the base view, low and high texels; all of it where a corner is
// behind the light.
fn part_in_view(from_distance: f32, to_distance: f32) -> vec4f {
    var low = vec2f(1e30);
    var high = vec2f(-1e30);
    var is_in_front = true;
    for (var i = 0u; i < 8u; i++) {
        let distance = select(from_distance, to_distance, i >= 4u);
        let h = fit.corners[i & 3u] + distance * fit.ways[i & 3u];
        is_in_front &= h.z > 0.0;
        low = min(low, h.xy / h.z);
        high = max(high, h.xy / h.z);
    }
    let inner = fit.border + fit.margin;
    low = max(low, vec2f(inner));
    high = min(high, vec2f(fit.size - inner));
    if !is_in_front || any(low >= high) {
        return vec4f(vec2f(inner), vec2f(fit.size - inner));
    }
    return vec4f(low, high);
}

// The base view stretched by `scale` and moved by `offset` texels.
fn cropped(scale: vec2f, offset: vec2f) -> MapLayer {
    var layer = fit.base;
    for (var i = 0u; i < 4u; i++) {
        let column = fit.base.map_from_place[i];
        layer.map_from_place[i] = vec4f(column.xy * scale + column.w * offset, column.zw);
    }
    layer.slope_right /= scale.x;
    layer.slope_down /= scale.y;
    layer.slope_axis -= select(vec3f(0.0), layer.slope_right * offset.x + layer.slope_down * offset.y, PERSPECTIVE);
    layer.texel_right = layer.texel_right * scale.x + layer.texel_w * offset.x;
    layer.texel_down = layer.texel_down * scale.y + layer.texel_w * offset.y;
    layer.axis = vec4f(layer.axis.xy * scale + offset, layer.axis.zw / scale);
    return layer;
}

fn cropped_clip(scale: vec2f, offset: vec2f) -> mat4x4f {
    let moved = scale - 1.0 + 2.0 * offset / fit.size;
    var clip = fit.clip_from_world;
    for (var i = 0u; i < 4u; i++) {
        let column = fit.clip_from_world[i];
        clip[i] = vec4f(column.x * scale.x + column.w * moved.x, column.y * scale.y - column.w * moved.y, column.zw);
    }
    return clip;
}

@compute @workgroup_size(MOST_LAYERS)
fn fit_splits(@builtin(local_invocation_index) i: u32) {
    if i >= fit.count {
        return;
    }
    let near = min(bitcast<f32>(atomicLoad(&visible.near)), fit.distance);
    // Rounding may put the farthest receiver a little beyond.
    let far = min(bitcast<f32>(atomicLoad(&visible.far)) * 1.00001, fit.distance);
    let is_empty = atomicLoad(&visible.far) == 0u;
    let begin = border(near, far, i);
    let end = select(border(near, far, i + 1u), far, i + 1u == fit.count);
    let before = select(begin - border(near, far, max(i, 1u) - 1u), 0.0, i == 0u);
    var part = part_in_view(begin - fit.overlap * before, end);
    if is_empty {
        part = vec4f(vec2f(0.0), vec2f(fit.size));
    }
    let low = part.xy - fit.margin;
    let high = part.zw + fit.margin;
    // A part seen edge-on still needs a width.
    let width = max(high - low, vec2f(max(high.x - low.x, high.y - low.y) * 0.005));
    let scale = (fit.size - 2.0 * fit.border) / width;
    let offset = 0.5 * fit.size - 0.5 * (low + high) * scale;
    lookup.layers[i] = cropped(scale, offset);
    views[i] = cropped_clip(scale, offset);
    if i + 1u < fit.count {
        lookup.splits[i / 4u][i % 4u] = end;
        lookup.blends[i / 4u][i % 4u] = end - fit.overlap * (end - begin);
    } else {
        lookup.last_split = end;
    }
}
