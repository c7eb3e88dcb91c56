// needs: map_storage
// What shaders that draw into a layer of a map need to know of it.

struct MapView {
    clip_from_world: mat4x4f,
    // Of a paraboloid: scale and offset from its plane to clip space, and from texels to the plane.
    clip_from_plane: vec4f,
    plane_from_texel: vec4f,
    // How much nearer stored depths may be and still count as the same: relative, and absolute.
    same: vec2f,
    // Depth that linear maps store as 0.
    farthest: f32,
    // Distance of depth 1, metres.
    near: f32,
    // Least |w| of a corner for each unit of |x| or |y|.
    least_w: f32,
    // Texels across and down.
    size: f32,
    pad_a: f32,
    pad_b: f32,
}
