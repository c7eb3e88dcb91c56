// Counts the shadows that the eye is in: triangles that throw one and lie between eye and light.

struct EyeChunk {
    caster: u32,
    // Its triangles from this one on.
    first: u32,
    // Where they count, see `eye_count`.
    slot: u32,
    pad: u32,
}

@group(1) @binding(2) var<storage, read> positions: array<f32>;
@group(1) @binding(3) var<storage, read> indices: array<u32>;
@group(1) @binding(4) var<storage, read> instances: array<Instance>;
@group(2) @binding(0) var<uniform> light: WedgeLight;
@group(2) @binding(1) var<storage, read> eye_chunks: array<EyeChunk>;
// Of each slot two, see `Wedge::weights`. The first slot is that of all casters that are not drawn apart.
@group(2) @binding(2) var<storage, read_write> eye_count: array<atomic<u32>>;
// Of casters, if the light is split.
@group(2) @binding(3) var<storage, read> anchors: array<Anchor>;

override SPLIT: bool = false;

fn corner(caster: u32, triangle: u32, k: u32) -> vec3f {
    let index = casters[caster].first_index + 3u * triangle + k;
    let at = 3u * (casters[caster].base_vertex + indices[index]);
    let p = vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
    return world_from_mesh(casters[caster].instance, p) + light.eye_from_origin;
}

@compute @workgroup_size(64)
fn count(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u, @builtin(local_invocation_index) place: u32) {
    let number_of_chunk = group.x + group.y * groups.x;
    if number_of_chunk >= light.eye_chunks {
        return;
    }
    let chunk = eye_chunks[number_of_chunk];
    let triangle = chunk.first + place;
    if triangle >= casters[chunk.caster].triangle_count {
        return;
    }
    let number = casters[chunk.caster].first_triangle + triangle;
    if all(planes[number].xyz == vec3f(0.0)) || share(chunk.caster, number) == 0 {
        return;
    }
    let a = corner(chunk.caster, triangle, 0u);
    let b = corner(chunk.caster, triangle, 1u);
    let c = corner(chunk.caster, triangle, 2u);
    var seen_from = middle(light);
    if SPLIT {
        seen_from = anchors[chunk.caster].place;
    }
    let l = light.center + from_light(light, seen_from);
    let sides = vec3f(dot(cross(a, b), l), dot(cross(b, c), l), dot(cross(c, a), l));
    let volume = dot(cross(a, b), c);
    let sum = sides.x + sides.y + sides.z;
    let is_crossed = all(sides >= vec3f(0.0)) || all(sides < vec3f(0.0));
    // The eye is at the origin: the segment meets the plane at this share of the way to the light.
    let t = volume / sum;
    if is_crossed && t > 0.0 && (t < 1.0 || light.parallel != 0u) {
        // On the side of bodies that it belongs to, see `Wedge`.
        let both = (casters[chunk.caster].flags & BODY) == 0u;
        let faces_light = facing(planes[number], casters[chunk.caster].light) > 0;
        if both || faces_light {
            atomicAdd(&eye_count[2u * chunk.slot], 1u);
        }
        if both || !faces_light {
            atomicAdd(&eye_count[2u * chunk.slot + 1u], 1u);
        }
    }
}
