// needs: blur
// Blurs rows of a visibility target.

@group(1) @binding(3) var source: texture_2d<f32>;
@group(1) @binding(4) var rows: texture_storage_2d<r32uint, write>;

fn values_at(quad: vec2i) -> vec4f {
    let middle = vec2f(2 * quad + 1) / vec2f(textureDimensions(source));
    let values = textureGather(0, source, nearest, middle).wzxy;
    return select(1.0 + 254.0 * values, vec4f(0.0), values == vec4f(OWN_SHADOW));
}

@compute @workgroup_size(64)
fn blur_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, groups, index);
    if place.tile < list.blurred {
        let quad = vec2i(tile_at(list.tiles[place.tile]) * BLOCK + place.quad);
        textureStore(rows, quad, word_of(blurred_quad(quad)));
    }
}

// Tiles that stay as they are, but are read by `blur_columns`.
@compute @workgroup_size(64)
fn copy(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, groups, index);
    if place.tile < list.beside {
        let entry = list.tiles[arrayLength(&list.tiles) - 1u - place.tile];
        let quad = vec2i(tile_at(entry) * BLOCK + place.quad);
        textureStore(rows, quad, word_of(values_at(quad)));
    }
}
