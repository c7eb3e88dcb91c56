//! Light between a caster and the shadow that should touch it.

use crate::score::difference;
use umbrage_core::{
    Camera, Image,
    glam::{DVec2, DVec3, Vec3},
};

/// Surfaces that meet with an angle whose cosine is below this touch there.
const ANGLE: f32 = 0.9;

/// How far a contact's shadow is looked for, pixels: beside it pixels are not scored.
const NEAR: i64 = 3;

/// The reference is dark where it is below this.
const DARK: f32 = 0.25;

/// A pixel is wrongly lit where it has so much more light than the reference.
const LIT: f64 = 0.25;

/// True where a surface meets another one that rises from it: the pixels on both sides of an inner
/// corner.
///
/// `depth` is along the view direction, metres, 0 where nothing is; `normal` is geometric.
pub fn contacts(camera: &Camera, depth: &Image<f32>, normal: &Image<Vec3>) -> Image<bool> {
    let (width, height) = depth.size();
    let place = |(x, y): (u32, u32)| {
        let far = depth.get(x.into(), y.into()).copied().filter(|d| *d > 0.0)?;
        let pixel = DVec2::new(x.into(), y.into()) + 0.5;
        Some(camera.start(pixel, width, height) + camera.ray(pixel, width, height) * f64::from(far))
    };
    let mut found = Image::filled(width, height, false);
    for at in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        for next in [(at.0 + 1, at.1), (at.0, at.1 + 1)] {
            let (Some(here), Some(there)) = (place(at), place(next)) else { continue };
            if is_inner_corner(there - here, [normal[at], normal[next]]) {
                found[at] = true;
                found[next] = true;
            }
        }
    }
    found
}

/// True where two surfaces that neighbouring pixels show meet between them, each in front of the
/// other. At an outer edge, and where one hides the other, one of them is behind.
fn is_inner_corner(step: DVec3, normals: [Vec3; 2]) -> bool {
    let [a, b] = normals.map(|n| n.as_dvec3());
    normals[0].dot(normals[1]) < ANGLE && a.dot(step) > 0.0 && b.dot(step) < 0.0
}

/// Mean width of the light between casters and the shadows that should touch them, pixels; `None`
/// where the reference has no dark contact.
///
/// `contacts` are those of [`contacts()`]. A contact is dark where the reference is below 0.25 at
/// the nearest scored pixels, up to 3 pixels from it. Pixels with over 0.25 too much light that
/// are connected with those are the gap; their number over that of the nearest pixels is its width.
pub(crate) fn contact_gap(
    produced: &Image<f32>,
    reference: &Image<f32>,
    mask: &Image<bool>,
    contacts: &Image<bool>,
) -> Option<f64> {
    let dark = |x: i64, y: i64| mask.get(x, y) == Some(&true) && reference.get(x, y).is_some_and(|value| *value < DARK);
    let wrong = |x: i64, y: i64| {
        dark(x, y) && difference(produced[(x as u32, y as u32)], reference[(x as u32, y as u32)]) > LIT
    };
    let (width, height) = reference.size();
    let near = beside(contacts, mask);
    let mut seen = Image::filled(width, height, false);
    let mut open: Vec<(i64, i64)> = Vec::new();
    let mut length = 0_usize;
    for (x, y) in (0..i64::from(height)).flat_map(|y| (0..i64::from(width)).map(move |x| (x, y))) {
        if near[(x as u32, y as u32)] && dark(x, y) {
            length += 1;
            if wrong(x, y) {
                seen[(x as u32, y as u32)] = true;
                open.push((x, y));
            }
        }
    }
    let mut area = 0_usize;
    while let Some((x, y)) = open.pop() {
        area += 1;
        for (i, j) in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
            if wrong(i, j) && !seen[(i as u32, j as u32)] {
                seen[(i as u32, j as u32)] = true;
                open.push((i, j));
            }
        }
    }
    (length > 0).then(|| area as f64 / length as f64)
}

