//! The data of `report.json`. Names are stable; a change that breaks readers raises [`SCHEMA`].

pub use crate::status::Status;
use crate::{choice::Choice, error::Error, made::Made, round::maybe_six, round::six};
use serde::{Serialize, Serializer};
use std::{collections::BTreeMap, fmt::Display};
use umbrage_metrics::{Aliasing, RadianceScores, Scores};

/// Version of the data in `report.json` and of what `bench` prints.
pub const SCHEMA: u32 = 1;

/// What `compare` found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: u32,
    /// Circumstances.
    pub made: Made,
    /// One for each scene, as given.
    pub scenes: Vec<SceneRecord>,
}

/// A scene and what was found in it.
#[derive(Clone, Debug, Serialize)]
pub struct SceneRecord {
    /// Its title.
    pub name: String,
    /// Registry name or path, as given.
    pub source: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Triangles, each instance counted.
    pub triangles: usize,
    /// Placed meshes.
    pub instances: usize,
    /// What the loader made up or left out, what single precision cannot tell apart, and which maps
    /// are too coarse.
    pub notes: Vec<String>,
    /// One for each light of the scene.
    pub lights: Vec<LightRecord>,
}

/// A light and what the techniques made of it.
#[derive(Clone, Debug, Serialize)]
pub struct LightRecord {
    /// Its number in the scene, from 0.
    pub light: usize,
    /// `point`, `spot`, `directional`, `sun`, `sphere`, `ellipsoid`, `disc`, `rect`, `line` or
    /// `environment`.
    pub kind: &'static str,
    /// True where it has an extent.
    pub soft: bool,
    /// The truth.
    pub reference: ReferenceRecord,
    /// One for each technique asked for.
    pub results: Vec<ResultRecord>,
}

/// The truth that techniques are held against.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceRecord {
    /// In words: how it was made, or the file it was read from.
    pub source: String,
    /// Rays for each scored pixel; null for a stored picture.
    pub samples: Option<u32>,
    /// Seconds that tracing it took.
    #[serde(serialize_with = "six")]
    pub seconds: f64,
    /// Pixels that count: receiving surfaces that face the light, without those beside depth
    /// discontinuities.
    pub scored_pixels: usize,
    /// Mean absolute error of the perfect hard shadow, the unit of `vs_hard`; null for hard lights.
    #[serde(serialize_with = "maybe_six")]
    pub hard_mae: Option<f64>,
    /// What its own randomness is about, as a mean over the scored pixels, see
    /// [`umbrage_metrics::standard_error`]; null for a stored picture. Of radiance as a share of
    /// the mean luminance.
    #[serde(serialize_with = "maybe_six")]
    pub standard_error: Option<f64>,
    /// Pictures by kind, relative to the report: `color`, `visibility`, and `hard` for soft lights.
    pub pictures: BTreeMap<&'static str, String>,
}

/// What one technique made of one light.
#[derive(Clone, Debug, Serialize)]
pub struct ResultRecord {
    /// Its id.
    pub technique: String,
    /// Its title.
    pub title: String,
    /// Parameters set away from their defaults.
    pub settings: BTreeMap<String, String>,
    /// Points of the light that were averaged by brute force; null without.
    pub light_samples: Option<u32>,
    /// How it ended.
    pub status: Status,
    /// Why it is not `ok`; null where it is.
    pub reason: Option<String>,
    /// Errors of visibility; null unless `ok`.
    pub scores: Option<ScoresRecord>,
    /// Errors of radiance; only there where the technique answers with radiance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radiance: Option<RadianceRecord>,
    /// Costs; null unless `ok`.
    pub cost: Option<CostRecord>,
    /// Size of the maps' texels on the screen over the scored pixels; null without maps, and unless
    /// `ok`.
    pub aliasing: Option<AliasingRecord>,
    /// Pictures by kind, relative to the report: `color`, `visibility`, `error`, and `aliasing` for
    /// techniques with maps.
    pub pictures: BTreeMap<&'static str, String>,
}

impl ResultRecord {
    /// A choice's, with nothing found yet.
    pub(crate) fn of(choice: &Choice) -> Self {
        Self {
            technique: choice.info.id.into(),
            title: choice.info.title.into(),
            settings: choice.changed().clone(),
            light_samples: choice.light_samples,
            status: Status::Ok,
            reason: None,
            scores: None,
            radiance: None,
            cost: None,
            aliasing: None,
            pictures: BTreeMap::new(),
        }
    }

    /// What failed has a reason and nothing else.
    pub(crate) fn fail(&mut self, error: &Error) {
        let (status, reason) = Status::of(error);
        (self.status, self.reason) = (status, Some(reason));
        (self.scores, self.radiance, self.cost, self.aliasing) = (None, None, None, None);
        self.pictures.clear();
    }
}

