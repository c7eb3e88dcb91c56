//! Where a light's samples are on its face.

use crate::area_light::{Face, Form};
use umbrage_core::Texture;
use umbrage_core::glam::DVec2;
use umbrage_core::sampling::{Luminance, lattice, square_to_disc};

/// How far from the middle of the face there are samples.
pub(super) fn reach(face: Face) -> f64 {
    if matches!(face, Face::Square | Face::Picture) { std::f64::consts::SQRT_2 } else { 1.0 }
}

/// Points of the light on its face, as dense as its picture is bright.
pub(super) fn samples(picture: Option<&Texture>, form: &Form, count: u32) -> Vec<DVec2> {
    let picture = picture.and_then(Luminance::of);
    let on_face = |u: DVec2| match form.face {
        _ if form.is_point() => DVec2::ZERO,
        Face::Sphere | Face::Disc => square_to_disc(u),
        Face::Line => DVec2::new(u.x * 2.0 - 1.0, 0.0),
        Face::Square | Face::Picture => picture.as_ref().map_or(u, |p| p.sample(u)) * 2.0 - 1.0,
    };
    lattice(count as usize).into_iter().map(on_face).collect()
}
