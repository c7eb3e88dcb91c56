//! References that are kept between runs. Needs a graphics adapter.

use crate::common::{files, umbrage};
use serde_json::Value;
use std::{fs, path::Path};

/// The reference of the soft light, the score of a technique, and what went to the standard error.
fn compare(folder: &Path, samples: &str) -> (Value, Value, String) {
    let what = "compare contact --light 1 --techniques none --size 64x48 --truth-cache truth -o out --json --samples";
    let arguments: Vec<&str> = what.split(' ').chain([samples]).collect();
    let output = umbrage(folder, &arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let light = &report["scenes"][0]["lights"][0];
    (light["reference"].clone(), light["results"][0]["scores"].clone(), errors)
}

#[test]
fn references_are_kept_and_damaged_ones_are_traced_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let (reference, scores, _) = compare(folder.path(), "8");
    let kept = files(&folder.path().join("truth"));
    assert_eq!(kept.len(), 2, "the soft shadow and the hard one: {kept:?}");

    // The time that tracing took is that of the first run, to the last digit.
    let (again, same, errors) = compare(folder.path(), "8");
    assert_eq!((&again, &same, errors.as_str()), (&reference, &scores, ""));
    assert_eq!(files(&folder.path().join("truth")), kept);

    let (other, ..) = compare(folder.path(), "9");
    assert_eq!(other["samples"], 9);
    // The hard shadow is the same.
    assert_eq!(files(&folder.path().join("truth")).len(), 3);

    fs::write(&kept[0], b"umbrage").expect("a damaged file");
    let (_, mended, errors) = compare(folder.path(), "8");
    assert_eq!(mended, scores);
    assert!(errors.contains("note: ") && errors.contains("traced anew"), "{errors}");
    assert_eq!(compare(folder.path(), "8").2, "");
}
