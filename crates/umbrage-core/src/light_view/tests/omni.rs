//! Layouts of maps for lights to all sides.

use super::*;

const LIGHT: DVec3 = DVec3::new(0.3, 3.0, -0.4);

fn light() -> LightShape {
    LightShape::Point { position: LIGHT }
}

/// Directions all around, evenly.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let across = (1.0 - y * y).sqrt();
        DVec3::new(across * cos, y, across * sin)
    })
}

/// The farthest |x| or |y| of what is that far from a border of so many texels.
fn within(border: f64) -> f64 {
    1.0 - 2.0 * border / 512.0 + 1e-9
}

#[test]
fn every_direction_is_in_its_layer_with_room_around() {
    for omni in OMNI {
        let (views, layers) = fit_of(&light(), Focus::Light, omni, 6.0);
        assert_eq!((layers, views.len()), (Some(omni), omni.layers() as usize));
        let mut farthest = vec![0.0_f64; views.len()];
        for d in directions(20_000) {
            let layer = omni.layer_of(d) as usize;
            let place = ndc(&views[layer], LIGHT + d * 2.0).truncate().abs().max_element();
            farthest[layer] = farthest[layer].max(place);
        }
        let limit = within(6.0);
        assert!(farthest.iter().all(|f| (0.97 * limit..=limit).contains(f)), "{omni:?} {farthest:?}");
    }
}

#[test]
fn what_is_seen_is_in_its_layer_with_room_around_and_fills_it() {
    let camera = Camera { eye: DVec3::new(0.0, 6.0, 12.0), ..Camera::default() }.view(640, 480);
    let seen = camera.clip_from_world();
    let in_picture = |p: &DVec3| {
        let clip = seen * p.extend(1.0);
        clip.w > 0.0 && clip.truncate().truncate().abs().max_element() <= clip.w
    };
    for omni in OMNI {
        let (views, _) = fit_of(&light(), Focus::Visible, omni, 6.0);
        let mut extent = vec![(DVec2::INFINITY, DVec2::NEG_INFINITY); omni.layers() as usize];
        let floor =
            (0..500 * 500).map(|i| DVec3::new(f64::from(i % 500) - 249.5, 0.0, f64::from(i / 500) - 249.5) / 50.0);
        for p in floor.chain(crate_above().corners()).filter(in_picture) {
            let layer = omni.layer_of(p - LIGHT);
            let view = views.iter().find(|v| v.layer == layer).expect("a view of what is seen");
            let at = ndc(view, p).truncate();
            let (min, max) = &mut extent[layer as usize];
            (*min, *max) = (min.min(at), max.max(at));
        }
        let limit = within(6.0);
        for (layer, (min, max)) in extent.into_iter().enumerate().filter(|(_, (min, _))| min.is_finite()) {
            let least = (-min).min(max).min_element();
            let most = (-min).max(max).max_element();
            assert!(most <= limit && least > 0.95 * limit, "{omni:?} layer {layer}: {min} to {max}");
        }
    }
}

#[test]
fn tangents_agree_with_their_view() {
    for omni in OMNI {
        let (views, _) = fit_of(&light(), Focus::Light, omni, 0.0);
        for d in directions(50) {
            let (view, p, step) = (&views[omni.layer_of(d) as usize], LIGHT + d * 3.0, 1e-4);
            let tangent = LightView::of(view.tangent_at(p), view.size, view.layer);
            assert!(ndc(&tangent, p).truncate().distance(ndc(view, p).truncate()) < 1e-12);
            for way in [DVec3::X, DVec3::Y, DVec3::Z] {
                let off = (ndc(&tangent, p + way * step) - ndc(view, p + way * step)).truncate().length();
                assert!(off < step * step, "{omni:?} {d} {off}");
            }
        }
    }
}

#[test]
fn a_frustum_is_around_all_that_its_view_shows() {
    let position = DVec3::new(4.0, 2.0, 3.0);
    for focus in [Focus::Light, Focus::Visible] {
        let (views, _) = fit_of(&LightShape::Point { position }, focus, Omni::DualParaboloid, 3.0);
        assert!(!views.is_empty());
        for view in &views {
            let (frustum, mut shown) = (view.frustum(), 0);
            let mut culled = 0;
            for p in directions(20_000).map(|d| position + d * 8.0) {
                let at = Bounds { min: p, max: p };
                if ndc(view, p).truncate().abs().max_element() <= 1.0 {
                    shown += 1;
                    assert!(frustum.may_see(&at), "{focus:?} {p}");
                }
                culled += usize::from(!frustum.may_see(&at));
            }
            assert!(shown > 200 && culled > 2000, "{focus:?} {shown} {culled}");
        }
    }
}

#[test]
fn depth_of_a_paraboloid_goes_by_the_distance() {
    let (views, _) = fit_of(&light(), Focus::Light, Omni::DualParaboloid, 0.0);
    for d in directions(30) {
        let view = &views[Omni::DualParaboloid.layer_of(d) as usize];
        let [near, far] = [1.0, 4.0].map(|r| ndc(view, LIGHT + d * r));
        assert!((near.z / far.z - 4.0).abs() < 1e-9 && near.truncate().distance(far.truncate()) < 1e-12);
        // The axis is in the middle, the rim of the hemisphere on the circle around it.
        assert!((near.truncate().length() - ((1.0 - d.y.abs()) / (1.0 + d.y.abs())).sqrt()).abs() < 1e-12);
    }
}
