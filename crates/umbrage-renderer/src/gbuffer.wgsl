// needs: casters, materials, pack_normal, surface
// Depth, normals and looks of the visible surfaces.

struct GBufferView {
    // World space is that of the instances, relative to the scene's origin; so is the eye.
    clip_from_world: mat4x4f,
    eye: vec3f,
    spare: f32,
    // Along the view where lines of sight are parallel; else zero.
    sight: vec3f,
    last_spare: f32,
}

@group(0) @binding(0) var<uniform> gbuffer_view: GBufferView;

// A surface of one colour. What belongs to its instance is looked up at vertices, of which there
// are fewer than pixels, and where many lanes of a GPU look up the same.
struct Plain {
    // Shadow volumes are compared with it where they touch the surface that casts them.
    @invariant @builtin(position) position: vec4f,
    @location(0) from_eye: vec3f,
    @location(1) normal: vec3f,
    // As `pack_look` leaves it; then 1 where it casts shadows.
    @location(2) @interpolate(flat) look: vec4u,
}

struct Textured {
    @invariant @builtin(position) position: vec4f,
    @location(0) from_eye: vec3f,
    @location(1) normal: vec3f,
    @location(2) @interpolate(flat) look: vec4u,
    @location(3) uv: vec3f,
    // What the texture is multiplied by.
    @location(4) @interpolate(flat) base: vec4f,
    @location(5) @interpolate(flat) alpha_cutoff: f32,
}

struct Targets {
    // Geometric normal turned to the eye, packed.
    @location(0) normal: u32,
    // Shading normal, packed, and the look.
    @location(1) surface: vec4u,
}

fn plain_at(position: vec3f, instance: u32, normal: vec3f) -> Plain {
    let world = world_from_mesh(instance, position);
    let material = instances[instance].material;
    let flags = instances[instance].flags;
    let look = Look(
        materials[material].base_color.rgb,
        materials[material].specular,
        materials[material].shininess,
        (flags & RECEIVES) != 0u,
        materials[material].emissive,
    );
    return Plain(
        gbuffer_view.clip_from_world * vec4f(world, 1.0),
        world - gbuffer_view.eye,
        world_normal_from_mesh(instance, normal),
        vec4u(pack_look(look), u32((flags & CASTS) != 0u)),
    );
}

@vertex
fn plain_vertex(
    @location(0) position: vec3f,
    @location(1) instance: u32,
    @location(2) normal: vec3f,
) -> Plain {
    return plain_at(position, instance, normal);
}

@vertex
fn textured_vertex(
    @location(0) position: vec3f,
    @location(1) instance: u32,
    @location(2) normal: vec3f,
    @location(3) uv: vec3f,
) -> Textured {
    let plain = plain_at(position, instance, normal);
    let material = instances[instance].material;
    return Textured(
        plain.position,
        plain.from_eye,
        plain.normal,
        plain.look,
        uv,
        materials[material].base_color,
        materials[material].alpha_cutoff,
    );
}

fn targets(from_eye: vec3f, normal: vec3f, look: vec4u) -> Targets {
    // The triangle's own normal, from how the position changes over the screen; never along the
    // line of sight.
    let cross_product = cross(dpdx(from_eye), dpdy(from_eye));
    let area = length(cross_product);
    let sight = select(from_eye, gbuffer_view.sight, any(gbuffer_view.sight != vec3f(0.0)));
    let face = select(-normalize(sight), cross_product / area, area > 0.0);
    let geometric = select(face, -face, dot(face, sight) > 0.0);
    let smooth_normal = select(geometric, normal, any(normal != vec3f(0.0)));
    let shading = select(smooth_normal, -smooth_normal, dot(smooth_normal, geometric) < 0.0);
    return Targets(pack_normal(geometric, look.w != 0u), vec4u(pack_normal(shading, false), look.xyz));
}

@fragment
fn plain(in: Plain) -> Targets {
    return targets(in.from_eye, in.normal, in.look);
}

// At level 0, as for masks.
fn texture_color(in: Textured) -> vec4f {
    let texel = textureSampleLevel(base_color_texture, base_color_sampler, in.uv.xy, 0.0);
    return in.base * texel * vec4f(1.0, 1.0, 1.0, in.uv.z);
}

fn colored(in: Textured, base: vec4f) -> Targets {
    return targets(in.from_eye, in.normal, vec4u(pack_base(base.rgb), in.look.yzw));
}

@fragment
fn textured(in: Textured) -> Targets {
    return colored(in, texture_color(in));
}

@fragment
fn masked(in: Textured) -> Targets {
    let base = texture_color(in);
    let out = colored(in, base);
    if base.a < in.alpha_cutoff {
        discard;
    }
    return out;
}
