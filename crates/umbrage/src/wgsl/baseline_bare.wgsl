// Reconstruct, project, one compare: a shadow map without any care.

@fragment
fn visibility(@builtin(position) at: vec4f) -> @location(0) f32 {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    let position = position_eye(map.eye, at.xy, depth);
    var layer = 0u;
    if CUBE {
        layer = face_of_cube(position - map.light_eye);
    }
    let p = map.map_from_eye[layer] * vec4f(position, 1.0);
    let stored = textureLoad(map_depth, vec2i(p.xy / p.w), layer, 0);
    return select(0.0, 1.0, p.z / p.w >= stored);
}
