//! What `bench` found, as JSON has it.

use crate::{
    flicker::Found,
    made::Made,
    measure::Frames,
    motion::Moving,
    record::{as_text, in_order},
    round::maybe_six,
    spread::Spread,
    status::Status,
    way::Way,
};
use serde::Serialize;
use std::collections::BTreeMap;
use umbrage::{Owner, Stats};

/// What `bench` found.
#[derive(Clone, Debug, Serialize)]
pub struct BenchReport {
    /// [`SCHEMA`](crate::record::SCHEMA).
    pub schema: u32,
    /// Circumstances.
    pub made: Made,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Frames of each technique, after those of warm-up.
    pub frames: u32,
    /// What moved from frame to frame.
    pub moving: Moving,
    /// Where the camera or the light went; null where neither was on one of the paths.
    pub path: Option<Way>,
    /// Instances that were removed and inserted again in every frame.
    pub churn: u32,
    /// One for each scene, as given.
    pub scenes: Vec<BenchScene>,
}

/// A scene that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct BenchScene {
    /// Its title.
    pub name: String,
    /// Registry name or path, as given.
    pub source: String,
    /// Triangles, each instance counted.
    pub triangles: usize,
    /// Placed meshes.
    pub instances: usize,
    /// One for each light of the scene, or one for all of them together.
    pub lights: Vec<BenchLight>,
}

/// A light that was measured, or several in the same frame: then all numbers are of all of them
/// together.
#[derive(Clone, Debug, Serialize)]
pub struct BenchLight {
    /// Its number in the scene, from 0; null for several together.
    pub light: Option<usize>,
    /// Its kind; `all` for several together.
    pub kind: &'static str,
    /// The numbers of the lights that were measured together; null for one alone.
    pub together: Option<Vec<usize>>,
    /// Flicker of the truth, see [`BenchResult::flicker`]: what the picture's own grid adds, or how
    /// much the light's motion changes. Null without a path.
    #[serde(serialize_with = "maybe_six")]
    pub flicker_reference: Option<f64>,
    /// How many changes it is the mean of; null without a path.
    pub flicker_points: Option<usize>,
    /// Baselines first, then the techniques asked for.
    pub results: Vec<BenchResult>,
}

/// What one technique, or baseline, took.
#[derive(Clone, Debug, Serialize)]
pub struct BenchResult {
    /// Its id; `floor` and `bare-minimum` are the baselines.
    pub technique: String,
    /// Parameters set away from their defaults.
    pub settings: BTreeMap<String, String>,
    /// Points of the light that were averaged by brute force; null without.
    pub light_samples: Option<u32>,
    /// How it ended.
    pub status: Status,
    /// Why it is not `ok`; null where it is.
    pub reason: Option<String>,
    /// The numbers; null unless `ok`.
    pub cost: Option<BenchCost>,
    /// GPU time and preparation over those of the floor; null where there is no GPU time.
    #[serde(serialize_with = "maybe_six")]
    pub vs_floor: Option<f64>,
    /// The same over the bare minimum with as many maps of the same size.
    #[serde(serialize_with = "maybe_six")]
    pub vs_bare_minimum: Option<f64>,
    /// Mean absolute change of visibility from frame to frame at fixed points of the scene, 0 to 1,
    /// see [`umbrage_metrics::Flicker`]. Null without a path.
    #[serde(serialize_with = "maybe_six")]
    pub flicker: Option<f64>,
    /// The same over that of the truth, at the same points: 1 is steady. Null where that is 0, too.
    #[serde(serialize_with = "maybe_six")]
    pub flicker_ratio: Option<f64>,
    /// Mean of |change − the truth's change| at the same points, 0 to 1. Null without a path.
    #[serde(serialize_with = "maybe_six")]
    pub change_error: Option<f64>,
}

