// needs: fullscreen, receivers, map_layers
// Project, one compare: a shadow map without any care.

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let ndc = ndc_of(map.eye, at.xy, textureLoad(receiver_depth, vec2i(at.xy), 0));
    var layer = 0u;
    if LAYOUT == CUBE {
        layer = face_of_cube((map.from_light * ndc).xyz);
    }
    let p = map.layers[layer].map_from_place * ndc;
    let stored = textureLoad(map_depth, vec2i(p.xy / p.w), layer, 0);
    return select(0.0, 1.0, p.z / p.w >= stored);
}