/// Errors over the scored pixels, see [`Scores`].
#[derive(Clone, Debug, Serialize)]
pub struct ScoresRecord {
    /// See [`Scores::mae`]; so for the others.
    #[serde(serialize_with = "six")]
    pub mae: f64,
    /// Root of the mean square.
    #[serde(serialize_with = "six")]
    pub rmse: f64,
    /// 99th percentile.
    #[serde(serialize_with = "six")]
    pub p99: f64,
    /// Structural similarity.
    #[serde(serialize_with = "six")]
    pub ssim: f64,
    /// Mean ꟻLIP.
    #[serde(serialize_with = "six")]
    pub flip: f64,
    /// Percentage correct.
    #[serde(serialize_with = "six")]
    pub correct_pct: f64,
    /// Percentage correct far from shadow edges; null where there is no such pixel.
    #[serde(serialize_with = "maybe_six")]
    pub interior_pct: Option<f64>,
    /// Mean light in the shadow.
    #[serde(serialize_with = "six")]
    pub leak: f64,
    /// Mean shadow in the light.
    #[serde(serialize_with = "six")]
    pub false_shadow: f64,
    /// Share of the error of a perfect hard shadow; null for hard lights.
    #[serde(serialize_with = "maybe_six")]
    pub vs_hard: Option<f64>,
    /// Grain in smooth penumbras, see [`Scores::noise`]; null where there is none.
    #[serde(serialize_with = "maybe_six")]
    pub noise: Option<f64>,
    /// Single wrong pixels, see [`Scores::speckles`].
    pub speckles: usize,
    /// How far outlines of shadows are off, pixels: half of their points are no farther; null
    /// where there is no outline.
    #[serde(serialize_with = "maybe_six")]
    pub edge_offset_p50: Option<f64>,
    /// The same of 99 in 100 points.
    #[serde(serialize_with = "maybe_six")]
    pub edge_offset_p99: Option<f64>,
    /// Width of the light between casters and their shadows, pixels, see [`Scores::contact_gap`];
    /// null where nothing dark touches.
    #[serde(serialize_with = "maybe_six")]
    pub contact_gap: Option<f64>,
    /// What the reference's own randomness is about, see [`umbrage_metrics::standard_error`];
    /// null for stored references, whose rays are not known.
    #[serde(serialize_with = "maybe_six")]
    pub reference_error: Option<f64>,
    /// How many times as far off edges are around borders between maps, see
    /// [`umbrage_metrics::seam`]; null without borders.
    #[serde(serialize_with = "maybe_six")]
    pub seam: Option<f64>,
    /// Pixels compared.
    pub scored_pixels: usize,
    /// How many of them were NaN or infinite.
    pub not_finite: usize,
}

impl From<Scores> for ScoresRecord {
    fn from(s: Scores) -> Self {
        Self {
            mae: s.mae,
            rmse: s.rmse,
            p99: s.p99,
            ssim: s.ssim,
            flip: s.flip,
            correct_pct: s.correct_pct,
            interior_pct: s.interior_pct,
            leak: s.leak,
            false_shadow: s.false_shadow,
            vs_hard: s.vs_hard,
            noise: s.noise,
            speckles: s.speckles,
            edge_offset_p50: s.edge_offset.map(|offset| offset.p50),
            edge_offset_p99: s.edge_offset.map(|offset| offset.p99),
            contact_gap: s.contact_gap,
            reference_error: None,
            seam: None,
            scored_pixels: s.scored_pixels,
            not_finite: s.not_finite,
        }
    }
}

/// Errors of radiance over the scored pixels, see [`RadianceScores`].
#[derive(Clone, Debug, Serialize)]
pub struct RadianceRecord {
    /// See [`RadianceScores::relative_mae`]; so for the others.
    #[serde(serialize_with = "maybe_six")]
    pub relative_mae: Option<f64>,
    /// Root of the mean square.
    #[serde(serialize_with = "maybe_six")]
    pub relative_rmse: Option<f64>,
    /// Mean error, over 0 where the picture is too bright.
    #[serde(serialize_with = "maybe_six")]
    pub relative_bias: Option<f64>,
    /// Mean ꟻLIP of the tone-mapped pictures, with what is not scored as in the truth.
    #[serde(serialize_with = "six")]
    pub flip: f64,
    /// Percentage of pixels with a channel under 0.
    #[serde(serialize_with = "six")]
    pub negative_pct: f64,
    /// Pixels compared.
    pub scored_pixels: usize,
    /// How many of them were NaN or infinite.
    pub not_finite: usize,
}

