// needs: casters, materials, pack_normal
// Depth, normals and materials of the visible surfaces.

struct GBufferView {
    // World space is that of the instances, relative to the scene's origin; so is the eye.
    clip_from_world: mat4x4f,
    eye: vec3f,
    spare: f32,
    ambient: vec3f,
    more_spare: f32,
    // Along the view where lines of sight are parallel; else zero.
    sight: vec3f,
    last_spare: f32,
}

@group(0) @binding(0) var<uniform> gbuffer_view: GBufferView;

struct Surface {
    // Shadow volumes are compared with it where they touch the surface that casts them.
    @invariant @builtin(position) position: vec4f,
    @location(0) from_eye: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec3f,
    @location(3) @interpolate(flat) instance: u32,
}

struct Targets {
    // Geometric normal turned to the eye, packed.
    @location(0) normal: u32,
    // Shading normal; shininess, negative where no shadow falls.
    @location(1) shading: vec4f,
    // Base colour; specular strength.
    @location(2) color: vec4f,
    @location(3) radiance: vec4f,
}

@vertex
fn vertex(
    @location(0) position: vec3f,
    @location(1) instance: u32,
    @location(2) normal: vec3f,
    @location(3) uv: vec3f,
) -> Surface {
    let world = world_from_mesh(instance, position);
    return Surface(
        gbuffer_view.clip_from_world * vec4f(world, 1.0),
        world - gbuffer_view.eye,
        world_normal_from_mesh(instance, normal),
        uv,
        instance,
    );
}

fn targets(in: Surface, base: vec4f) -> Targets {
    // The triangle's own normal, from how the position changes over the screen; never along the
    // line of sight.
    let cross_product = cross(dpdx(in.from_eye), dpdy(in.from_eye));
    let area = length(cross_product);
    let sight = select(in.from_eye, gbuffer_view.sight, any(gbuffer_view.sight != vec3f(0.0)));
    let face = select(-normalize(sight), cross_product / area, area > 0.0);
    let geometric = select(face, -face, dot(face, sight) > 0.0);
    let steepness = length(in.normal);
    let smooth_normal = select(geometric, in.normal / steepness, steepness > 0.0);
    let shading = select(smooth_normal, -smooth_normal, dot(smooth_normal, geometric) < 0.0);
    let material = materials[instances[in.instance].material];
    return Targets(
        pack_normal(geometric, (instances[in.instance].flags & CASTS) != 0u),
        vec4f(shading, select(-material.shininess, material.shininess, (instances[in.instance].flags & RECEIVES) != 0u)),
        vec4f(base.rgb, material.specular),
        vec4f(material.emissive + gbuffer_view.ambient * base.rgb, 1.0),
    );
}

@fragment
fn opaque(in: Surface) -> Targets {
    return targets(in, base_color(instances[in.instance].material, in.uv));
}

@fragment
fn masked(in: Surface) -> Targets {
    let material = instances[in.instance].material;
    let base = base_color(material, in.uv);
    let out = targets(in, base);
    if is_cut_out(material, base.a) {
        discard;
    }
    return out;
}
