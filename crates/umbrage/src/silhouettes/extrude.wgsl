// needs: instances, edges
// Shadow volumes as triangles: sides between an edge and its shadow, light caps, dark caps.
//
// All corners come from the same two functions, so that neighbours share them to the last bit and
// volumes are closed. An instance draws 64 sides of four vertices, or 64 caps of six; what is left
// of the last one falls off the screen.

struct Extrusion {
    clip_from_world: mat4x4f,
    // Relative to the same origin as instances; w = 0: the direction to it.
    light: vec4f,
    // How far volumes are moved away from the eye: a share of the depth, and an amount.
    away: vec2f,
    pad: vec2f,
}

struct Corner {
    @invariant @builtin(position) position: vec4f,
    // How often it counts.
    @location(0) @interpolate(flat) times: f32,
}

// Header, chunks and entries, see `HEADER`.
@group(0) @binding(1) var<storage, read> list: array<u32>;
@group(0) @binding(2) var<uniform> extrusion: Extrusion;
@group(1) @binding(2) var<storage, read> positions: array<f32>;
@group(1) @binding(3) var<storage, read> indices: array<u32>;
@group(1) @binding(4) var<storage, read> instances: array<Instance>;

override WEIGHTED: bool = false;

// Vertex numbers of each part, or time that all edges are drawn, start at a multiple of this.
const PART: u32 = 512u;

const NO_ENTRY: u32 = 0xffffffffu;

// Off the screen, so that the triangle is dropped.
const NOWHERE: Corner = Corner(vec4f(2.0, 2.0, 0.0, 1.0), 0.0);

fn light_corner(caster: u32, vertex: u32) -> vec3f {
    let at = 3u * vertex;
    return world_from_mesh(casters[caster].instance, vec3f(positions[at], positions[at + 1u], positions[at + 2u]));
}

// Where the shadow of a corner ends: at the plane that nothing seen lies beyond, at the caster's
// reach, or infinitely far away (w = 0; GG 9.5.3).
fn dark_corner(caster: u32, p: vec3f) -> vec4f {
    let away = p * extrusion.light.w - extrusion.light.xyz;
    let end = casters[caster].end;
    let toward_end = dot(end.xyz, away);
    if toward_end > 0.0 {
        return vec4f(p + away * max((end.w - dot(end.xyz, p)) / toward_end, 0.0), 1.0);
    }
    let reach = casters[caster].reach;
    if reach == 0.0 {
        return vec4f(away, 0.0);
    }
    return vec4f(extrusion.light.xyz + away * (max(reach, length(away)) / length(away)), 1.0);
}

// Caps, and sides at their edge, coincide with the surface that casts them, which has to be in
// front whatever was rounded.
fn on_screen(p: vec4f, times: f32) -> Corner {
    let at = extrusion.clip_from_world * p;
    return Corner(vec4f(at.xy, at.z + extrusion.away.x * at.z + extrusion.away.y * at.w, at.w), times);
}

// Corner 0…3 of a quad: end, start, start's shadow, end's shadow, counter-clockwise seen from
// outside. With parallel light both shadows are one point, and the quad is drawn as one triangle
// (GG 9.5.1).
fn side_corner(entry: u32, corner: u32) -> Corner {
    let slot = entry >> 2u;
    let caster = list[HEADER + slot / CHUNK];
    let edge = edges[casters[caster].first_edge + slot - casters[caster].edge_chunk * CHUNK];
    let is_turned = ((entry & 1u) != 0u) != ((casters[caster].flags & MIRRORED) != 0u);
    let is_start = corner == 1u || corner == 2u;
    let p = light_corner(caster, select(edge.end, start_of(edge), is_start != is_turned));
    let times = select(1.0, 2.0, WEIGHTED && (entry & 2u) != 0u);
    if corner >= 2u {
        return on_screen(dark_corner(caster, p), times);
    }
    return on_screen(vec4f(p, 1.0), times);
}

// Corner 0…2 of the light cap, 3…5 of the dark one, which is turned round.
fn cap_corner(entry: u32, corner: u32) -> Corner {
    let slot = entry >> 2u;
    let caster = list[HEADER + slot / CHUNK];
    let flags = casters[caster].flags;
    let is_dark = corner >= 3u;
    if (flags & select(LIGHT_CAP, DARK_CAP, is_dark)) == 0u {
        return NOWHERE;
    }
    let triangle = slot - casters[caster].triangle_chunk * CHUNK;
    let is_turned = (((entry & 1u) != 0u) != ((flags & MIRRORED) != 0u)) != is_dark;
    let k = corner % 3u;
    let place = select(k, (3u - k) % 3u, is_turned);
    let vertex = casters[caster].base_vertex + indices[casters[caster].first_index + 3u * triangle + place];
    let p = light_corner(caster, vertex);
    if is_dark {
        return on_screen(dark_corner(caster, p), 1.0);
    }
    return on_screen(vec4f(p, 1.0), 1.0);
}

// The entry of a list that a vertex belongs to.
fn listed(vertex: u32, group: u32, corners: u32) -> u32 {
    let part = vertex / PART;
    let at = group * CHUNK + (vertex % PART) / corners;
    return select(NO_ENTRY, list[list[2u * part] + at], at < list[2u * part + 1u]);
}

@vertex
fn listed_side(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Corner {
    let entry = listed(vertex, group, 4u);
    if entry == NO_ENTRY {
        return NOWHERE;
    }
    return side_corner(entry, vertex % 4u);
}

@vertex
fn listed_cap(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Corner {
    let entry = listed(vertex, group, 6u);
    if entry == NO_ENTRY {
        return NOWHERE;
    }
    return cap_corner(entry, (vertex % PART) % 6u);
}

// The side at an edge, where that bounds the shadow more than `before` times.
fn side_at(slot: u32, before: u32) -> u32 {
    let caster = list[HEADER + slot / CHUNK];
    let edge = slot - casters[caster].edge_chunk * CHUNK;
    if edge >= casters[caster].edge_count {
        return NO_ENTRY;
    }
    let times = multiplicity(caster, pairs[casters[caster].first_edge + edge]);
    return select(NO_ENTRY, side_entry(slot, times), u32(abs(times)) > before);
}

// Every edge is drawn, and falls together to nothing where it bounds no shadow: the degenerate
// quads of PX 3.3.3, except that edges are fetched instead of copied. The second part is for sides
// that count twice.
@vertex
fn any_side(@builtin(vertex_index) vertex: u32, @builtin(instance_index) chunk: u32) -> Corner {
    let entry = side_at(chunk * CHUNK + (vertex % PART) / 4u, vertex / PART);
    if entry == NO_ENTRY {
        return NOWHERE;
    }
    return side_corner(entry, vertex % 4u);
}

@vertex
fn any_cap(@builtin(vertex_index) vertex: u32, @builtin(instance_index) chunk: u32) -> Corner {
    let slot = chunk * CHUNK + vertex / 6u;
    let caster = list[HEADER + chunk];
    let triangle = slot - casters[caster].triangle_chunk * CHUNK;
    if triangle >= casters[caster].triangle_count {
        return NOWHERE;
    }
    let plane = plane_at(casters[caster].first_triangle + triangle);
    let f = facing(plane, casters[caster].light);
    if all(plane.xyz == vec3f(0.0)) || (f > 0 && (casters[caster].flags & AWAY) != 0u) {
        return NOWHERE;
    }
    return cap_corner(cap_entry(slot, f < 0), vertex % 6u);
}
