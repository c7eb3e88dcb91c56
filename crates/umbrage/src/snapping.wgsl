// Triangles whose depth is known.

@vertex
fn corner(@location(0) position: vec4f) -> @builtin(position) vec4f {
    return position;
}
