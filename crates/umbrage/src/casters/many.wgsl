// What draws from a host's buffers take besides: matrices of many instances, and texture
// coordinates without opacity.

// Columns of a matrix to what an instance of the library's places; or three rows, and one of them
// again.
struct Many {
    @location(4) a: vec4f,
    @location(5) b: vec4f,
    @location(6) c: vec4f,
    @location(7) d: vec4f,
}

override ROWS: bool = false;

// False: the third texture coordinate is none.
override HAS_OPACITY: bool = true;

fn placed_by(many: Many, position: vec3f) -> vec3f {
    let p = vec4f(position, 1.0);
    if ROWS {
        return vec3f(dot(many.a, p), dot(many.b, p), dot(many.c, p));
    }
    let x = vec4f(many.a.x, many.b.x, many.c.x, many.d.x);
    let y = vec4f(many.a.y, many.b.y, many.c.y, many.d.y);
    let z = vec4f(many.a.z, many.b.z, many.c.z, many.d.z);
    return vec3f(dot(x, p), dot(y, p), dot(z, p));
}

fn with_opacity(uv: vec3f) -> vec3f {
    return vec3f(uv.xy, select(1.0, uv.z, HAS_OPACITY));
}
