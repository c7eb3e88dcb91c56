//! On which side of a placed mesh's triangles a light is, for meshes that are squeezed flat, too.

use umbrage_core::glam::{DAffine3, DMat3};

/// What tells on which side of a placed mesh's triangles a point is.
#[derive(Clone, Copy)]
pub(crate) struct Sides {
    pub mesh_from_world: DAffine3,
    /// Fronts are wound clockwise in the world.
    pub is_mirrored: bool,
}

impl Sides {
    /// A mesh that is squeezed flat counts as just so thick that its fronts and backs are still
    /// apart. `None` for one that is squeezed to a line or a point, since it shadows nothing.
    pub fn of(world_from_mesh: &DAffine3) -> Option<Self> {
        let m = world_from_mesh.matrix3;
        let columns = [m.x_axis, m.y_axis, m.z_axis];
        let product: f64 = columns.iter().map(|c| c.length()).product();
        let matrix3 = if m.determinant().abs() > 1e-12 * product { m } else { m + thickness(&m)? };
        let thick = DAffine3 { matrix3, ..*world_from_mesh };
        let mesh_from_world = thick.inverse();
        let is_mirrored = matrix3.determinant() < 0.0;
        mesh_from_world.is_finite().then_some(Self { mesh_from_world, is_mirrored })
    }
}

/// What a matrix of rank 2 lacks, a millionth of its size: along the normal of the plane that it
/// maps to, from the direction that it loses. `None` for lower ranks.
fn thickness(m: &DMat3) -> Option<DMat3> {
    let longest_cross = |m: &DMat3| {
        let [a, b, c] = [m.x_axis, m.y_axis, m.z_axis];
        let crosses = [a.cross(b), b.cross(c), c.cross(a)];
        crosses.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
    };
    let size = [m.x_axis, m.y_axis, m.z_axis].iter().map(|c| c.length()).fold(0.0, f64::max);
    let normal = longest_cross(m).filter(|n| n.length() > 1e-12 * size * size)?.normalize();
    let lost = longest_cross(&m.transpose())?.try_normalize()?;
    let share = normal * (1e-6 * size);
    Some(DMat3::from_cols(share * lost.x, share * lost.y, share * lost.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::DVec3;

    fn sides(matrix3: DMat3) -> Option<Sides> {
        Sides::of(&DAffine3::from_mat3_translation(matrix3, DVec3::new(1.0, 2.0, 3.0)))
    }

    #[test]
    fn a_mesh_squeezed_flat_has_two_sides() {
        let turn = DMat3::from_rotation_x(0.3);
        let flat = sides(turn * DMat3::from_diagonal(DVec3::new(2.0, 0.0, 2.0))).expect("sides");
        let above = DVec3::new(1.0, 2.0, 3.0) + turn * DVec3::Y;
        let below = DVec3::new(1.0, 2.0, 3.0) - turn * DVec3::Y;
        let height = |p| flat.mesh_from_world.transform_point3(p).y;
        assert!(height(above) * height(below) < 0.0, "{} {}", height(above), height(below));
        assert!(flat.mesh_from_world.is_finite());
    }

    #[test]
    fn lines_and_points_have_none() {
        assert!(sides(DMat3::from_diagonal(DVec3::X)).is_none());
        assert!(sides(DMat3::ZERO).is_none());
        assert!(sides(DMat3::NAN).is_none());
    }

    #[test]
    fn mirrors_are_known() {
        assert!(sides(DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0))).expect("sides").is_mirrored);
        assert!(!sides(DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1e-7))).expect("sides").is_mirrored);
    }
}
