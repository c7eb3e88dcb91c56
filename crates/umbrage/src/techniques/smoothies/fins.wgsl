// needs: fin_share
// Draws smoothies: fins on the edges of casters, away from the shadow, as wide as the light at the
// edge (or so many texels), with round ends.

struct FinCorner {
    @builtin(position) position: vec4f,
    // In the light's space: the point, and the ends of the edge. Of a fin of some texels: the ends
    // as texels and depth.
    @location(0) at: vec3f,
    @location(1) @interpolate(flat) start: vec3f,
    @location(2) @interpolate(flat) end: vec3f,
    // Depth times w, and w.
    @location(3) place: vec2f,
    // Change of depth times w per metre along parallel light.
    @location(4) @interpolate(flat) per_metre: f32,
}

// Texels across; 0: as wide as the light.
override WIDTH: f32 = 0.0;
// Divided by 1 − b/r, else not.
override REMAP: bool = true;
// Depth is that of the cone around the light's rim, else that of the fin.
override CONES: bool = false;

// Texels that a fin reaches into the shadow, so that what is rounded leaves no gap.
const GUARD: f32 = 0.25;
// Most that a fin widens where it turns away from the light, and where the light is as near.
const WIDEST: f32 = 8.0;
const MOST_NEARER: f32 = 4.0;

fn no_fin() -> FinCorner {
    return FinCorner(OFF_LAYER, vec3f(0.0), vec3f(0.0), vec3f(0.0), vec2f(1.0), 1.0);
}

