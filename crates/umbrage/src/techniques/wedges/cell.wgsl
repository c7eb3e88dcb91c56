// What an edge adds to the covered share of a piece of a disc, see `Cell` in the core crate.

// Where a ray from a point on the piece leaves it, and ∮ X × dX up to there.
struct Exit {
    at: vec2f,
    potential: f32,
}

fn exit_of(light: AreaLight, start: vec2f, way: vec2f) -> Exit {
    let square = dot(way, way);
    let along = dot(start, way);
    let circle = (sqrt(max(along * along + square * (1.0 - dot(start, start)), 0.0)) - along) / square;
    let bounds = select(light.cell.xy, light.cell.zw, way > vec2f(0.0));
    let times = select((bounds - start) / way, vec2f(1e30), way == vec2f(0.0));
    let at = start + way * min(circle, min(times.x, times.y));
    if circle <= min(times.x, times.y) {
        let middle = light.cell_arc.xy;
        return Exit(at, atan2(middle.x * at.y - middle.y * at.x, dot(middle, at)) + light.cell_arc.z);
    }
    let right_or_left = at.x * at.y + select(light.cell_sides.z, light.cell_sides.x, way.x > 0.0);
    let up_or_down = -at.x * at.y + select(light.cell_sides.w, light.cell_sides.y, way.y > 0.0);
    return Exit(at, select(up_or_down, right_or_left, times.x <= times.y));
}

// The part of an edge, homogeneous in the face's coordinates, that runs across the piece.
fn across_cell(light: AreaLight, a: vec3f, b: vec3f, beyond: bool) -> Chord {
    let n = cross(a, b);
    let length = length(n.xy);
    let along = vec2f(n.y, -n.x) / length;
    let foot = -n.xy * (n.z / (length * length));
    let on_disc = across_disc(a, b, beyond);
    let still = along == vec2f(0.0);
    let low = select((light.cell.xy - foot) / along, vec2f(-1e30), still);
    let high = select((light.cell.zw - foot) / along, vec2f(1e30), still);
    let enters = min(low, high);
    let leaves = max(low, high);
    let start = max(on_disc.start, max(enters.x, enters.y));
    let end = min(on_disc.end, min(leaves.x, leaves.y));
    return Chord(foot + along * start, foot + along * end, on_disc.hit && start < end);
}

// `center`: where silhouettes are seen from; `inside`: it is on the left of the chord, whatever was
// rounded.
fn cell_term(light: AreaLight, c: Chord, center: vec2f, inside: bool) -> f32 {
    // A point on the piece, however far from the caster's own direction the light is seen.
    let in_sides = clamp(center, light.cell.xy + 1e-3, light.cell.zw - 1e-3);
    let held = in_sides * min(1.0, 0.999 / max(length(in_sides), 1e-6));
    let p = c.start - held;
    let q = c.end - held;
    let first = exit_of(light, held, p);
    let last = exit_of(light, held, q);
    let way = last.at - first.at;
    let around = light.cell_arc.w;
    var sector = last.potential - first.potential - (held.x * way.y - held.y * way.x);
    // A sector next to nothing may have any sign.
    let least = 1e-4 * around;
    sector += select(select(0.0, -around, sector > least), select(0.0, around, sector < -least), inside);
    return (p.x * q.y - p.y * q.x - sector) / around;
}

// A − S of an edge, see `share_of_edge`.
fn share_of_piece(light: AreaLight, p: vec3f, start: vec3f, end: vec3f, anchor: Anchor, inside: bool) -> f32 {
    let a = start - p;
    let b = end - p;
    if light.parallel != 0u {
        let c = across_cell(light, a, b, false);
        return select(0.0, cell_term(light, c, anchor.place.xy, inside), c.hit);
    }
    if FACE == DISC {
        let is_behind = p.z > 0.0;
        let c = across_cell(light, on_face(a, p), on_face(b, p), true);
        let share = select(0.0, cell_term(light, c, anchor.place.xy, inside != is_behind), c.hit);
        return select(share, -share, is_behind);
    }
    // The face of a sphere turns to the point, its x as near to the caster's as it can be.
    let way = -p;
    let far = length(way);
    let z = way / far;
    let x = normalize(anchor.axis - z * dot(anchor.axis, z));
    let y = cross(z, x);
    let to_anchor = anchor.place - p;
    let center = vec2f(dot(to_anchor, x), dot(to_anchor, y)) * (far / dot(to_anchor, z));
    let on_a = vec3f(dot(a, x), dot(a, y), dot(a, z) / far);
    let on_b = vec3f(dot(b, x), dot(b, y), dot(b, z) / far);
    let c = across_cell(light, on_a, on_b, true);
    return select(0.0, cell_term(light, c, center, inside), c.hit);
}
