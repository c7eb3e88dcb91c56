//! Matrices of hosts in single precision, as arrays of columns: what `glam`, `nalgebra`, `cgmath`
//! and `ultraviolet` give with `into()`, or with a method of that name.

use glam::{DAffine3, DMat4, DVec3, Mat4};

/// A matrix, such as a projection.
pub fn matrix(columns: [[f32; 4]; 4]) -> DMat4 {
    Mat4::from_cols_array_2d(&columns).as_dmat4()
}

/// A placement or a view transform. The last row is taken to be 0, 0, 0, 1.
///
/// ```
/// use umbrage_core::{CameraView, columns};
/// # let (x, y) = ([1.0f32, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]);
/// # let projection = [x, y, [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
/// let view = [x, y, [0.0, 0.0, 1.0, 0.0], [0.0, -1.7, -5.0, 1.0]];
/// let camera = CameraView::from_matrices(columns::affine(view), columns::matrix(projection));
/// assert!((camera.eye.z - 5.0).abs() < 1e-6 && camera.forward().z == -1.0);
/// ```
pub fn affine(columns: [[f32; 4]; 4]) -> DAffine3 {
    let [x, y, z, w] = columns.map(|[x, y, z, _]| DVec3::new(x.into(), y.into(), z.into()));
    DAffine3 { matrix3: glam::DMat3::from_cols(x, y, z), translation: w }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stay_columns() {
        let columns = [[1.0, 2.0, 3.0, 0.0], [4.0, 5.0, 6.5, 0.0], [7.0, 8.0, 9.0, 0.0], [10.0, 11.0, 12.0, 1.0]];
        assert_eq!(matrix(columns), DMat4::from(affine(columns)));
        assert_eq!(affine(columns).transform_point3(DVec3::X), DVec3::new(11.0, 13.0, 15.0));
    }
}
