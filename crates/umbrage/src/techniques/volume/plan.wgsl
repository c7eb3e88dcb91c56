// Coloured triangles in a plan of the scene.

struct Painted {
    @builtin(position) position: vec4f,
    @location(0) color: vec4f,
}

@vertex
fn place(@location(0) at: vec2f, @location(1) color: vec4f) -> Painted {
    return Painted(vec4f(at, 0.0, 1.0), color);
}

@fragment
fn paint(in: Painted) -> @location(0) vec4f {
    return in.color;
}
