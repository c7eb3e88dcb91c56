// Depth of the second surface along each ray of the light, behind the first one (Woo; SG "Second Depth Shadow Maps").

@group(3) @binding(0) var first_depth: texture_depth_2d;

fn is_first(position: vec4f) -> bool {
    let first = textureLoad(first_depth, vec2i(position.xy), 0);
    return position.z >= first - (first * map_view.same.x + map_view.same.y);
}

@fragment
fn second(@builtin(position) position: vec4f) {
    if is_first(position) {
        discard;
    }
}

@fragment
fn second_cut_out(in: Masked) {
    if is_first(in.position) || is_cut_out(in.material, base_color(in.material, in.uv).a) {
        discard;
    }
}
