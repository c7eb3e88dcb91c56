// needs: fullscreen, draw
// Casters that the light touches. What lies beyond the light's own plane hides nothing of it, and
// where a triangle crosses that plane it ends in an edge that no silhouette has; nor is a triangle
// turned right for points on the light's side of it, which a light of some size has on both. Both
// are made up for here, triangle by triangle: what it covers is H + Q + K, with the hard shadow H,
// the terms Q of its edges, and the term K of the cut. Of that the wedges have H + Q. On the
// light's side H is 0 and the triangle covers −Q − K; there it is on the other side of a body, too.

// A triangle, or an edge of one, relative to the eye.
struct Cut {
    // Corners counter-clockwise seen from the light's centre, with weights as those of a wedge; an
    // edge has two.
    a: vec4f,
    b: vec4f,
    c: vec4f,
    // n · p = w, n away from the light's centre.
    plane: vec4f,
    // How far rounding moves it, metres.
    off: f32,
    // 1 for an edge.
    is_edge: f32,
    pad: vec2f,
}

@group(3) @binding(0) var<storage, read> cuts: array<Cut>;

// Ends of a cut are taken this much before the light's plane, so that none is beyond.
const BEFORE: f32 = 0.9999;

// How far along the way to the light's plane, 1 in it, a place is seen from `p`.
fn depth_from(p: vec3f, place: vec3f) -> f32 {
    let d = place - p;
    if FACE == SPHERE {
        return -dot(d, p) / dot(p, p);
    }
    if FACE == LINE {
        return -dot(d.yz, p.yz) / dot(p.yz, p.yz);
    }
    return -d.z / p.z;
}

// A − S of an edge as `p` sees it.
fn seen_share(p: vec3f, start: vec3f, end: vec3f) -> f32 {
    return share_of_edge(light, p, start, end, dot(cross(start - p, end - p), -p) >= 0.0);
}

// The term of the edge in which the light's plane cuts a triangle. The centre is on its left,
// whichever side of the triangle `p` is on.
fn cut_share(p: vec3f, cut: Cut) -> f32 {
    let corners = array<vec3f, 3>(to_light(light, cut.a.xyz), to_light(light, cut.b.xyz), to_light(light, cut.c.xyz));
    var ends = array<vec3f, 2>(p, p);
    var found = 0u;
    for (var k = 0u; k < 3u; k++) {
        let here = corners[k];
        let next = corners[(k + 1u) % 3u];
        let depths = vec2f(depth_from(p, here), depth_from(p, next));
        if (depths.x <= 1.0) != (depths.y <= 1.0) {
            let leaves = depths.x <= 1.0;
            ends[select(1u, 0u, leaves)] = p + BEFORE * (mix(here, next, (1.0 - depths.x) / (depths.y - depths.x)) - p);
            found += 1u;
        }
    }
    return select(0.0, share_of_edge(light, p, ends[0], ends[1], true), found == 2u);
}

@fragment
fn add_cuts(@builtin(position) at: vec4f) -> @location(0) vec2f {
    let pixel = full_pixel(light, at.xy);
    let depth = depth_at(pixel);
    if depth == eye.background_depth {
        discard;
    }
    let seen = position_eye(eye, pixel, depth);
    let rounding = position_rounding(eye, depth, 1.0 / eye_w(eye, ndc_of(eye, pixel, depth)));
    var sum = vec2f(0.0);
    for (var i = 0u; i < arrayLength(&cuts); i++) {
        let cut = cuts[i];
        let off = cut.off + rounding;
        let height = dot(cut.plane.xyz, seen) - cut.plane.w;
        let is_beyond = height > off;
        // What is in the triangle's plane is on the light's side.
        let p = to_light(light, seen - cut.plane.xyz * select(0.0, height + off, abs(height) <= off));
        let weights = vec2f(cut.a.w, cut.b.w);
        if cut.is_edge != 0.0 {
            if !is_beyond {
                let share = seen_share(p, to_light(light, cut.a.xyz), to_light(light, cut.b.xyz));
                sum -= share * (weights + weights.yx);
            }
        } else {
            sum += cut_share(p, cut) * select(-weights.yx, weights, is_beyond);
        }
    }
    return sum;
}
