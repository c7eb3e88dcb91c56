//! Offsets tuned by hand, which the automatic bias is compared with.

use crate::common::{against_truth, gpu, scene};

#[test]
fn offsets_are_in_the_texels_of_their_split() {
    let gpu = gpu();
    let scene = scene("city", 0.25);
    let set = "stabilize=on,splits=4,offset=classic,constant=0.02,slope=2";
    let s = against_truth(&gpu, &scene, 0, "cascaded", set, (160, 120), 1);
    println!("mae {:.5}, interior {:?}", s.mae, s.interior_pct);
    assert!(s.interior_pct.unwrap() > 99.9, "{:?}", s.interior_pct);
}

#[test]
fn offsets_tuned_by_hand_show_the_dilemma_and_are_no_better() {
    let gpu = gpu();
    let scene = scene("primitives", 1.0);
    let score = |set: &str| against_truth(&gpu, &scene, 0, "shadow-map", set, (160, 120), 1);
    let by_hand = |constant: f64, slope: f64| score(&format!("offset=classic,constant={constant},slope={slope}"));
    let auto = score("");
    let without = by_hand(0.0, 0.0);
    assert!(without.interior_pct.unwrap() < 95.0, "surfaces shadow themselves: {:?}", without.interior_pct);
    let large = by_hand(0.5, 0.0);
    assert_eq!(large.interior_pct, Some(100.0), "none does where the constant is large");
    assert!(
        large.leak > 0.003 && large.leak > 10.0 * auto.leak,
        "but light leaks: {:.4} against {:.4}",
        large.leak,
        auto.leak
    );
    for constant in [0.0, 0.01, 0.03, 0.1] {
        for slope in [0.0, 0.5, 1.0, 2.0] {
            let tuned = by_hand(constant, slope);
            println!("{constant} m, {slope} texels: mae {:.5}, interior {:.2}", tuned.mae, tuned.interior_pct.unwrap());
            assert!(
                auto.mae <= tuned.mae + 1e-4,
                "{constant} m, {slope} texels: {:.5}, auto {:.5}",
                tuned.mae,
                auto.mae
            );
        }
    }
}
