// needs: fullscreen, receivers
// The sky, where the camera sees no surface.

struct SkyBehind {
    eye: Eye,
    // Rows of the rotation from the world into the sky.
    sky_from_world: array<vec4f, 3>,
    intensity: f32,
    // Rows of the picture from pole to pole, and what is added to their number.
    rows: f32,
    first_row: f32,
    spare: f32,
}

@group(1) @binding(0) var<uniform> sky_behind: SkyBehind;
// Equirectangular: see `umbrage_core::environment`.
@group(1) @binding(1) var sky_texture: texture_2d<f32>;

const PI: f32 = 3.14159265;

fn texel(at: vec2i, size: vec2i) -> vec3f {
    let x = (at.x + size.x) % size.x;
    return textureLoad(sky_texture, vec2i(x, clamp(at.y, 0, size.y - 1)), 0).rgb;
}

fn sky(direction: vec3f) -> vec3f {
    let size = vec2i(textureDimensions(sky_texture));
    let u = atan2(direction.x, -direction.z) / (2.0 * PI) + 0.5;
    let v = atan2(length(direction.xz), direction.y) / PI;
    let place = vec2f(u * f32(size.x) - 0.5, v * sky_behind.rows + sky_behind.first_row);
    let low = vec2i(floor(place));
    let part = place - floor(place);
    let above = mix(texel(low, size), texel(low + vec2i(1, 0), size), part.x);
    let below = mix(texel(low + vec2i(0, 1), size), texel(low + vec2i(1, 1), size), part.x);
    return mix(above, below, part.y) * sky_behind.intensity;
}

@fragment
fn backdrop(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let depth = textureLoad(receiver_depth, vec2i(at.xy), 0);
    let sight = normalize(line_of_sight(sky_behind.eye, at.xy));
    let rows = sky_behind.sky_from_world;
    let direction = vec3f(dot(rows[0].xyz, sight), dot(rows[1].xyz, sight), dot(rows[2].xyz, sight));
    let seen = min(sky(direction), vec3f(65504.0));
    return select(vec4f(0.0), vec4f(seen, 1.0), depth == sky_behind.eye.background_depth);
}
