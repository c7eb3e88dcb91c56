// needs: map_depth, map_paraboloid
// Depth of the second surface along each ray of the light, behind the first one (Woo; SG "Second
// Depth Shadow Maps").

@group(3) @binding(0) var first_depth: texture_depth_2d;

fn is_first(position: vec4f, stored: f32) -> bool {
    let first = textureLoad(first_depth, vec2i(position.xy), 0);
    return stored >= first - (first * map_view.same.x + map_view.same.y);
}

@fragment
fn second(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    let stored = stored_of(position.z, map_view.farthest);
    if is_first(position, stored) {
        discard;
    }
    return stored;
}

@fragment
fn second_cut_out(in: Masked) -> @builtin(frag_depth) f32 {
    let stored = stored_of(in.position.z, map_view.farthest);
    if is_first(in.position, stored) || is_cut_out(in.material, base_color(in.material, in.uv).a) {
        discard;
    }
    return stored;
}

@fragment
fn second_bent(in: Bent) -> @builtin(frag_depth) f32 {
    let depth = bent_depth(in);
    let stored = stored_of(depth, map_view.farthest);
    if depth == 0.0 || is_first(in.position, stored) {
        discard;
    }
    return stored;
}

@fragment
fn second_bent_cut_out(in: Bent) -> @builtin(frag_depth) f32 {
    let depth = bent_depth(in);
    let stored = stored_of(depth, map_view.farthest);
    let is_gone = is_cut_out(in.material, base_color(in.material, in.uv).a);
    if depth == 0.0 || is_gone || is_first(in.position, stored) {
        discard;
    }
    return stored;
}
