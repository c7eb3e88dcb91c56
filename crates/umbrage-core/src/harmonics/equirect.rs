//! Coefficients of equirectangular pictures.

use super::basis::legendre;
use super::light::Light;
use super::order::{Order, index};
use super::rotation::Rotation;
use crate::image::Image;
use glam::{DMat3, DQuat, DVec3, Vec3A};
use std::f64::consts::{PI, SQRT_2, TAU};

const MOST: usize = 10;

/// Sines and cosines of multiples of the angle around the picture's pole: 2n − 1 ≤ 19.
type Ring = [Vec3A; 2 * MOST - 1];

/// The coefficients of an equirectangular picture of radiance, in the orientation of the scene
/// format: row 0 is +Y, the middle of the picture is −Z, three quarters of its width is +X. Each
/// texel counts with the solid angle of its rectangle in θ and φ, as those of [`Sky::picture`] are
/// made. A picture without texels is black.
///
/// [`Sky::picture`]: crate::environment::Sky::picture
///
/// The functions are products of one of θ and one of φ about the picture's own pole, so a row is
/// summed for each multiple of φ, and the sums for each degree; the axes are exchanged at the end.
pub fn project_equirect(order: Order, picture: &Image<[f32; 3]>) -> Light {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let mut light = vec![DVec3::ZERO; order.functions()];
    if picture.data.len() < width * height || picture.data.is_empty() || width == 0 {
        return Light::black(order);
    }
    let columns: Vec<[f32; 2 * MOST - 1]> = (0..width).map(|x| multiples(order, x, width)).collect();
    for (y, row) in picture.data.chunks_exact(width).take(height).enumerate() {
        let [top, middle, bottom] = [0.0, 0.5, 1.0].map(|part| (PI * (y as f64 + part) / height as f64).cos());
        let solid_angle = TAU / width as f64 * (top - bottom);
        add_row(order, &ring(order, row, &columns), middle, solid_angle, &mut light);
    }
    // From the picture's own frame, with its pole as z, its middle as x and its first quarter as y,
    // to the world's.
    let axes = DMat3::from_cols(DVec3::NEG_Z, DVec3::NEG_X, DVec3::Y);
    Rotation::new(order, DQuat::from_mat3(&axes)).apply(&mut light);
    Light::new(light).unwrap_or_else(|| Light::black(order))
}

/// 1, then √2 cos and √2 sin of each multiple of a column's angle: 0 in the middle, and growing to
/// the left, which is counter-clockwise seen from the pole.
fn multiples(order: Order, column: usize, width: usize) -> [f32; 2 * MOST - 1] {
    let angle = TAU * (0.5 - (column as f64 + 0.5) / width as f64);
    let mut values = [0.0; 2 * MOST - 1];
    values[0] = 1.0;
    for m in 1..order.bands() {
        let (sin, cos) = (m as f64 * angle).sin_cos();
        (values[2 * m - 1], values[2 * m]) = ((SQRT_2 * cos) as f32, (SQRT_2 * sin) as f32);
    }
    values
}

fn ring(order: Order, row: &[[f32; 3]], columns: &[[f32; 2 * MOST - 1]]) -> Ring {
    let mut sums = [Vec3A::ZERO; 2 * MOST - 1];
    let used = 2 * order.bands() - 1;
    for (texel, factors) in row.iter().zip(columns) {
        let texel = Vec3A::from(*texel);
        sums[..used].iter_mut().zip(factors).for_each(|(sum, factor)| *sum += texel * *factor);
    }
    sums
}

fn add_row(order: Order, sums: &Ring, cos: f64, solid_angle: f64, light: &mut [DVec3]) {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let mut power = solid_angle;
    for m in 0..order.bands() {
        legendre(order, m, cos, |l, q| {
            let factor = power * q;
            if m == 0 {
                light[index(l, 0)] += sums[0].as_dvec3() * factor;
            } else {
                light[index(l, m as isize)] += sums[2 * m - 1].as_dvec3() * factor;
                light[index(l, -(m as isize))] += sums[2 * m].as_dvec3() * factor;
            }
        });
        power *= sin;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::{Gradient, Sky};
    use crate::harmonics::evaluate;
    use crate::harmonics::project;
    use glam::Vec3;

    /// The direction of a texel, as the scene format has it.
    fn direction(x: u32, y: u32, (width, height): (u32, u32)) -> DVec3 {
        let (sin_theta, cos_theta) = (PI * (f64::from(y) + 0.5) / f64::from(height)).sin_cos();
        let (sin_phi, cos_phi) = (TAU * ((f64::from(x) + 0.5) / f64::from(width) - 0.5)).sin_cos();
        DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
    }

    #[test]
    fn a_picture_has_the_sum_over_its_texels() {
        let size = (12, 7);
        let picture = Image::from_fn(size.0, size.1, |x, y| [x as f32 * 0.1, (x * y % 5) as f32, y as f32]);
        let mut want = vec![DVec3::ZERO; 100];
        let mut basis = [0.0; 100];
        for (i, texel) in (0..).zip(&picture.data) {
            let (x, y) = (i % size.0, i / size.0);
            let edge = |y: u32| (PI * f64::from(y) / f64::from(size.1)).cos();
            let solid_angle = TAU / f64::from(size.0) * (edge(y) - edge(y + 1));
            evaluate(Order::MAX, direction(x, y, size), &mut basis);
            want.iter_mut().zip(basis).for_each(|(sum, y)| *sum += Vec3::from(*texel).as_dvec3() * y * solid_angle);
        }
        let found = project_equirect(Order::MAX, &picture);
        let worst = want.iter().zip(found.coefficients()).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn the_orientation_is_that_of_the_scene_format() {
        // A bright texel at the top, in the middle, and at three quarters; flipped pictures give
        // the opposite signs.
        let bright = |x: u32, y: u32| {
            let picture = Image::from_fn(64, 32, |i, j| [f32::from(u8::from((i, j) == (x, y))); 3]);
            let light = project_equirect(Order::default(), &picture);
            let c = light.coefficients();
            DVec3::new(c[3].x, c[1].x, c[2].x).normalize()
        };
        for (x, y, want) in [(0, 0, DVec3::Y), (32, 16, DVec3::NEG_Z), (48, 16, DVec3::X), (16, 16, DVec3::NEG_X)] {
            assert!(bright(x, y).dot(want) > 0.99, "{x}, {y}: {}", bright(x, y));
        }
    }

    #[test]
    fn a_picture_of_a_sky_keeps_its_light() {
        let sky = Sky::Gradient(Gradient { zenith: Vec3::ONE, horizon: Vec3::splat(0.5), nadir: Vec3::ZERO });
        // What functions lose that count at the middles of texels falls with their area.
        let light = project_equirect(Order::default(), &sky.picture(256, 128));
        let want = project(Order::default(), 64, |direction| sky.radiance(direction));
        let worst = light.coefficients().iter().zip(want.coefficients()).map(|(a, b)| (*a - *b).length());
        assert!(worst.fold(0.0, f64::max) < 3e-4, "{light:?} instead of {want:?}");
    }

    #[test]
    fn pictures_without_texels_are_black() {
        let order = Order::default();
        for picture in [Image::filled(0, 0, [1.0; 3]), Image { width: 4, height: 4, data: vec![[1.0; 3]; 3] }] {
            assert_eq!(project_equirect(order, &picture), Light::black(order));
        }
        let one = project_equirect(order, &Image::filled(1, 1, [1.0; 3]));
        assert!((one.coefficients()[0].x - (4.0 * PI).sqrt()).abs() < 1e-6);
    }
}
