// needs: plane_finder
// What is in the shadow of a plane's casters, and in the plane, has no light.

struct Plane {
    @builtin(position) position: vec4f,
    // Handed over, since an index that a pixel could choose makes slow reading.
    @location(0) @interpolate(flat) across: vec4f,
    @location(1) @interpolate(flat) normal: vec4f,
}

// A quad of two triangles.
fn quad(plane: FoundPlane, index: u32) -> Plane {
    var corners = array(0u, 1u, 2u, 0u, 2u, 3u);
    let corner = corners[index];
    let two = plane.corners[corner >> 1u];
    let place = select(two.xy, two.zw, (corner & 1u) == 1u);
    return Plane(vec4f(place, 0.0, 1.0), plane.across, vec4f(plane.normal, plane.snapped));
}

// The instance is the number of the plane.
@vertex
fn around(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Plane {
    return quad(finder.planes[number], index);
}

@vertex
fn around_behind(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Plane {
    return quad(finder.behind[number], index);
}

// Where places are known so coarsely that a pixel may be in several planes, the nearest one counts.
override COARSE: bool = false;
// The host says what casts shadows, along with normals.
override KNOWS_CASTERS: bool = false;

fn is_dark(in: Plane) -> bool {
    let depth = textureLoad(receiver_depth, vec2i(in.position.xy), 0);
    let shown = shown_at(in.position.xy, depth);
    let is_in = depth != finder.eye.background_depth && is_in_plane(shown, in.across, in.normal);
    if !COARSE || !is_in {
        return is_in;
    }
    return !is_nearer_to_another(shown, in.across);
}

// Where the stencil says that shadows fall.
@fragment
fn dark(in: Plane) -> @location(0) f32 {
    if !is_dark(in) {
        discard;
    }
    return 0.0;
}

// On planes that face away from the light.
@fragment
fn dark_behind(in: Plane) -> @location(0) f32 {
    let casts = !KNOWS_CASTERS || (textureLoad(receiver_normal, vec2i(in.position.xy), 0).x & 1u) != 0u;
    if !casts || !is_dark(in) {
        discard;
    }
    return 0.0;
}
