// Meshes whose joints have moved, and the vertices of all meshes.

struct PosedMesh {
    // Where the mesh as it was bound starts, and where it is to lie bent.
    bound_vertex: u32,
    vertex: u32,
    vertex_count: u32,
    // In `weights`, one a vertex and one more.
    first_start: u32,
    first_joint: u32,
    // Of its triangles in the index buffer, and of their planes.
    first_index: u32,
    first_triangle: u32,
    triangle_count: u32,
    // What planes are relative to.
    center: vec3f,
    pad: u32,
}

@group(0) @binding(0) var<storage, read> meshes: array<PosedMesh>;
@group(0) @binding(1) var<storage, read_write> positions: array<f32>;

fn position_at(vertex: u32) -> vec3f {
    let at = 3u * vertex;
    return vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
}
