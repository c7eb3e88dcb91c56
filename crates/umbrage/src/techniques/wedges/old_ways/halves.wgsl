// needs: area_light, record, body
// Cuts the body of every wedge in two along the plane of its hard shadow (PX 4.1).

@group(0) @binding(0) var<uniform> light: AreaLight;
@group(0) @binding(1) var<storage, read> wedges: array<Wedge>;
@group(0) @binding(2) var<storage, read_write> halves: array<Half>;

// Wedges of a workgroup.
const GROUP: u32 = 64u;

// Where a body is cut.
struct Half {
    // In clip space, those between the corners of the front and of the back face.
    corners: array<vec4f, 2>,
    // 1 where the front half is on the side of the hard shadow, else 0; 2 where it is all of the
    // body.
    front_inside: f32,
}

// All of the body is its front half.
fn undivided(number: u32) -> Half {
    let corners = array<vec4f, 2>(wedges[number].corners[3], wedges[number].corners[5]);
    return Half(corners, 2.0);
}

fn divided(number: u32) -> Half {
    let planes = wedges[number].planes;
    let normals = array<vec3f, 4>(planes[0].xyz, planes[1].xyz, planes[2].xyz, planes[3].xyz);
    let sum = normals[0] + normals[1] + normals[2] + normals[3];
    let rays = rays_of(normals);
    let a = wedges[number].start;
    let b = wedges[number].end;
    var starts: array<vec3f, 2>;
    starts[0] = corner_of(select(b, a, dot(normals[2], a - b) <= 0.0), normals[2] + normals[0] + normals[1]);
    starts[1] = corner_of(select(b, a, dot(normals[3], a - b) <= 0.0), normals[3] + normals[0] + normals[1]);
    let end = end_of(starts, ways_of(rays), light.low.xyz, light.high.xyz);
    // Of the plane through the edge and the place where its silhouette is seen from.
    let normal = normalize(cross(way_to(light, wedges[number].anchor.place, a), b - a));
    var half: Half;
    for (var i = 0u; i < 2u; i++) {
        let way = from_light(light, ray(normals[2u + i], normal, sum));
        half.corners[i] = light.clip_from_eye * run(starts[i], way, end);
    }
    half.front_inside = f32(dot(normal, rays[0]) > 0.0);
    return half;
}

@compute @workgroup_size(64)
fn make(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u, @builtin(local_invocation_index) place: u32) {
    let number = (group.x + group.y * groups.x) * GROUP + place;
    if number >= arrayLength(&halves) {
        return;
    }
    // No body holds the wedge, or no plane cuts it.
    let is_whole = all(wedges[number].planes[0].xyz == vec3f(0.0)) || all(wedges[number].plane.xyz == vec3f(0.0));
    if is_whole {
        halves[number] = undivided(number);
    } else {
        halves[number] = divided(number);
    }
}