/// Times, milliseconds, and what was drawn.
#[derive(Clone, Debug, Serialize)]
pub struct BenchCost {
    /// GPU time of every pass of the frame, also those of the renderer; empty where the adapter
    /// keeps no time.
    pub passes: Vec<BenchPass>,
    /// GPU time of the technique's own passes together; null where the adapter keeps no time.
    pub gpu_ms: Option<Spread>,
    /// CPU time of the technique's `prepare`; an overlay's includes recording.
    pub prepare_ms: Spread,
    /// CPU time of removing and inserting instances in a frame, and of recording that; null where
    /// none came and went.
    pub change_ms: Option<Spread>,
    /// The whole frame from start to finished picture.
    pub frame_ms: Spread,
    /// Draw calls of the technique.
    pub draws: u32,
    /// Triangles it sends to the GPU.
    pub triangles: u64,
    /// GPU memory it holds, bytes.
    pub bytes: u64,
    /// Fragments of every render pass of the technique and bytes that they move; null where they
    /// were not counted.
    pub traffic: Option<Vec<BenchTraffic>>,
    /// More numbers of its last frame, by name, in the technique's own order.
    #[serde(serialize_with = "in_order")]
    pub counts: Vec<(&'static str, u64)>,
}

/// What a render pass of a technique draws and moves.
#[derive(Clone, Debug, Serialize)]
pub struct BenchTraffic {
    /// The pass.
    pub pass: String,
    /// Fragments that reached its target, see [`umbrage::PassFragments`].
    pub fragments: u64,
    /// Bytes that they read and write in attachments and, at most, in textures. Null where the
    /// technique does not say what it reads.
    pub bytes: Option<u64>,
}

/// GPU time of a pass.
#[derive(Clone, Debug, Serialize)]
pub struct BenchPass {
    /// Whose it is: `light N` for the technique's, others are the renderer's.
    #[serde(serialize_with = "as_text")]
    pub owner: Owner,
    /// Its name.
    pub pass: String,
    /// Milliseconds.
    pub time_ms: Spread,
}

impl BenchLight {
    /// In words.
    pub(crate) fn title(&self) -> String {
        let numbers = self.together.iter().flatten().map(usize::to_string).collect::<Vec<_>>().join(", ");
        self.light.map_or(format!("lights {numbers} together"), |light| format!("light {light} ({})", self.kind))
    }

    /// The last results are those of the techniques; one that failed has none.
    pub(crate) fn set_flicker(&mut self, found: &Found) {
        (self.flicker_reference, self.flicker_points) = (found.reference, Some(found.points));
        let baselines = self.results.len().saturating_sub(found.techniques.len());
        for (result, (flicker, off)) in self.results[baselines..].iter_mut().zip(&found.techniques) {
            result.flicker = flicker.filter(|_| result.status == Status::Ok);
            result.change_error = off.filter(|_| result.status == Status::Ok);
            let reference = found.reference.filter(|reference| *reference > 0.0);
            result.flicker_ratio = result.flicker.zip(reference).map(|(flicker, reference)| flicker / reference);
        }
    }
}

impl BenchCost {
    /// All that the technique adds to a frame: preparing it and its passes, milliseconds.
    pub fn added_ms(&self) -> Option<f64> {
        self.gpu_ms.map(|gpu| gpu.median + self.prepare_ms.median)
    }

    /// Fragments of all its passes together, and the bytes that they move, where all are known.
    pub(crate) fn moved(&self) -> Option<(u64, Option<u64>)> {
        let passes = self.traffic.as_ref()?;
        Some((passes.iter().map(|p| p.fragments).sum(), passes.iter().map(|p| p.bytes).sum()))
    }

    /// Of measured frames, and what the techniques of all their lights drew and hold.
    pub(crate) fn new(
        frames: &Frames,
        stats: &[Stats],
        traffic: Option<Vec<BenchTraffic>>,
        counts: Vec<(&'static str, u64)>,
    ) -> Self {
        let passes = frames.passes().into_iter();
        Self {
            passes: passes.map(|(owner, pass, time_ms)| BenchPass { owner, pass, time_ms }).collect(),
            gpu_ms: frames.technique(),
            prepare_ms: frames.prepare(),
            change_ms: frames.change(),
            frame_ms: frames.frame(),
            draws: stats.iter().map(|s| s.draws).sum(),
            triangles: stats.iter().map(|s| s.triangles).sum(),
            bytes: stats.iter().map(|s| s.bytes).sum(),
            traffic,
            counts,
        }
    }
}
