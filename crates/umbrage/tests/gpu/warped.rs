//! Warped maps against uniform ones of the same size, along a street.

use crate::common::{against_truth, gpu, scene};
use umbrage::core::LightShape;
use umbrage::core::glam::DVec3;

/// Where the light comes from, seen along the street.
const LIGHTS: [(&str, DVec3); 5] = [
    ("the side", DVec3::new(-0.7, -0.7, -0.1)),
    ("behind", DVec3::new(0.15, -0.6, -0.8)),
    ("above", DVec3::new(0.05, -1.0, 0.1)),
    ("the front", DVec3::new(0.2, -0.6, 0.8)),
    ("straight ahead", DVec3::new(-0.09, -0.08, 1.0)),
];

#[test]
fn warped_maps_are_better_than_uniform_ones_of_the_same_size() {
    let gpu = gpu();
    let mut city = scene("city", 1.0);
    let mut wrong = Vec::new();
    for (name, direction) in LIGHTS {
        city.lights[0].shape = LightShape::Directional { direction: direction.normalize(), angle_deg: 0.0 };
        let score = |id: &str, set: &str| against_truth(&gpu, &city, 0, id, set, (320, 240), 1);
        let uniform = score("pcf", "kernel=2x2,size=1024").mae;
        let warps = [("psm", 1.05), ("psm:cube", 1.05), ("lispsm", 1.2), ("plane-optimal", 1.2)];
        for (id, worst) in warps {
            let (id, set) = id.strip_suffix(":cube").map_or((id, ""), |id| (id, "cube=on"));
            let s = score(id, set);
            // Nothing can be gained with the light in the eyes.
            let bound = if name == "straight ahead" { worst } else { 0.8 };
            let interior = s.interior_pct.unwrap_or(0.0);
            let row = format!(
                "light from {name}, {id} {set}: mae {:.5} against {uniform:.5}, interior {interior:.3} %",
                s.mae
            );
            println!("{row}");
            if s.mae > bound * uniform || interior < 99.8 || s.not_finite > 0 {
                wrong.push(row);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
