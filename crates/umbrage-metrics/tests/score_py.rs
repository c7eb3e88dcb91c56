//! Agreement with the script that comes with the reference pictures, over all numbers that both
//! compute.

use std::path::{Path, PathBuf};
use std::process::Command;
use umbrage_core::Image;
use umbrage_metrics::{Comparison, discontinuities, score};

/// Writes a reference as raw little-endian arrays: visibility, mask, depth, model.
const UNPACK: &str = r#"
import sys
import numpy as np
from PIL import Image
stem, out = sys.argv[1:]
save = lambda name, a, t: np.ascontiguousarray(a).astype(t).tofile(f"{out}/{name}")
save("visibility", np.array(Image.open(stem + ".visibility.png")) / 65535.0, "<f4")
save("mask", np.array(Image.open(stem + ".mask.png")) > 127, "u1")
with np.load(stem.rsplit(".light", 1)[0] + ".geometry.npz") as g:
    save("depth", g["depth"], "<f4")
    save("model", g["model"], "<i4")
    print(*g["depth"].shape[::-1])
"#;

fn references() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    std::env::var_os("UMBRAGE_SHARED").map_or(beside, PathBuf::from).join("references")
}

/// Standard output of a Python program, or `None` where it failed.
fn python(arguments: &[&str]) -> Option<String> {
    let output = Command::new("python3").args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

struct Reference {
    visibility: Image<f32>,
    mask: Image<bool>,
    depth: Image<f32>,
    model: Image<i32>,
}

fn read(stem: &str) -> Reference {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let out = folder.path().to_str().expect("a path in UTF-8");
    let size = python(&["-c", UNPACK, stem, out]).expect("a readable reference");
    let mut size = size.split_whitespace().map(|n| n.parse::<u32>().expect("a number of pixels"));
    let (width, height) = (size.next().expect("a width"), size.next().expect("a height"));
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).expect("an unpacked array");
    let floats = |name: &str| bytes(name).as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    Reference {
        visibility: Image { width, height, data: floats("visibility") },
        mask: Image { width, height, data: bytes("mask").iter().map(|b| *b != 0).collect() },
        depth: Image { width, height, data: floats("depth") },
        model: Image {
            width,
            height,
            data: bytes("model").as_chunks::<4>().0.iter().map(|b| i32::from_le_bytes(*b)).collect(),
        },
    }
}

/// A picture in NumPy's format, version 1.0.
fn write_npy(path: &Path, image: &Image<f32>) {
    let mut header =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", image.height, image.width);
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(image.data.iter().flat_map(|v| v.to_le_bytes()));
    std::fs::write(path, bytes).expect("a writable temporary folder");
}

/// Pictures that are wrong in different ways.
fn perturbed(truth: &Image<f32>) -> Vec<(&'static str, Image<f32>)> {
    let moved = Image::from_fn(truth.width, truth.height, |x, y| truth[(x.saturating_sub(2), y)]);
    let noisy = Image::from_fn(truth.width, truth.height, |x, y| {
        let hash = (x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b)).wrapping_mul(0xc2b2_ae35) >> 8;
        truth[(x, y)] + (hash as f32 / (1 << 24) as f32 - 0.5) * 0.06
    });
    let mut broken = truth.map(|v| v.round());
    (0..40).for_each(|x| broken[(200 + x, 200)] = if x % 2 == 0 { f32::NAN } else { f32::NEG_INFINITY });
    vec![("the same", truth.clone()), ("moved", moved), ("noisy", noisy), ("broken", broken)]
}

#[test]
#[ignore = "needs the shared references and python3 with numpy and pillow"]
fn the_numbers_are_those_of_the_script() {
    let folder = references();
    let script = folder.join("score.py");
    assert!(script.is_file(), "there is no {}; UMBRAGE_SHARED names the folder that holds it", script.display());
    assert!(python(&["-c", "import numpy, PIL"]).is_some(), "python3 lacks numpy or pillow");
    let temporary = tempfile::tempdir().expect("a folder for temporary files");
    for name in ["bunny.light0", "city.light1"] {
        let stem = folder.join(name);
        let stem = stem.to_str().expect("a path in UTF-8");
        let reference = read(stem);
        let edge = discontinuities(&reference.depth, &reference.model);
        let mut mask = reference.mask.clone();
        mask.data.iter_mut().zip(&edge.data).for_each(|(scored, edge)| *scored &= !edge);
        for (how, produced) in perturbed(&reference.visibility) {
            let path = temporary.path().join("produced.npy");
            write_npy(&path, &produced);
            let printed = python(&[
                script.to_str().expect("a path in UTF-8"),
                path.to_str().expect("a path in UTF-8"),
                &format!("{stem}.visibility.png"),
            ]);
            let theirs: serde_json::Value =
                serde_json::from_str(&printed.expect("a picture that the script scores")).expect("JSON");
            let reference = &reference.visibility;
            let comparison =
                Comparison { produced: &produced, reference, mask: &mask, hard: None, reach: None, contacts: None };
            let ours = score(&comparison).expect("comparable pictures");
            for (key, ours) in [
                ("mae", ours.mae),
                ("rmse", ours.rmse),
                ("p99_abs", ours.p99),
                ("correct_pct", ours.correct_pct),
                ("interior_pct", ours.interior_pct.expect("some interior")),
                ("leak", ours.leak),
                ("false_shadow", ours.false_shadow),
                ("scored_pixels", ours.scored_pixels as f64),
                ("not_finite", ours.not_finite as f64),
            ] {
                let theirs = theirs[key].as_f64().expect("a number of that name");
                assert!((ours - theirs).abs() <= 1e-6, "{name}, {how}: {key} is {ours}, the script says {theirs}");
            }
        }
    }
}
