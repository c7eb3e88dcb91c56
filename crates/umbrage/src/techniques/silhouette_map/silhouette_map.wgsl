// needs: map_quick, silhouette_cell
// Looks up a depth map whose texels are moved to where silhouettes are.

// Where all corners agree there is nothing to find out.
fn quick_share(point: MapPoint, pixel: Pixel) -> f32 {
    let lit = lit_at_corners(point, cell_of(point));
    return select(select(-1.0, 0.0, !any(lit)), 1.0, all(lit));
}
