// Σ L_i T_i at every point of a part of a scene's transfer.

struct PrtPart {
    // Points of the part.
    count: u32,
    // n².
    functions: u32,
    // Those of other parts are before them.
    first: u32,
    spare: u32,
}

struct PrtMesh {
    // Which of the casters it is; `HIDDEN` for none.
    instance: u32,
    // Where its light begins.
    light: u32,
    // 1 where front and back of its triangles are exchanged.
    turned: u32,
    spare: u32,
}

struct PrtPoint {
    mesh: u32,
    // Twice the vertex, and 1 for its back; in the lowest bit, whether the back takes it over, too.
    place: u32,
}

// 1 for light that keeps its colour on the way, else 3.
override CHANNELS: u32 = 1u;

// Vectors lie in blocks of so many points, number by number.
const BLOCK: u32 = 64u;

@group(0) @binding(0) var<uniform> part: PrtPart;
@group(0) @binding(1) var<storage, read> transfer: array<f32>;
@group(0) @binding(2) var<storage, read> points: array<PrtPoint>;
@group(0) @binding(3) var<storage, read> meshes: array<PrtMesh>;
@group(0) @binding(4) var<storage, read> lights: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> radiance: array<f32>;

@compute @workgroup_size(64)
fn sum(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= part.count {
        return;
    }
    let point = points[id.x];
    let light = meshes[point.mesh].light;
    let step = part.functions * BLOCK;
    let start = (id.x / BLOCK) * step * CHANNELS + id.x % BLOCK;
    var sent = vec3f(0.0);
    for (var i = 0u; i < part.functions; i++) {
        let at = start + i * BLOCK;
        if CHANNELS == 3u {
            sent += lights[light + i].rgb * vec3f(transfer[at], transfer[at + step], transfer[at + 2u * step]);
        } else {
            sent += lights[light + i].rgb * transfer[at];
        }
    }
    let place = 3u * (point.place >> 1u);
    radiance[place] = sent.r;
    radiance[place + 1u] = sent.g;
    radiance[place + 2u] = sent.b;
    if (point.place & 1u) == 0u {
        return;
    }
    radiance[place + 3u] = sent.r;
    radiance[place + 4u] = sent.g;
    radiance[place + 5u] = sent.b;
}
