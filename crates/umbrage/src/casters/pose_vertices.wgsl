// needs: poses
// Linear blend skinning: a vertex goes where the mean of its joints' matrices takes it.

struct JointRows {
    row0: vec4f,
    row1: vec4f,
    row2: vec4f,
}

// Normal, texture coordinate, opacity. Normals have a pass of their own, so that neither pass has
// more than the four storage buffers that the smallest devices allow.
@group(0) @binding(2) var<storage, read_write> attributes: array<f32>;
@group(1) @binding(0) var<storage, read> joints: array<JointRows>;
// Where the joints of each vertex start in here; then pairs of a joint and the bits of its weight.
@group(1) @binding(1) var<storage, read> weights: array<u32>;

const ATTRIBUTES: u32 = 6u;

// What a vertex's joints do together; nothing where none holds it.
fn bend_of(mesh: PosedMesh, vertex: u32) -> JointRows {
    let start = weights[mesh.first_start + vertex];
    let end = weights[mesh.first_start + vertex + 1u];
    if start == end {
        return JointRows(vec4f(1.0, 0.0, 0.0, 0.0), vec4f(0.0, 1.0, 0.0, 0.0), vec4f(0.0, 0.0, 1.0, 0.0));
    }
    var sum = JointRows(vec4f(0.0), vec4f(0.0), vec4f(0.0));
    for (var i = start; i < end; i += 2u) {
        let joint = joints[mesh.first_joint + weights[i]];
        let weight = bitcast<f32>(weights[i + 1u]);
        sum.row0 += weight * joint.row0;
        sum.row1 += weight * joint.row1;
        sum.row2 += weight * joint.row2;
    }
    return sum;
}

// Takes a normal along: by the cofactors, which exist also where there is no inverse.
fn bent_normal(bend: JointRows, normal: vec3f) -> vec3f {
    let a = bend.row0.xyz;
    let b = bend.row1.xyz;
    let c = bend.row2.xyz;
    let n = vec3f(dot(cross(b, c), normal), dot(cross(c, a), normal), dot(cross(a, b), normal));
    let size = length(n);
    let turned = select(n, -n, dot(a, cross(b, c)) < 0.0);
    return select(vec3f(0.0, 1.0, 0.0), turned / size, size > 0.0);
}

@compute @workgroup_size(64)
fn pose_vertices(@builtin(global_invocation_id) id: vec3u) {
    let mesh = meshes[id.y];
    if id.x >= mesh.vertex_count {
        return;
    }
    let bend = bend_of(mesh, id.x);
    let vertex = mesh.vertex + id.x;
    let p = vec4f(position_at(mesh.bound_vertex + id.x), 1.0);
    positions[3u * vertex] = dot(bend.row0, p);
    positions[3u * vertex + 1u] = dot(bend.row1, p);
    positions[3u * vertex + 2u] = dot(bend.row2, p);
}

@compute @workgroup_size(64)
fn pose_normals(@builtin(global_invocation_id) id: vec3u) {
    let mesh = meshes[id.y];
    if id.x >= mesh.vertex_count {
        return;
    }
    let from_at = ATTRIBUTES * (mesh.bound_vertex + id.x);
    let normal = vec3f(attributes[from_at], attributes[from_at + 1u], attributes[from_at + 2u]);
    let n = bent_normal(bend_of(mesh, id.x), normal);
    let vertex = mesh.vertex + id.x;
    attributes[ATTRIBUTES * vertex] = n.x;
    attributes[ATTRIBUTES * vertex + 1u] = n.y;
    attributes[ATTRIBUTES * vertex + 2u] = n.z;
}
