// Instances of the scene's meshes: `instances`, which whoever uses this binds. World space here is
// relative to the scene's origin on the host.

struct Instance {
    row0: vec4f,
    row1: vec4f,
    row2: vec4f,
    material: u32,
    flags: u32,
    model: u32,
    spare: u32,
}

const RECEIVES: u32 = 1u;
const CASTS: u32 = 2u;

fn world_from_mesh(instance: u32, position: vec3f) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(instances[instance].row0, p), dot(instances[instance].row1, p), dot(instances[instance].row2, p));
}

// Takes a normal to world space, not normalised: the cofactor matrix, right for any scale and for
// mirroring.
fn world_normal_from_mesh(instance: u32, normal: vec3f) -> vec3f {
    let a = instances[instance].row0.xyz;
    let b = instances[instance].row1.xyz;
    let c = instances[instance].row2.xyz;
    let n = vec3f(dot(cross(b, c), normal), dot(cross(c, a), normal), dot(cross(a, b), normal));
    return select(n, -n, dot(a, cross(b, c)) < 0.0);
}
