// needs: casters, materials, many, map_view
// Renders casters into a depth map seen from the light.

@group(0) @binding(0) var<uniform> map_view: MapView;

struct Masked {
    @invariant @builtin(position) position: vec4f,
    @location(0) uv: vec3f,
    @location(1) @interpolate(flat) material: u32,
}

// Corners level with the light are moved off its plane by less than the rounding of depths: some
// rasterisers find what they draw of a triangle by the places of its corners, those behind the
// light too, and can't hold one that is infinitely far away.
fn map_position(instance: u32, position: vec3f) -> vec4f {
    var at = map_view.clip_from_world * vec4f(world_from_mesh(instance, position), 1.0);
    let least = map_view.least_w * max(abs(at.x), abs(at.y));
    if abs(at.w) < least {
        at.w = select(-least, least, at.w > 0.0);
    }
    return at;
}

@vertex
fn opaque(@location(0) position: vec3f, @location(1) instance: u32) -> @invariant @builtin(position) vec4f {
    return map_position(instance, position);
}

@vertex
fn masked(@location(0) position: vec3f, @location(1) instance: u32, @location(3) uv: vec3f) -> Masked {
    return Masked(map_position(instance, position), with_opacity(uv), instances[instance].material);
}

@vertex
fn opaque_many(
    @location(0) position: vec3f,
    @location(1) instance: u32,
    many: Many,
) -> @invariant @builtin(position) vec4f {
    return map_position(instance, placed_by(many, position));
}

@vertex
fn masked_many(
    @location(0) position: vec3f,
    @location(1) instance: u32,
    @location(3) uv: vec3f,
    many: Many,
) -> Masked {
    let at = map_position(instance, placed_by(many, position));
    return Masked(at, with_opacity(uv), instances[instance].material);
}

@fragment
fn cut_out(in: Masked) {
    if is_cut_out(in.material, base_color(in.material, in.uv).a) {
        discard;
    }
}

// Where maps are linear: `position.z` is near / distance.
@fragment
fn written(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return stored_of(position.z, map_view.farthest);
}

@fragment
fn written_cut_out(in: Masked) -> @builtin(frag_depth) f32 {
    if is_cut_out(in.material, base_color(in.material, in.uv).a) {
        discard;
    }
    return stored_of(in.position.z, map_view.farthest);
}
