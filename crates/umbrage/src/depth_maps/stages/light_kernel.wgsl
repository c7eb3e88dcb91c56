// needs: map_lookup
// The light's surface as a receiver sees it through the map: which texels hide which points of it.
//
// A blocker at share t of the way from the receiver p to the point c + e of a light around c stands
// where the view from c shows p + r e, with r = t / (1 − t): its *reach*. Texels are homogeneous
// and linear there, so a light of any shape and orientation, seen at one reach, is a small picture
// of itself in the map. That is the penumbra's width as a length at the receiver, (d_receiver −
// d_blocker) / d_blocker · w_light (ZA 3.5), brought to the map. For parallel light r is the
// distance along the light, and e the tangent of an angle.

struct LightKernel {
    // Texels per reach along the light's two half axes.
    right: vec2f,
    up: vec2f,
    // How much nearer to the light's own plane a point at these axes is, per reach: perspective.
    nearer: vec2f,
    // Change of stored depth per texel along the plane through the receiver that is parallel to the
    // light's.
    facing: vec2f,
    // Of a paraboloid: what bends that.
    facing_bend: f32,
    // The light's centre and half axes above the receiver's plane. A point of it is below the
    // horizon where they add up to less than 0.
    horizon: vec3f,
    // From the receiver to the light's centre (1 for parallel light), and from there to its
    // farthest point.
    distance: f32,
    radius: f32,
}

// Cosine between the ways to a flat light and along its plane below which the light counts as
// tilted by this much: seen edge-on, depth has no slope along its plane.
const EDGE_ON: f32 = 0.15;

fn any_perpendicular(v: vec3f) -> vec3f {
    return normalize(select(vec3f(v.y, -v.x, 0.0), vec3f(0.0, v.z, -v.y), abs(v.x) < abs(v.z)));
}

fn light_kernel(point: MapPoint, pixel: Pixel) -> LightKernel {
    let way = (map.from_light * pixel.place).xyz / -pixel.w;
    var right = map.light.right;
    var up = map.light.up;
    var normal = map.light.unit_ahead;
    if ROUND {
        // The disc across the way, in the space where the light is a sphere.
        let unit = normalize(vec3f(dot(way, map.light.unit_right), dot(way, map.light.unit_up), dot(way, map.light.unit_ahead)));
        let a = any_perpendicular(unit);
        let b = cross(unit, a);
        right = map.light.right * a.x + map.light.up * a.y + map.light.ahead * a.z;
        up = map.light.right * b.x + map.light.up * b.y + map.light.ahead * b.z;
        normal = way;
    } else if dot(normal, normal) == 0.0 {
        // A line has no plane of its own: the one through it that faces the receiver most.
        normal = way - right * (dot(way, right) / max(dot(right, right), 1e-30));
    }
    let layer = point.layer;
    var kernel: LightKernel;
    kernel.distance = length(way);
    kernel.radius = sqrt(dot(right, right) + dot(up, up));
    let unit = -way / kernel.distance;
    let change_right = texel_change(layer, right, unit);
    let change_up = texel_change(layer, up, unit);
    kernel.right = change_right.xy;
    kernel.up = change_up.xy;
    if PERSPECTIVE {
        let w = vec2f(change_right.z, change_up.z) * point.inverse_w;
        kernel.right = kernel.right * point.inverse_w - point.texel * w.x;
        kernel.up = kernel.up * point.inverse_w - point.texel * w.y;
        kernel.nearer = w;
        let toward = dot(normal, unit);
        let least = select(EDGE_ON, -EDGE_ON, toward < 0.0) * length(normal);
        normal += unit * select(0.0, least - toward, abs(toward) < abs(least));
        let plane = plane_through(point, normal);
        kernel.facing = plane.along / plane.across;
        kernel.facing_bend = plane.bend / plane.across;
    }
    kernel.horizon = vec3f(dot(pixel.surface.normal, way), dot(pixel.surface.normal, right), dot(pixel.surface.normal, up));
    if !pixel.surface.casts {
        kernel.horizon = vec3f(1.0, 0.0, 0.0);
    }
    return kernel;
}

// Texels from the receiver to what would hide the point `at` of the light at this reach.
fn kernel_offset(kernel: LightKernel, at: vec2f, reach: f32) -> vec2f {
    let way = kernel.right * at.x + kernel.up * at.y;
    if PERSPECTIVE {
        return way * (reach / max(1.0 + reach * dot(kernel.nearer, at), 0.1));
    }
    return way * reach;
}

// Reach of a blocker with this stored depth, `offset` texels away.
fn reach_of(point: MapPoint, kernel: LightKernel, offset: vec2f, stored: f32) -> f32 {
    if PERSPECTIVE {
        return stored / max(point.depth + plane_step(point, kernel.facing, kernel.facing_bend, offset), 1e-3 * point.depth) - 1.0;
    }
    return (stored - point.depth) / map.layers[point.layer].per_metre;
}

fn is_above_horizon(kernel: LightKernel, at: vec2f) -> bool {
    return kernel.horizon.x + dot(kernel.horizon.yz, at) > 0.0;
}

// Whether the receiver's plane may cut the light.
fn is_cut_by_horizon(kernel: LightKernel) -> bool {
    return kernel.horizon.x < abs(kernel.horizon.y) + abs(kernel.horizon.z);
}
