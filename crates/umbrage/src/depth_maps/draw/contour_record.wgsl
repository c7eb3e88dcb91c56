// An edge that bounds the shadow of a caster, as compute found it.

// Relative to the casters' origin. Seen from the light it runs with the shadow on its left.
struct ContourRecord {
    start: vec3f,
    // How many surfaces end here; 0 for none.
    times: f32,
    end: vec3f,
    pad: f32,
}