/// The scored pixels nearest to contacts: those reached from them, up to [`NEAR`] pixels, through
/// pixels that are not scored.
fn beside(contacts: &Image<bool>, mask: &Image<bool>) -> Image<bool> {
    let (width, height) = mask.size();
    let mut near = Image::filled(width, height, false);
    let mut reached = contacts.clone();
    for _ in 0..=NEAR {
        let last = reached.clone();
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&at| last[at]) {
            if mask[(x, y)] {
                near[(x, y)] = true;
                continue;
            }
            for (i, j) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let at = (i64::from(x) + i, i64::from(y) + j);
                if mask.get(at.0, at.1).is_some() {
                    reached[(at.0 as u32, at.1 as u32)] = true;
                }
            }
        }
    }
    near
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (80, 60);

    /// Looks down at a floor on which a wall stands at z = 0, seen from the front.
    fn corner() -> (Camera, Image<f32>, Image<Vec3>) {
        let camera = Camera { eye: DVec3::new(0.0, 4.0, 6.0), target: DVec3::ZERO, ..Camera::default() };
        let (mut depth, mut normal) = (Image::filled(SIZE.0, SIZE.1, 0.0), Image::filled(SIZE.0, SIZE.1, Vec3::ZERO));
        for at in (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))) {
            let pixel = DVec2::new(at.0.into(), at.1.into()) + 0.5;
            let ray = camera.ray(pixel, SIZE.0, SIZE.1);
            let (floor, wall) = (-camera.eye.y / ray.y, -camera.eye.z / ray.z);
            let on_floor = floor > 0.0 && floor < wall;
            depth[at] = if on_floor { floor } else { wall } as f32;
            normal[at] = if on_floor { Vec3::Y } else { Vec3::Z };
        }
        (camera, depth, normal)
    }

    #[test]
    fn a_wall_on_a_floor_is_a_contact_and_an_outer_edge_is_none() {
        let (camera, depth, normal) = corner();
        let found = contacts(&camera, &depth, &normal);
        for x in 0..SIZE.0 {
            let column: Vec<u32> = (0..SIZE.1).filter(|&y| found[(x, y)]).collect();
            assert!(column.len() == 2 && column[1] == column[0] + 1, "column {x}: {column:?}");
            assert_eq!((normal[(x, column[0])], normal[(x, column[1])]), (Vec3::Z, Vec3::Y));
        }
        // With their normals turned round the surfaces are the outside of an edge.
        let outer = contacts(&camera, &depth, &normal.map(|n| -*n));
        assert!(outer.data.iter().all(|contact| !contact));
        // Behind a front edge the floor is far away.
        let far = Image::from_fn(SIZE.0, SIZE.1, |x, y| if normal[(x, y)] == Vec3::Z { 1.0 } else { depth[(x, y)] });
        assert!(contacts(&camera, &far, &normal).data.iter().all(|contact| !contact));
    }

    /// A contact along row 10, its shadow from there to row 40; rows 9 to 11 are not scored.
    fn shadow(lit_below: u32) -> Image<f32> {
        Image::from_fn(SIZE.0, SIZE.1, |_, y| if (10 + lit_below..40).contains(&y) { 0.0 } else { 1.0 })
    }

    fn gap(produced: &Image<f32>, reference: &Image<f32>) -> Option<f64> {
        let mask = Image::from_fn(SIZE.0, SIZE.1, |_, y| !(9..12).contains(&y));
        let contacts = Image::from_fn(SIZE.0, SIZE.1, |_, y| y == 10 || y == 11);
        contact_gap(produced, reference, &mask, &contacts)
    }

    #[test]
    fn a_gap_is_as_wide_as_the_light_that_touches_the_caster() {
        assert_eq!(gap(&shadow(0), &shadow(0)), Some(0.0));
        assert_eq!(gap(&shadow(2), &shadow(0)), Some(0.0), "what is not scored is no gap");
        assert_eq!(gap(&shadow(7), &shadow(0)), Some(5.0), "the first scored row is 12");
        assert_eq!(gap(&shadow(0).map(|_| 1.0), &shadow(0)), Some(28.0), "no shadow at all");
        assert_eq!(gap(&shadow(5), &shadow(0).map(|_| 1.0)), None, "nothing is dark");
    }

    #[test]
    fn light_elsewhere_is_no_gap() {
        let mut holed = shadow(0);
        (0..SIZE.0).for_each(|x| holed[(x, 30)] = 1.0);
        assert_eq!(gap(&holed, &shadow(0)), Some(0.0));
    }
}
