// needs: casters, materials
// Draws the meshes of a bake with what their vertices send out.

struct PrtView {
    // World space is that of the instances, relative to the scene's origin.
    clip_from_world: mat4x4f,
    // By how much depth is rounded: everywhere, and as a share of the distance to its ends.
    rounding: vec2f,
    // 1 where the picture is mirrored.
    mirrored: u32,
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

const HIDDEN: u32 = 0xffffffffu;

@group(0) @binding(0) var<uniform> prt_view: PrtView;
@group(0) @binding(1) var<storage, read> meshes: array<PrtMesh>;
@group(0) @binding(2) var receiver_depth: texture_depth_2d;

struct Sent {
    // As the surfaces that receivers are made of.
    @invariant @builtin(position) position: vec4f,
    @location(0) front: vec3f,
    @location(1) back: vec3f,
    @location(2) uv: vec3f,
    @location(3) @interpolate(flat) mesh: u32,
}

@vertex
fn vertex(
    @location(0) position: vec3f,
    @location(1) uv: vec3f,
    @location(2) mesh: u32,
    @location(3) front: vec3f,
    @location(4) back: vec3f,
) -> Sent {
    let instance = meshes[mesh].instance;
    let is_hidden = instance == HIDDEN;
    let world = world_from_mesh(select(instance, 0u, is_hidden), position);
    let clip = prt_view.clip_from_world * vec4f(world, 1.0);
    // All corners of what is hidden are at one point.
    return Sent(select(clip, vec4f(0.0, 0.0, 0.0, 1.0), is_hidden), front, back, uv, mesh);
}

// What goes to the eye where the receivers show this surface; nothing where something of the
// host's own is before it.
fn sent_to_eye(in: Sent, is_front: bool, base: vec3f) -> vec4f {
    let is_turned = (meshes[in.mesh].turned ^ prt_view.mirrored) != 0u;
    let sent = select(in.back, in.front, is_front != is_turned);
    let depth = in.position.z;
    // Corners of smaller triangles are rounded otherwise: by no more than a pixel of the surface.
    let off = fwidth(depth) + prt_view.rounding.x + prt_view.rounding.y * min(depth, 1.0 - depth);
    let seen = textureLoad(receiver_depth, vec2i(in.position.xy), 0);
    let shown = clamp(base * sent, vec3f(-65504.0), vec3f(65504.0));
    return vec4f(select(vec3f(0.0), shown, abs(seen - depth) <= off), 1.0);
}

@fragment
fn opaque(in: Sent, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let material = instances[meshes[in.mesh].instance].material;
    return sent_to_eye(in, is_front, base_color(material, in.uv).rgb);
}

@fragment
fn masked(in: Sent, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let material = instances[meshes[in.mesh].instance].material;
    let base = base_color(material, in.uv);
    let sent = sent_to_eye(in, is_front, base.rgb);
    if is_cut_out(material, base.a) {
        discard;
    }
    return sent;
}
