// A depth buffer with one sample a pixel.

@group(0) @binding(1) var depth_of_host: texture_depth_2d;

fn host_depth(at: vec2i) -> f32 {
    return textureLoad(depth_of_host, at, 0);
}
