// needs: poses
// Linear blend skinning: a vertex goes where the mean of its joints' matrices takes it.

struct JointRows {
    row0: vec4f,
    row1: vec4f,
    row2: vec4f,
}

struct HeldBy {
    joint: u32,
    weight: f32,
}

@group(0) @binding(1) var<storage, read> joints: array<JointRows>;
@group(0) @binding(2) var<storage, read> starts: array<u32>;
@group(0) @binding(3) var<storage, read> held: array<HeldBy>;
// Normal, texture coordinate, opacity.
@group(0) @binding(5) var<storage, read_write> attributes: array<f32>;

const ATTRIBUTES: u32 = 6u;

// What a vertex's joints do together; nothing where none holds it.
fn blend(first_joint: u32, start: u32, end: u32) -> JointRows {
    if start == end {
        return JointRows(vec4f(1.0, 0.0, 0.0, 0.0), vec4f(0.0, 1.0, 0.0, 0.0), vec4f(0.0, 0.0, 1.0, 0.0));
    }
    var sum = JointRows(vec4f(0.0), vec4f(0.0), vec4f(0.0));
    for (var i = start; i < end; i++) {
        let joint = joints[first_joint + held[i].joint];
        let weight = held[i].weight;
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
    let start = mesh.first_start + id.x;
    let bend = blend(mesh.first_joint, starts[start], starts[start + 1u]);
    let bound = mesh.bound_vertex + id.x;
    let vertex = mesh.vertex + id.x;
    let p = vec4f(position_at(bound), 1.0);
    positions[3u * vertex] = dot(bend.row0, p);
    positions[3u * vertex + 1u] = dot(bend.row1, p);
    positions[3u * vertex + 2u] = dot(bend.row2, p);
    let from_at = ATTRIBUTES * bound;
    let n = bent_normal(bend, vec3f(attributes[from_at], attributes[from_at + 1u], attributes[from_at + 2u]));
    attributes[ATTRIBUTES * vertex] = n.x;
    attributes[ATTRIBUTES * vertex + 1u] = n.y;
    attributes[ATTRIBUTES * vertex + 2u] = n.z;
}
