// Appearance of instances, and the alpha mask that cuts holes into them.

struct Material {
    base_color: vec4f,
    emissive: vec3f,
    alpha_cutoff: f32,
    specular: f32,
    shininess: f32,
    spare: vec2f,
}

@group(1) @binding(1) var<storage, read> materials: array<Material>;
@group(2) @binding(0) var base_color_texture: texture_2d<f32>;
@group(2) @binding(1) var base_color_sampler: sampler;

// Colour and opacity at texture coordinate `uv.xy`, where the vertices have the opacity `uv.z`. At
// level 0: mip levels would move the edge of a cut-out with distance.
fn base_color(material: u32, uv: vec3f) -> vec4f {
    let texel = textureSampleLevel(base_color_texture, base_color_sampler, uv.xy, 0.0);
    return materials[material].base_color * texel * vec4f(1.0, 1.0, 1.0, uv.z);
}

fn is_cut_out(material: u32, alpha: f32) -> bool {
    return alpha < materials[material].alpha_cutoff;
}
