//! Rectangles of pixels.

use crate::views::*;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use umbrage_core::{Bounds, Camera, shadow_hull::screen_rect};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn what_is_seen_of_a_box_is_in_its_rectangle(
        shot in middle().prop_flat_map(shot),
        (at, share, half, inside) in (ndc(), 0.0..1.0, vector(20.0), vector(1.0)),
        others in prop::collection::vec(vector(1.0), 20),
    ) {
        let bounds = box_with(shot.seen(at, share, 1e3), half.abs(), inside);
        let rect = screen_rect(&shot.view, &bounds, PICTURE);
        prop_assert!(rect.is_some(), "a point of the box is seen");
        let [x, y, width, height] = rect.unwrap_or_default();
        prop_assert!(width > 0 && height > 0 && x + width <= PICTURE.0 && y + height <= PICTURE.1);
        let (low, high) = (DVec2::new(x.into(), y.into()), DVec2::new((x + width).into(), (y + height).into()));
        let center = bounds.center();
        let points = others.iter().map(|o| center + half * *o).chain([shot.seen(at, share, 1e3)]);
        for pixel in points.filter_map(|p| shot.pixel(p)) {
            prop_assert!(pixel.cmpge(low).all() && pixel.cmple(high).all(), "{pixel} outside {rect:?}");
        }
    }

    #[test]
    fn the_rectangle_of_a_box_in_front_is_no_larger_than_it_need_be(
        shot in middle().prop_flat_map(shot),
        (at, share, half) in (ndc(), 0.5..1.0, vector(1.0)),
    ) {
        let bounds = box_with(shot.seen(at * 0.5, share, 1e3), half.abs(), DVec3::ZERO);
        let corners: Vec<_> = bounds.corners().into_iter().filter_map(|c| shot.pixel(c)).collect();
        if corners.len() < 8 {
            return Ok(());
        }
        let [_, _, width, height] = screen_rect(&shot.view, &bounds, PICTURE).unwrap_or_default();
        let low = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = corners.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        prop_assert!(f64::from(width) < high.x - low.x + 4.5 && f64::from(height) < high.y - low.y + 4.5);
    }
}

#[test]
fn boxes_outside_have_no_rectangle_and_one_around_the_eye_the_whole_picture() {
    let view = Camera { eye: DVec3::ZERO, target: DVec3::NEG_Z, ..Camera::default() }.view(640, 480);
    let at = |center: DVec3, half: f64| Bounds { min: center - half, max: center + half };
    let rect = |bounds| screen_rect(&view, &bounds, PICTURE);
    assert_eq!(rect(at(DVec3::Z * 5.0, 1.0)), None, "behind");
    assert_eq!(rect(at(DVec3::new(50.0, 0.0, -5.0), 1.0)), None, "beside");
    assert_eq!(rect(Bounds::EMPTY), None);
    assert_eq!(rect(at(DVec3::ZERO, 0.01)), Some([0, 0, 640, 480]));
    let ahead = rect(at(DVec3::NEG_Z * 5.0, 0.1)).expect("it is seen");
    assert!(ahead[0] > 250 && ahead[2] < 50, "{ahead:?}");
    assert_eq!(screen_rect(&view, &at(DVec3::ZERO, 1.0), (0, 480)), None);
}
