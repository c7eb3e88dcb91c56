//! Light masks against ground truth.

use crate::wedges::vs_hard;

/// Where casters overlap, where the silhouette changes from one end of the light to the other, and
/// where neither is so: 256 samples of the light are off by their number alone.
const MASKED: &[&str] = &["overlap", "models", "boxes-rect", "boxes-disc", "fence"];

#[test]
#[ignore = "needs the shared references"]
fn masks_are_exact_whatever_casts() {
    let mut wrong = Vec::new();
    for name in MASKED {
        let (got, interior) = vs_hard(name, 0, "light-mask", "samples=256").expect("it is among the stored scenes");
        println!("{name}: vs_hard {got:.4}, interior {interior:.3} %");
        // Fewer samples than that could not be told from an exact answer.
        if !(0.008..=0.025).contains(&got) || interior < 99.95 {
            wrong.push(format!("{name}: vs_hard {got:.4}, interior {interior:.3} %"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
