// Blurs columns of what `rows.wgsl` leaves.

@group(1) @binding(2) var blurred_rows: texture_2d<u32>;
@group(1) @binding(3) var blurred: texture_storage_2d<r32uint, write>;

fn quad_at(quad: vec2i) -> vec4u {
    let last = vec2i(textureDimensions(blurred_rows)) - 1;
    return textureLoad(blurred_rows, clamp(quad, vec2i(0), last), 0).xzyw;
}

@compute @workgroup_size(64)
fn columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, groups, index);
    if place.tile < list.blurred {
        let quad = vec2i(tile_at(list.tiles[place.tile]) * BLOCK + place.quad);
        let values = value(blurred_quad(quad, vec2i(0, 1))).xzyw;
        textureStore(blurred, quad, vec4u(pack4x8unorm(values / 255.0)));
    }
}
