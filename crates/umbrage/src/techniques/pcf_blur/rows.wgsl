// Blurs rows of a visibility target.

@group(1) @binding(2) var source: texture_2d<f32>;
@group(1) @binding(3) var nearest: sampler;
@group(1) @binding(4) var blurred_rows: texture_storage_2d<rgba32uint, write>;

fn quad_at(quad: vec2i) -> vec4u {
    let at = vec2f(2 * quad + 1) / vec2f(textureDimensions(source));
    let value = textureGather(0, source, nearest, at).wzxy;
    let depth = textureGather(receiver_depth, nearest, at).wzxy;
    let words = bitcast<vec4u>(abs(depth - blur.background_depth)) & vec4u(~(SIGN | VALUE));
    return words | vec4u(value * 255.0 + 0.5) | select(vec4u(0u), vec4u(SIGN), value == vec4f(OWN_SHADOW));
}

@compute @workgroup_size(64)
fn rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, groups, index);
    if place.tile < list.blurred {
        let quad = vec2i(tile_at(list.tiles[place.tile]) * BLOCK + place.quad);
        let pixels = blurred_quad(quad, vec2i(1, 0));
        textureStore(blurred_rows, quad, (pixels.words & vec4u(~VALUE)) | vec4u(value(pixels) + 0.5));
    }
}

// What stays as it is, but is read by `columns`.
@compute @workgroup_size(64)
fn beside(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, groups, index);
    if place.tile < list.beside {
        let entry = list.tiles[arrayLength(&list.tiles) - 1u - place.tile];
        let quad = vec2i(tile_at(entry) * BLOCK + place.quad);
        textureStore(blurred_rows, quad, quad_at(quad));
    }
}
