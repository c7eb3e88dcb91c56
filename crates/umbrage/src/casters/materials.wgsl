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

// Colour and opacity at level 0: mip levels would move the edge of a cut-out with distance.
fn base_color(material: u32, uv: vec2f) -> vec4f {
    return materials[material].base_color * textureSampleLevel(base_color_texture, base_color_sampler, uv, 0.0);
}

fn is_cut_out(material: u32, alpha: f32) -> bool {
    return alpha < materials[material].alpha_cutoff;
}
