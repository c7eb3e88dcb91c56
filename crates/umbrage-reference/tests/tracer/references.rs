//! The tracer against pictures of other software, some rows of each. The example `check_references`
//! takes all rows.

use std::path::{Path, PathBuf};
use umbrage_io::stored::{self, StoredReference};
use umbrage_metrics::{Comparison, discontinuities, score};
use umbrage_reference::{Options, Tracer};

/// One row of this many is traced.
const ROWS: u32 = 32;

#[test]
#[ignore = "needs the shared references"]
fn some_rows_of_every_stored_picture() {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("UMBRAGE_SHARED").map_or(beside, PathBuf::from).join("references");
    assert!(folder.is_dir(), "there is no {}; UMBRAGE_SHARED names the folder that holds it", folder.display());
    for (name, lights) in stored::list(&folder).expect("stored references") {
        let scene = umbrage_io::open(&folder.join(format!("scenes/{name}.scene.toml"))).expect("a scene").scene;
        let tracer = Tracer::new(&scene);
        for index in lights {
            let stored = StoredReference::open(&folder, &name, index).expect("a stored reference");
            let (width, height) = stored.visibility.size();
            let mut geometry = tracer.geometry(&scene.camera, width, height);
            let (mut mask, edge) = (stored.mask, discontinuities(&stored.depth, &stored.model.map(|&m| m.into())));
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|p| p.1 % ROWS != 5) {
                (geometry.receives[(x, y)], mask[(x, y)]) = (false, false);
            }
            let light = &scene.lights[index];
            let truth = tracer.visibility(&geometry, light, &scene.textures, &Options::default(), &|_, _| ());
            assert!(truth.scored == mask, "{name}, light {index}: other pixels are scored");

            mask.data.iter_mut().zip(&edge.data).for_each(|(scored, edge)| *scored &= !edge);
            let (produced, reference) = (&truth.visibility, &stored.visibility);
            let comparison = Comparison { produced, reference, mask: &mask, hard: None, reach: None, contacts: None };
            let scores = score(&comparison).expect("comparable pictures");
            let most = if light.shape.kind().is_soft() { 1e-3 } else { 2e-4 };
            let good = scores.mae <= most && scores.correct_pct >= 99.8;
            assert!(good, "{name}, light {index}: mae {}, {} % correct", scores.mae, scores.correct_pct);
        }
    }
}
