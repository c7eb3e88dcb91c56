// The buffer holds the depth of the camera's projection.

fn depth_of(stored: f32) -> f32 {
    return stored;
}