@vertex
fn fin(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> FinCorner {
    let edge = contour_edge(vertex, group);
    if !edge.is_there {
        return no_fin();
    }
    if WIDTH > 0.0 {
        return fin_of_texels(edge, vertex);
    }
    return fin_of_light(edge, vertex);
}

fn fin_of_texels(edge: ContourEdge, vertex: u32) -> FinCorner {
    let seen = layer_edge(edge, WIDTH + 1.0);
    if !seen.is_seen {
        return no_fin();
    }
    let at = quad_corner(seen, vertex, WIDTH, GUARD);
    let position = clip_of_texel(at, 0.5);
    return FinCorner(position, vec3f(0.0), vec3f(seen.start, seen.depth.x), vec3f(seen.end, seen.depth.y), vec2f(1.0), 1.0);
}

// How much of the light's extent the penumbra of a point has at most where there are receivers:
// under parallel light the way from the point to the farthest of them.
//
// A way that starts within the light's extent of the point leaves the box around the receivers
// where it leaves the first pair of its sides.
fn most_of_extent(p: vec3f, per_metre: f32) -> f32 {
    let way = way_of_light(p);
    let reach = smoothie_light.reach;
    if is_parallel() {
        let unit = way / length(way);
        let room = select(p - smoothie_light.low, smoothie_light.high - p, unit > vec3f(0.0));
        let sure = abs(unit) - reach;
        let leaves = select(vec3f(1e30), max(room, vec3f(0.0)) / sure, sure > vec3f(0.0));
        let to_end = max(clip_of(p).z, 0.0) / per_metre;
        return min(min(leaves.x, to_end), min(leaves.y, leaves.z));
    }
    let room = select(smoothie_light.center - smoothie_light.low, smoothie_light.high - smoothie_light.center, way > vec3f(0.0));
    let sure = abs(way) - reach;
    let leaves = select(vec3f(1e30), max(room, vec3f(0.0)) / sure, sure > vec3f(0.0));
    return 1.0 - 1.0 / max(min(leaves.x, min(leaves.y, leaves.z)), 1.0);
}

// How much farther the light's rim may be seen to reach than its extent says, since a part of the
// light is nearer to the edge than its centre is.
fn nearer(way: vec3f) -> f32 {
    let distance = length(way);
    let extent = light_extent(way / distance) / distance;
    let share = select(extent, extent * extent, smoothie_light.face == SPHERE);
    return select(1.0 / max(1.0 - share, 1.0 / MOST_NEARER), 1.0, is_parallel());
}

// A corner of what holds the fin: on the edge's own line and outwards from there, so that it is as
// wide everywhere.
fn fin_of_light(whole: ContourEdge, vertex: u32) -> FinCorner {
    // What is far outside of the layer would cost precision inside.
    let seen = layer_edge(whole, map_view.size);
    if !seen.is_seen {
        return no_fin();
    }
    let edge = ContourEdge(seen_start(whole, seen), seen_end(whole, seen), whole.times, true);
    let is_end = is_at_end(vertex);
    let p = select(edge.start, edge.end, is_end);
    let outward = outward_at(edge, p);
    if dot(outward, outward) == 0.0 {
        return no_fin();
    }
    let per_metre = metres_of_depth();
    let most = max(most_of_extent(edge.start, per_metre), most_of_extent(edge.end, per_metre))
        * max(nearer(way_of_light(edge.start)), nearer(way_of_light(edge.end)));
    if !(most > 0.0) {
        return no_fin();
    }
    let way = way_of_light(p);
    let along = along_at(edge, p) * select(-1.0, 1.0, is_end);
    let unit = normalize(edge.end - edge.start);
    let to_line = way - unit * dot(way, unit);
    let turned = way + along * (most * light_extent(along));
    let distance = dot(to_line, to_line);
    let scale = min(distance / max(dot(to_line, turned), distance / WIDEST), WIDEST);
    let wide = most * light_extent(outward) * max(1.0, scale * length(turned) / length(way));
    let base = select(smoothie_light.center + turned * scale, p + along * (most * light_extent(along)), is_parallel());
    let across = select(wide, most * light_extent(outward), is_parallel());
    let inward = min(GUARD / texels_per_metre(base, outward), across);
    let corner = base + outward * select(across, -inward, is_on_other_side(vertex));
    let clip = moved_off_light(clip_of(corner));
    let center = smoothie_light.center;
    return FinCorner(
        vec4f(clip.xy, 0.5 * clip.w, clip.w),
        to_light(corner - center),
        to_light(edge.start - center),
        to_light(edge.end - center),
        clip.zw,
        per_metre,
    );
}

// How depth times w changes per metre along parallel light.
fn metres_of_depth() -> f32 {
    let m = transpose(map_view.clip_from_world);
    return abs(dot(m[2].xyz, unit_or_zero(cross(m[0].xyz, m[1].xyz))));
}

// How far a metre in a direction goes in the map.
fn texels_per_metre(p: vec3f, direction: vec3f) -> f32 {
    let at = clip_of(p);
    let step = clip_of(p + direction);
    let change = (step.xy - at.xy / at.w * step.w) / at.w;
    return select(1e30, max(0.5 * map_view.size * length(change), 1e-30), at.w > 0.0);
}

// As casters' corners are, see `map_position`.
fn moved_off_light(clip: vec4f) -> vec4f {
    let least = map_view.least_w * max(abs(clip.x), abs(clip.y));
    let w = select(clip.w, select(-least, least, clip.w > 0.0), abs(clip.w) < least);
    return vec4f(clip.xyz, w);
}

// The way from the light to a texel of a paraboloid, of length 1.
fn paraboloid_way(position: vec4f) -> vec3f {
    let plane = position.xy * map_view.plane_from_texel.xy + map_view.plane_from_texel.zw;
    let square = dot(plane, plane);
    let m = transpose(map_view.clip_from_world);
    return (m[0].xyz * (2.0 * plane.x) + m[1].xyz * (2.0 * plane.y) + m[3].xyz * (1.0 - square)) / (1.0 + square);
}

// The smoothie that a fragment shows, where what the light sees lies at depth `behind`.
fn smoothie_of(in: FinCorner, behind: f32, face: u32) -> Smoothie {
    if WIDTH > 0.0 {
        let found = nearest_on(vec3f(in.start.xy - in.position.xy, 0.0), vec3f(in.end.xy - in.position.xy, 0.0));
        let depth = mix(in.start.z, in.end.z, found.y);
        return Smoothie(select(2.0, found.x / WIDTH * depth / (depth - behind), depth > behind), depth);
    }
    if PARABOLOID {
        let way = to_light(paraboloid_way(in.position));
        return smoothie_at(in.start, in.end, way, map_view.near, 1.0, behind, face);
    }
    return smoothie_at(in.start, in.end, in.at, in.place.x / in.place.y, in.per_metre / in.place.y, behind, face);
}

// What a fragment shows; a share of more than 1 is nothing.
struct Seen {
    share: f32,
    depth: f32,
    behind: f32,
}

fn seen_smoothie(in: FinCorner, face: u32) -> Seen {
    let behind = depth_of(textureLoad(map_depth, vec2i(in.position.xy), 0), map_view.farthest);
    let counted = select(0.0, behind, REMAP);
    let found = smoothie_of(in, counted, face);
    let is_there = found.share < 1.0 && found.depth > behind;
    let of_cone = mix(found.depth, counted, found.share);
    return Seen(select(2.0, found.share, is_there), select(found.depth, of_cone, CONES), behind);
}

// Of what is blended the least counts: the darkest smoothie, and the one nearest to the light.
struct Least {
    @location(0) share: vec4f,
    @location(1) before: vec4f,
}

// How far the smoothie is before what the light sees behind it, so that halves of floats tell both
// apart however near they are: from a point 1 − b/r. Where there is nothing behind, its depth, from
// a point the inverse of its distance.
fn before(depth: f32, behind: f32) -> f32 {
    let gap = (depth - behind) / select(depth, 1.0, is_parallel());
    return select(gap, depth / select(map_view.near, 1.0, is_parallel()), behind == 0.0);
}

fn least(in: FinCorner, face: u32) -> Least {
    let seen = seen_smoothie(in, face);
    if seen.share > 1.0 {
        discard;
    }
    return Least(vec4f(seen.share), vec4f(-before(seen.depth, seen.behind)));
}

@fragment
fn fin_of_sphere(in: FinCorner) -> Least {
    return least(in, SPHERE);
}

@fragment
fn fin_of_disc(in: FinCorner) -> Least {
    return least(in, DISC);
}

@fragment
fn fin_of_square(in: FinCorner) -> Least {
    return least(in, SQUARE);
}

@fragment
fn fin_of_line(in: FinCorner) -> Least {
    return least(in, LINE);
}

// To be looked at: the depth, and the share before it is divided by 1 − b/r, which is that of a
// receiver infinitely far away.
@fragment
fn fin_depth(in: FinCorner) -> @builtin(frag_depth) f32 {
    let seen = seen_smoothie(in, smoothie_light.face);
    if seen.share > 1.0 {
        discard;
    }
    return saturate(seen.depth);
}

@fragment
fn fin_alpha(in: FinCorner) -> @location(0) vec4f {
    let found = smoothie_of(in, 0.0, smoothie_light.face);
    if !(found.share < 1.0) {
        discard;
    }
    return vec4f(found.share);
}
