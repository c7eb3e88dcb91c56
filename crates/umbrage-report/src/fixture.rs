//! A small report for tests.

use crate::{
    made::Made,
    record::{
        AliasingRecord, CostRecord, LightRecord, PassRecord, ReferenceRecord, Report, ResultRecord, SCHEMA,
        SceneRecord, ScoresRecord, Status,
    },
};
use std::collections::BTreeMap;

/// One scene, one light, a result of each status.
pub(crate) fn fixture() -> Report {
    let adapter = umbrage::AdapterSummary {
        name: "llvmpipe".into(),
        backend: "Vulkan".into(),
        kind: "software",
        driver: "Mesa".into(),
        unusable: None,
    };
    let result = |technique: &str, status, reason: Option<&str>| ResultRecord {
        technique: technique.into(),
        title: "A technique".into(),
        settings: BTreeMap::from([("size".into(), "512".into())]),
        light_samples: None,
        status,
        reason: reason.map(String::from),
        scores: None,
        radiance: None,
        cost: None,
        aliasing: None,
        pictures: BTreeMap::new(),
    };
    let mut good = result("shadow-map", Status::Ok, None);
    good.scores = Some(ScoresRecord {
        mae: 0.0123456789,
        rmse: 0.1,
        p99: 1.0,
        ssim: 0.98,
        flip: 0.02,
        correct_pct: 98.5,
        interior_pct: None,
        leak: 0.01,
        false_shadow: 0.0023456,
        vs_hard: Some(1.5),
        noise: Some(0.0125),
        speckles: 3,
        edge_offset_p50: Some(0.25),
        edge_offset_p99: Some(2.5),
        contact_gap: Some(1.75),
        reference_error: Some(0.0005),
        seam: Some(1.125),
        scored_pixels: 1000,
        not_finite: 0,
    });
    good.cost = Some(CostRecord {
        frames: 7,
        passes: vec![PassRecord { pass: "map".into(), time_ms: 1.25 }],
        gpu_ms: Some(2.5),
        prepare_ms: 0.125,
        frame_ms: 9.75,
        draws: 12,
        triangles: 3456,
        bytes: 4 << 20,
        counts: vec![("edges", 40), ("caps", 2)],
    });
    good.aliasing = Some(AliasingRecord { median: 1.5, p95: 3.0, p99: f64::INFINITY });
    let light = LightRecord {
        light: 0,
        kind: "line",
        soft: true,
        reference: ReferenceRecord {
            source: "ray-traced, 256 samples".into(),
            samples: Some(256),
            seconds: 1.5,
            scored_pixels: 1000,
            hard_mae: Some(0.02),
            standard_error: Some(0.0005),
            pictures: BTreeMap::new(),
        },
        results: vec![
            good,
            result("pcf", Status::Unsupported, Some("not for line lights")),
            result("volume", Status::Failed, Some("the graphics device was lost")),
        ],
    };
    Report {
        schema: SCHEMA,
        made: Made::now(vec!["umbrage".into(), "compare".into()], &adapter),
        scenes: vec![SceneRecord {
            name: "boxes".into(),
            source: "boxes.scene.toml".into(),
            width: 64,
            height: 48,
            triangles: 100,
            instances: 3,
            notes: vec!["no camera: one was made".into()],
            lights: vec![light],
        }],
    }
}
