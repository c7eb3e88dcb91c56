// needs: map_visibility, inspect
// Pictures of what a look-up finds at each pixel. The technique says the colour of one that a map
// covers: `fn picture(point: MapPoint, pixel: Pixel, at: vec4f) -> vec3f`; `PICTURE` is which.

override PICTURE: u32 = 0u;

@fragment
fn inspected(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = pixel_at(at.xy);
    let first = point_by_matrix(pixel, 0u);
    let split = layer_of_pixel(pixel, first);
    let point = map_point(pixel, first, split.layer);
    if !pixel.is_drawn || !point.is_covered || !split.is_covered {
        return vec4f(grey(map.eye, at), 1.0);
    }
    return vec4f(picture(point, pixel, at), 1.0);
}
