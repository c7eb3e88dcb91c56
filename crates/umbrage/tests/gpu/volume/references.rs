//! Pictures made by other software.

use super::{COUNTS, Target, assert_none};
use crate::common::{gpu, renderer, visibility};
use crate::shared_references::{mask, size, stored};

#[test]
#[ignore = "needs the shared references"]
fn hard_lights_are_as_others_see_them() {
    let found = stored(|s, light| !s.lights[light].shape.kind().is_soft());
    let gpu = gpu();
    let mut wrong = Vec::new();
    for (name, light, scene, stored) in found {
        let target = Target::new(stored.visibility.clone(), mask(&stored), false);
        for set in COUNTS {
            let seen = visibility(&mut renderer(&gpu, &scene, light, "volume", set, size(&stored)), &scene);
            let (correct, inside) = target.right_pct(&seen);
            println!("{name} light {light} {set}: {correct:.4} % correct, {inside:.4} % inside");
            wrong.extend(target.complaint(&format!("{name} light {light} {set}"), &seen));
        }
    }
    assert_none(&wrong);
}
