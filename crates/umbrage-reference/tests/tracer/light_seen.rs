//! The light as a point sees it, against the visibility there.

use crate::scenes::{every_light, still_life};
use umbrage_reference::{Options, Tracer};

/// Places across and down. An edge through the picture is off by half a place at most.
const SIZE: u32 = 64;

#[test]
fn the_lit_share_of_the_picture_is_the_visibility() {
    let scene = still_life();
    let tracer = Tracer::new(&scene);
    for light in every_light() {
        let mut partly = 0;
        for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
            let Some(shown) = tracer.look(&scene.camera, (x, y), (16, 16)) else { continue };
            let way = light.shape.to_center(shown.surface.position);
            if shown.surface.normal.dot(way) <= 1e-3 * way.length() {
                continue;
            }
            let seen = tracer.light_seen(&shown.surface, &light, &scene.textures, SIZE);
            let share = seen.share();
            let want = tracer.visibility_at(&shown.surface, &light, &scene.textures, &Options::default(), 0);
            assert!((share - want).abs() < 0.05, "{light:?} at ({x}, {y}): {share} instead of {want}");
            partly += u32::from(want > 0.1 && want < 0.9);
            // What hides the middle is what the one ray there meets.
            let middle = tracer.blocker(&shown.surface, light.shape.center()).is_some();
            let hard = Options { samples: 1, ..Options::default() };
            let lit = tracer.visibility_at(&shown.surface, &light, &scene.textures, &hard, 0) > 0.5;
            assert_eq!(middle, !lit && light.casts, "{light:?} at ({x}, {y})");
        }
        assert!(partly > 0 || !light.shape.kind().is_soft(), "{light:?} has no penumbra here");
    }
}
