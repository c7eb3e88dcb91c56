// needs: blur
// Blurs columns of what `rows.wgsl` leaves.

@group(1) @binding(3) var rows: texture_2d<u32>;
@group(1) @binding(4) var blurred: texture_storage_2d<r32uint, write>;

// Above and below the picture, its border.
fn values_at(quad: vec2i) -> vec4f {
    let last = i32(textureDimensions(rows).y) - 1;
    let values = vec4f(unpack4xU8(textureLoad(rows, vec2i(quad.x, clamp(quad.y, 0, last)), 0).x));
    return select(select(values, values.xyxy, quad.y < 0), values.zwzw, quad.y > last);
}

@compute @workgroup_size(64)
fn blur_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, groups, index);
    if place.tile < list.blurred {
        let quad = vec2i(tile_at(list.tiles[place.tile]) * BLOCK + place.quad);
        textureStore(blurred, quad, word_of(blurred_quad(quad)));
    }
}
