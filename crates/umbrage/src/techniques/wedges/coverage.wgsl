// What a directed edge adds to the covered share of a face apart from the hard shadow: see `coverage` in the core crate.

const PI: f32 = 3.14159265358979;

struct Chord {
    start: vec2f,
    end: vec2f,
    // 1 where the centre is on its left, −1 on its right, 0 where the edge misses the face.
    side: f32,
}

const NO_CHORD: Chord = Chord(vec2f(0.0), vec2f(0.0), 0.0);

// `inside` decides on which side the centre is; `beyond`: places may lie behind the light.
fn chord(is_square: bool, start: vec3f, end: vec3f, inside: bool, beyond: bool) -> Chord {
    var a = start;
    var b = end;
    if beyond {
        if a.z > 1.0 && b.z > 1.0 {
            return NO_CHORD;
        }
        let cut = mix(a, b, (1.0 - a.z) / (b.z - a.z));
        if a.z > 1.0 {
            a = cut;
        } else if b.z > 1.0 {
            b = cut;
        }
    }
    let side = select(-1.0, 1.0, inside);
    if is_square {
        return across_square(a, b, side);
    }
    return across_disc(a, b, side);
}

fn across_disc(a: vec3f, b: vec3f, side: f32) -> Chord {
    let n = cross(a, b);
    let square = dot(n.xy, n.xy);
    if !(square > n.z * n.z) || max(a.z, b.z) <= 0.0 {
        return NO_CHORD;
    }
    let per_length = inverseSqrt(square);
    let distance = n.z * per_length;
    let half = sqrt(max(1.0 - distance * distance, 0.0));
    let along = vec2f(n.y, -n.x) * per_length;
    // What comes from behind the observer comes from infinitely far away.
    let start = select(-half, max(dot(a.xy, along) / a.z, -half), a.z > 0.0);
    let end = select(half, min(dot(b.xy, along) / b.z, half), b.z > 0.0);
    if !(start < end) {
        return NO_CHORD;
    }
    let foot = n.xy * (-distance * per_length);
    return Chord(foot + along * start, foot + along * end, side);
}

fn across_square(a: vec3f, b: vec3f, side: f32) -> Chord {
    let at_a = vec4f(a.z + a.x, a.z - a.x, a.z + a.y, a.z - a.y);
    let at_b = vec4f(b.z + b.x, b.z - b.x, b.z + b.y, b.z - b.y);
    if any((at_a < vec4f(0.0)) & (at_b < vec4f(0.0))) {
        return NO_CHORD;
    }
    let cut = at_a / (at_a - at_b);
    let enters = select(vec4f(0.0), cut, at_a < vec4f(0.0));
    let leaves = select(vec4f(1.0), cut, at_b < vec4f(0.0));
    let start = max(max(enters.x, enters.y), max(enters.z, enters.w));
    let end = min(min(leaves.x, leaves.y), min(leaves.z, leaves.w));
    if !(start < end) {
        return NO_CHORD;
    }
    let p = mix(a, b, start);
    let q = mix(a, b, end);
    return Chord(p.xy / p.z, q.xy / q.z, side);
}

// An angle that is near half a turn has the sign of the side that the centre is on.
fn signed(angle: f32, quarter: f32, side: f32) -> f32 {
    return select(angle, side * abs(angle), abs(angle) > quarter);
}

fn cross2(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

fn on_disc(c: Chord) -> f32 {
    let area = cross2(c.start, c.end);
    return (area - signed(atan2(area, dot(c.start, c.end)), 0.5 * PI, c.side)) / (2.0 * PI);
}

// The share 0…1 of the way around the square where the ray through a point leaves it.
fn around_square(p: vec2f) -> f32 {
    let longest = max(abs(p.x), abs(p.y));
    let at = p / max(longest, 1e-30);
    let right_or_left = select(5.0 - at.y, 1.0 + at.y, at.x > 0.0);
    let up_or_down = select(7.0 + at.x, 3.0 - at.x, at.y > 0.0);
    return select(up_or_down, right_or_left, abs(p.x) >= abs(p.y)) / 8.0;
}

fn turn_on_square(c: Chord) -> f32 {
    let turn = around_square(c.end) - around_square(c.start);
    return signed(turn - round(turn), 0.25, c.side);
}

fn on_square(c: Chord) -> f32 {
    return cross2(c.start, c.end) / 8.0 - turn_on_square(c);
}
