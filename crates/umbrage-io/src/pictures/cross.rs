//! Cubes that are unfolded into a cross.

use umbrage_core::Image;
use umbrage_core::environment::{direction_of, place_of_pixel};
use umbrage_core::glam::{DVec2, DVec3, Vec3};

/// A face of the cube around the eye: the way to its middle, and what is to the right and down
/// there for somebody who looks at it from inside.
struct Face {
    forward: DVec3,
    right: DVec3,
    down: DVec3,
    /// Column and row of the cross.
    cell: [u32; 2],
}

/// Side of the cube's faces, pixels, where a picture is of the form of a cross: 4 × 3 faces or 3 ×
/// 4.
pub(crate) fn side_of_cross((width, height): (u32, u32)) -> Option<u32> {
    let side = width.min(height) / 3;
    let is_cross = |wide: u32, high: u32| side > 0 && (width, height) == (wide * side, high * side);
    (is_cross(4, 3) || is_cross(3, 4)).then_some(side)
}

/// The equirectangular picture, four faces wide, of a cube that is unfolded into a cross as seen
/// from inside: −Z in the middle, −X to its left, +X to its right, +Y above and −Y below; +Z is to
/// the right of +X, or below −Y upside down. `None` where it is no cross.
pub(crate) fn equirectangular_of_cross(cross: &Image<[f32; 3]>) -> Option<Image<[f32; 3]>> {
    let side = side_of_cross(cross.size())?;
    let faces = faces(cross.width > cross.height);
    let (width, height) = (4 * side, 2 * side);
    let size = DVec2::new(width.into(), height.into());
    Some(Image::from_fn(width, height, |x, y| {
        let middle = place_of_pixel((width, height), x, y);
        let parts = [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)].map(DVec2::from);
        let directions = parts.map(|part| direction_of((middle + part / size).clamp(DVec2::ZERO, DVec2::ONE)));
        let sum: Vec3 = directions.map(|direction| seen(cross, &faces, side, direction)).into_iter().sum();
        (sum * 0.25).to_array()
    }))
}

fn faces(is_wide: bool) -> [Face; 6] {
    let [x, y, z] = DVec3::AXES;
    let face = |forward, right, down, cell| Face { forward, right, down, cell };
    let behind = if is_wide { face(z, -x, -y, [3, 1]) } else { face(z, x, y, [1, 3]) };
    [
        face(-x, -z, -y, [0, 1]),
        face(-z, x, -y, [1, 1]),
        face(x, z, -y, [2, 1]),
        face(y, x, -z, [1, 0]),
        face(-y, x, z, [1, 2]),
        behind,
    ]
}

/// What a direction meets, interpolated within its face.
fn seen(cross: &Image<[f32; 3]>, faces: &[Face; 6], side: u32, direction: DVec3) -> Vec3 {
    let mut best = &faces[0];
    for face in faces {
        if direction.dot(face.forward) > direction.dot(best.forward) {
            best = face;
        }
    }
    let on_face = DVec2::new(direction.dot(best.right), direction.dot(best.down)) / direction.dot(best.forward);
    let last = f64::from(side - 1);
    let at = ((on_face * 0.5 + 0.5) * f64::from(side) - 0.5).clamp(DVec2::ZERO, DVec2::splat(last));
    let low = at.floor().min(DVec2::splat((last - 1.0).max(0.0)));
    let part = (at - low).as_vec2();
    let pixel = |dx: u32, dy: u32| {
        let (x, y) = ((low.x as u32 + dx).min(side - 1), (low.y as u32 + dy).min(side - 1));
        Vec3::from(cross[(best.cell[0] * side + x, best.cell[1] * side + y)])
    };
    pixel(0, 0).lerp(pixel(1, 0), part.x).lerp(pixel(0, 1).lerp(pixel(1, 1), part.x), part.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::environment::SkyPicture;

    /// A cross that shows the direction itself, moved to 0…1.
    fn cross(is_wide: bool) -> Image<[f32; 3]> {
        let side = 16;
        let (across, down) = if is_wide { (4, 3) } else { (3, 4) };
        let mut image = Image::filled(across * side, down * side, [9.0; 3]);
        for face in faces(is_wide) {
            for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
                let on_face = (DVec2::new(x.into(), y.into()) + 0.5) / f64::from(side) * 2.0 - 1.0;
                let direction = (face.forward + face.right * on_face.x + face.down * on_face.y).normalize();
                image[(face.cell[0] * side + x, face.cell[1] * side + y)] =
                    (direction * 0.5 + 0.5).as_vec3().to_array();
            }
        }
        image
    }

    #[test]
    fn every_direction_is_found_in_both_crosses() {
        for is_wide in [true, false] {
            let sky = SkyPicture::new(equirectangular_of_cross(&cross(is_wide)).unwrap()).unwrap();
            for i in 0..200 {
                let place = DVec2::new(f64::from(i) * 0.618 % 1.0, 0.03 + 0.94 * f64::from(i) / 200.0);
                let direction = direction_of(place);
                let got = (sky.radiance(direction) * 2.0 - 1.0).as_dvec3();
                assert!((got - direction).length() < 0.03, "{direction} shows {got}");
            }
        }
    }

    #[test]
    fn faces_meet_at_the_edges_of_the_cross() {
        // Cells beside each other in the cross share an edge of the cube, so that one who folds
        // it up gets no other cube.
        for is_wide in [true, false] {
            let faces = faces(is_wide);
            for (a, b) in faces.iter().flat_map(|a| faces.iter().map(move |b| (a, b))) {
                let (x, y) = (i64::from(b.cell[0]) - i64::from(a.cell[0]), i64::from(b.cell[1]) - i64::from(a.cell[1]));
                if (x, y) == (1, 0) {
                    assert_eq!((a.right, a.down), (b.forward, b.down));
                }
                if (x, y) == (0, 1) {
                    assert_eq!((a.down, a.right), (b.forward, b.right));
                }
            }
        }
    }

    #[test]
    fn other_forms_are_no_crosses() {
        assert_eq!(side_of_cross((64, 48)), Some(16));
        assert_eq!(side_of_cross((48, 64)), Some(16));
        for size in [(0, 0), (1, 1), (64, 32), (65, 48), (48, 48)] {
            assert_eq!(side_of_cross(size), None, "{size:?}");
        }
    }
}
