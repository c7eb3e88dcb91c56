// The buffer holds something that the host's `view_distance` takes to distances along the view.

fn depth_of(stored: f32) -> f32 {
    let distance = view_distance(stored);
    let z_w = distance * resolving.z_and_w + resolving.z_and_w_at_eye;
    return select(clamp(z_w.x / z_w.y, 0.0, 1.0), resolving.background, distance >= 1e30);
}
