//! The light of every mesh: that of the sky, turned back where the mesh was turned since the bake.

use umbrage_core::glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use umbrage_core::harmonics::Light;

/// Coefficients of all turns that meshes have, one set after the other.
#[derive(Default)]
pub(super) struct Lights {
    /// As the GPU reads them; the fourth number means nothing.
    pub coefficients: Vec<[f32; 4]>,
    last: Option<DQuat>,
}

impl Lights {
    /// Starts a frame.
    pub fn clear(&mut self) {
        self.coefficients.clear();
        self.last = None;
    }

    /// Where the coefficients begin of a mesh that was turned by `turn`, under the light of a sky
    /// that is turned by `sky` and has this colour. Meshes after each other that are turned alike
    /// share them.
    pub fn of(&mut self, light: &Light, sky: DQuat, color: DVec3, turn: DQuat) -> u32 {
        let count = light.coefficients().len();
        if self.last == Some(turn) {
            return (self.coefficients.len() - count) as u32;
        }
        let start = self.coefficients.len() as u32;
        let turned = light.rotated(turn.inverse() * sky);
        self.coefficients.extend(turned.coefficients().iter().map(|c| number(*c * color).extend(0.0).to_array()));
        self.last = Some(turn);
        start
    }
}

/// What single precision holds.
fn number(color: DVec3) -> Vec3 {
    let most = f64::from(f32::MAX) * 1e-4;
    color.clamp(DVec3::splat(-most), DVec3::splat(most)).as_vec3()
}

/// How a mesh was turned on its way from one place to another; not at all where it is flat, or was
/// mirrored on its way.
pub(super) fn turn(from: &DAffine3, to: &DAffine3) -> DQuat {
    if from.matrix3 == to.matrix3 {
        return DQuat::IDENTITY;
    }
    let change = to.matrix3 * from.matrix3.inverse();
    let DMat3 { x_axis, y_axis, .. } = change;
    let (Some(x), true) = (x_axis.try_normalize(), change.determinant() > 0.0) else { return DQuat::IDENTITY };
    let Some(y) = (y_axis - x * x.dot(y_axis)).try_normalize() else { return DQuat::IDENTITY };
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::harmonics::{Order, project};

    #[test]
    fn the_turn_of_a_mesh_is_found_whatever_its_size() {
        let place = DAffine3::from_scale_rotation_translation(
            DVec3::new(0.5, 2.0, 1.0),
            DQuat::from_rotation_x(0.3),
            DVec3::new(1.0, 2.0, 3.0),
        );
        let turned = DQuat::from_rotation_y(1.1) * DQuat::from_rotation_z(-0.4);
        let found = turn(&place, &(DAffine3::from_quat(turned) * place));
        assert!(found.angle_between(turned) < 1e-7, "{found} instead of {turned}");
        let larger = DAffine3::from_scale(DVec3::splat(3.0)) * DAffine3::from_quat(turned) * place;
        assert!(turn(&place, &larger).angle_between(turned) < 1e-7);
        assert_eq!(turn(&place, &(DAffine3::from_translation(DVec3::ONE) * place)), DQuat::IDENTITY);
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        assert_eq!(turn(&flat, &place), DQuat::IDENTITY);
        assert_eq!(turn(&place, &(DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * place)), DQuat::IDENTITY);
    }

    #[test]
    fn meshes_at_rest_share_the_light_and_turned_ones_have_it_turned_back() {
        let light = project(Order::default(), 8, |d| Vec3::splat(d.x.max(0.0) as f32));
        let mut lights = Lights::default();
        let quarter = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
        let turns = [DQuat::IDENTITY, DQuat::IDENTITY, quarter, quarter];
        let starts = turns.map(|turn| lights.of(&light, DQuat::IDENTITY, DVec3::ONE, turn));
        assert_eq!((starts, lights.coefficients.len()), ([0, 0, 25, 25], 50));
        // Turned with its sky, a mesh sees what it saw before.
        lights.clear();
        let both = lights.of(&light, quarter, DVec3::ONE, quarter) as usize;
        let worst = light.coefficients().iter().zip(&lights.coefficients[both..]).map(|(a, b)| a.x - f64::from(b[0]));
        assert!(worst.fold(0.0, |w: f64, d| w.max(d.abs())) < 1e-6);
    }

    #[test]
    fn light_without_end_stays_a_number() {
        let mut lights = Lights::default();
        let light = project(Order::default(), 0, |_| Vec3::splat(f32::MAX));
        lights.of(&light, DQuat::IDENTITY, DVec3::splat(f64::MAX), DQuat::IDENTITY);
        assert!(lights.coefficients.iter().flatten().all(|c| c.is_finite()));
    }
}
