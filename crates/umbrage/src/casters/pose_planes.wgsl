// needs: poses
// Planes of triangles that have been bent, for silhouettes.

@group(1) @binding(0) var<storage, read> indices: array<u32>;
@group(1) @binding(1) var<storage, read_write> plane_normals: array<f32>;
@group(1) @binding(2) var<storage, read_write> plane_offsets: array<f32>;

// The plane of a triangle that no edge has, such as a copy of another one.
const LEFT_OUT: vec4f = vec4f(0.0, 0.0, 0.0, -1.0);

// Zero for a triangle without area. Edges are taken relative to the longest coordinate, so that no
// square underflows.
fn plane_of(a: vec3f, b: vec3f, c: vec3f) -> vec4f {
    let e = b - a;
    let f = c - a;
    let longest = max(abs(e), abs(f));
    let size = max(longest.x, max(longest.y, longest.z));
    if size == 0.0 {
        return vec4f(0.0);
    }
    let n = cross(e / size, f / size);
    let area = length(n);
    if area == 0.0 {
        return vec4f(0.0);
    }
    return vec4f(n / area, -dot(n / area, a));
}

@compute @workgroup_size(64)
fn pose_planes(@builtin(global_invocation_id) id: vec3u) {
    let mesh = meshes[id.y];
    if id.x >= mesh.triangle_count {
        return;
    }
    let triangle = mesh.first_triangle + id.x;
    let slot = 3u * triangle;
    let normal = vec3f(plane_normals[slot], plane_normals[slot + 1u], plane_normals[slot + 2u]);
    if all(vec4f(normal, plane_offsets[triangle]) == LEFT_OUT) {
        return;
    }
    let at = mesh.first_index + 3u * id.x;
    let plane = plane_of(
        position_at(mesh.vertex + indices[at]) - mesh.center,
        position_at(mesh.vertex + indices[at + 1u]) - mesh.center,
        position_at(mesh.vertex + indices[at + 2u]) - mesh.center,
    );
    plane_normals[slot] = plane.x;
    plane_normals[slot + 1u] = plane.y;
    plane_normals[slot + 2u] = plane.z;
    plane_offsets[triangle] = plane.w;
}
