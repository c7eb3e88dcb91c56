// The light as a point sees it: what takes differences of places to the face's coordinates, homogeneous (x, y, w), with w = 1 in the
// light's plane.

struct Seen {
    x: vec3f,
    y: vec3f,
    w: vec3f,
    // 1 where those are right-handed, −1 where they are not.
    hand: f32,
}

// Two unit vectors that make a right-handed system with a third one (Duff et al. 2017).
fn across(z: vec3f) -> array<vec3f, 2> {
    let s = select(-1.0, 1.0, z.z >= 0.0);
    let a = -1.0 / (s + z.z);
    let b = z.x * z.y * a;
    return array<vec3f, 2>(vec3f(1.0 + s * z.x * z.x * a, s * b, -s * z.x), vec3f(b, s + z.y * z.y * a, -z.y));
}

fn transposed(light: WedgeLight, d: vec3f) -> vec3f {
    return light.linear[0].xyz * d.x + light.linear[1].xyz * d.y + light.linear[2].xyz * d.z;
}

fn flat_light(to_light: vec3f, x: vec3f, y: vec3f, n: vec3f) -> Seen {
    let distance = dot(n, to_light);
    let w = n / distance;
    return Seen(x - w * dot(x, to_light), y - w * dot(y, to_light), w, sign(distance));
}

fn light_from(light: WedgeLight, p: vec3f) -> Seen {
    if light.parallel != 0u {
        return Seen(light.axes[0].xyz, light.axes[1].xyz, light.axes[2].xyz, 1.0);
    }
    let to_light = light.center.xyz - p;
    if light.face == BALL {
        let far = light_linear(light, to_light);
        let distance = length(far);
        let way = far / distance;
        let xy = across(way);
        return Seen(transposed(light, xy[0]), transposed(light, xy[1]), transposed(light, way / distance), 1.0);
    }
    var y = light.axes[1].xyz;
    var n = light.axes[2].xyz;
    if light.face == LINE {
        // The face turns to whoever looks.
        let x = light.axes[0].xyz;
        n = normalize(to_light - x * (dot(x, to_light) / dot(x, x)));
        y = cross(n, x) * light.axes[1].w;
    }
    return flat_light(to_light, light.axes[0].xyz, y, n);
}

fn on_face(seen: Seen, d: vec3f) -> vec3f {
    return vec3f(dot(seen.x, d), dot(seen.y, d), dot(seen.w, d));
}