impl RadianceRecord {
    /// Of scores, and of the ꟻLIP that belongs to them.
    pub(crate) fn new(s: RadianceScores, flip: f64) -> Self {
        Self {
            flip,
            relative_mae: s.relative_mae,
            relative_rmse: s.relative_rmse,
            relative_bias: s.relative_bias,
            negative_pct: s.negative_pct,
            scored_pixels: s.scored_pixels,
            not_finite: s.not_finite,
        }
    }
}

/// How many pixels a texel reaches on the screen, see [`Aliasing`].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct AliasingRecord {
    /// Half of the pixels have no larger one.
    #[serde(serialize_with = "six")]
    pub median: f64,
    /// 95 of 100 pixels have no larger one.
    #[serde(serialize_with = "six")]
    pub p95: f64,
    /// 99 of 100 pixels have no larger one.
    #[serde(serialize_with = "six")]
    pub p99: f64,
}

impl From<Aliasing> for AliasingRecord {
    fn from(Aliasing { median, p95, p99 }: Aliasing) -> Self {
        Self { median, p95, p99 }
    }
}

/// What a technique costs. Times are medians over the frames after warm-up.
#[derive(Clone, Debug, Serialize)]
pub struct CostRecord {
    /// Frames measured.
    pub frames: u32,
    /// GPU time of each of the technique's passes; empty where the adapter keeps no time.
    pub passes: Vec<PassRecord>,
    /// GPU time of all its passes; null where the adapter keeps no time.
    #[serde(serialize_with = "maybe_six")]
    pub gpu_ms: Option<f64>,
    /// CPU time of the technique's `prepare`.
    #[serde(serialize_with = "six")]
    pub prepare_ms: f64,
    /// The whole frame from start to finished picture: G-buffer, shadow, shading.
    #[serde(serialize_with = "six")]
    pub frame_ms: f64,
    /// Draw calls of the technique.
    pub draws: u32,
    /// Triangles it sends to the GPU.
    pub triangles: u64,
    /// GPU memory it holds, bytes.
    pub bytes: u64,
    /// More numbers of its last frame, by name, in the technique's own order.
    #[serde(serialize_with = "in_order")]
    pub counts: Vec<(&'static str, u64)>,
}

/// Writes counts as an object with the names in the order given.
pub(crate) fn in_order<S: Serializer>(counts: &[(&str, u64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(counts.iter().copied())
}

/// Writes what a value prints as.
pub(crate) fn as_text<S: Serializer>(value: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}

/// GPU time of a pass.
#[derive(Clone, Debug, Serialize)]
pub struct PassRecord {
    /// Its name.
    pub pass: String,
    /// Milliseconds.
    #[serde(serialize_with = "six")]
    pub time_ms: f64,
}

#[cfg(test)]
mod tests {
    use super::RadianceRecord;
    use crate::fixture::fixture;

    #[test]
    fn names_and_numbers_in_json_are_stable() {
        let json = serde_json::to_value(fixture()).unwrap();
        assert_eq!(json["schema"], 1);
        let results = &json["scenes"][0]["lights"][0]["results"];
        assert_eq!(results[0]["scores"]["mae"], 0.0123457);
        assert_eq!(results[0]["scores"]["interior_pct"], serde_json::Value::Null);
        assert_eq!(results[0]["cost"]["bytes"], 4 << 20);
        assert_eq!(results[0]["aliasing"], serde_json::json!({"median": 1.5, "p95": 3.0, "p99": null}));
        assert_eq!(
            (&results[1]["status"], &results[1]["reason"]),
            (&"unsupported".into(), &"not for line lights".into())
        );
        assert_eq!(results[2]["status"], "failed");
        let text = serde_json::to_string(&fixture()).unwrap();
        assert!(text.contains(r#""counts":{"edges":40,"caps":2}"#), "{text}");
    }

    #[test]
    fn every_column_finds_its_number() {
        let mut result = fixture().scenes.remove(0).lights.remove(0).results.remove(0);
        assert!(serde_json::to_value(&result).unwrap().get("radiance").is_none(), "readers know no such name");
        result.radiance = Some(RadianceRecord {
            relative_mae: Some(0.1),
            relative_rmse: Some(0.2),
            relative_bias: Some(0.0),
            flip: 0.3,
            negative_pct: 1.0,
            scored_pixels: 9,
            not_finite: 0,
        });
        let result = serde_json::to_value(&result).unwrap();
        for column in crate::column::COLUMNS.into_iter().chain(crate::column::RADIANCE_COLUMNS) {
            let [group, field] = column.path;
            assert!(result[group].get(field).is_some(), "column {} points at nothing", column.name);
        }
    }
}
