//! The numbers that tables show: declared once for the terminal, the page and the CSV file.

use serde::Serialize;
use serde_json::Value;

/// One number of a result.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Column {
    /// Heading.
    pub name: &'static str,
    /// One line that explains it.
    pub help: &'static str,
    /// Where it is in a result of `report.json`.
    pub path: [&'static str; 2],
    /// `less` or `more` is better, and the best is marked; null for halves of an error and for
    /// costs, where doing nothing wins.
    pub better: Option<&'static str>,
    /// What one unit of the heading is in units of the data.
    pub scale: f64,
    /// Digits after the point.
    pub digits: usize,
    /// Whether it is shown on the terminal and under pictures too.
    pub brief: bool,
}

const fn score(
    name: &'static str,
    better: Option<&'static str>,
    digits: usize,
    brief: bool,
    help: &'static str,
) -> Column {
    Column { name, help, path: ["scores", name], better, scale: 1.0, digits, brief }
}

const fn texels(name: &'static str, field: &'static str, help: &'static str) -> Column {
    Column { name, help, path: ["aliasing", field], better: Some("less"), scale: 1.0, digits: 2, brief: false }
}

const fn cost(
    name: &'static str,
    field: &'static str,
    scale: f64,
    digits: usize,
    brief: bool,
    help: &'static str,
) -> Column {
    Column { name, help, path: ["cost", field], better: None, scale, digits, brief }
}

/// All of them, errors first.
pub const COLUMNS: [Column; 26] = [
    score("mae", Some("less"), 4, true, "Mean absolute error of visibility over the scored pixels, 0 to 1."),
    score("rmse", Some("less"), 4, false, "Root of the mean squared error: large errors weigh more."),
    score("p99", Some("less"), 3, false, "99 of 100 scored pixels are off by no more than this."),
    score("ssim", Some("more"), 4, false, "Structural similarity to the reference: 1 is the same."),
    score(
        "flip",
        Some("less"),
        4,
        false,
        "ꟻLIP: the difference seen by somebody who flips between the two pictures, 0 to 1.",
    ),
    score("correct_pct", Some("more"), 2, true, "Percentage of scored pixels whose visibility is off by at most 0.02."),
    score(
        "interior_pct",
        Some("more"),
        2,
        true,
        "Percentage correct far from every shadow edge: acne and peter-panning show here.",
    ),
    score("leak", None, 4, false, "Mean light where there should be shadow."),
    score("false_shadow", None, 4, false, "Mean shadow where there should be light."),
    score(
        "vs_hard",
        Some("less"),
        3,
        true,
        "Error as a share of that of a perfect hard shadow: 1 is no better than hard, 0 is the truth. Soft lights only.",
    ),
    score(
        "noise",
        Some("less"),
        4,
        true,
        "Grain: standard deviation of what changes from pixel to pixel in the error of smooth penumbras.",
    ),
    score("speckles", Some("less"), 0, true, "Single pixels that differ from all around them, where the reference has none."),
    Column {
        name: "edge px",
        help: "Half of the points of shadow outlines (visibility one half) are no farther from the reference's, pixels.",
        ..score("edge_offset_p50", Some("less"), 2, false, "")
    },
    Column {
        name: "edge 99 %",
        help: "99 of 100 points of shadow outlines are no farther from the reference's, pixels; 32 is the most.",
        ..score("edge_offset_p99", Some("less"), 2, true, "")
    },
    Column {
        name: "contact px",
        help: "Mean width of the light between casters and the shadows that should touch them, pixels.",
        ..score("contact_gap", Some("less"), 2, true, "")
    },
    Column {
        name: "± reference",
        help: "What the reference's own randomness is about: a smaller difference of errors says nothing.",
        ..score("reference_error", None, 5, false, "")
    },
    score(
        "seam",
        Some("less"),
        2,
        true,
        "How many times as far off shadow edges are around the borders between maps (within 5 % of their distance) as elsewhere.",
    ),
    texels(
        "texel px",
        "median",
        "Size of the map's texels as seen on the screen, pixels, median of the scored pixels.",
    ),
    texels("texel 95 %", "p95", "95 of 100 scored pixels have no larger texel, pixels."),
    texels("texel 99 %", "p99", "99 of 100 scored pixels have no larger texel, pixels."),
    cost("gpu ms", "gpu_ms", 1.0, 2, true, "GPU time of all passes of the technique, median."),
    cost("prepare ms", "prepare_ms", 1.0, 2, false, "CPU time of the technique's preparation of a frame, median."),
    cost(
        "frame ms",
        "frame_ms",
        1.0,
        2,
        true,
        "Whole frame from start to finished picture: G-buffer, shadow, shading, median.",
    ),
    cost("MiB", "bytes", 1_048_576.0, 2, true, "GPU memory that the technique holds, in mebibytes."),
    cost("draws", "draws", 1.0, 0, false, "Draw calls of the technique in a frame."),
    cost("triangles", "triangles", 1.0, 0, false, "Triangles that the technique sends to the GPU in a frame."),
];

const fn radiance(
    name: &'static str,
    field: &'static str,
    better: Option<&'static str>,
    digits: usize,
    brief: bool,
    help: &'static str,
) -> Column {
    Column { name, help, path: ["radiance", field], better, scale: 1.0, digits, brief }
}

/// Those of techniques that answer with radiance; shown where there are some.
pub const RADIANCE_COLUMNS: [Column; 5] = [
    radiance(
        "relative mae",
        "relative_mae",
        Some("less"),
        4,
        true,
        "Mean absolute error of luminance over the scored pixels, as a share of the truth's mean luminance.",
    ),
    radiance(
        "relative rmse",
        "relative_rmse",
        Some("less"),
        4,
        true,
        "Root of the mean squared error of luminance, as a share of the truth's mean luminance.",
    ),
    radiance(
        "relative bias",
        "relative_bias",
        None,
        4,
        false,
        "Mean error of luminance, as a share of the truth's mean luminance: over 0 where the picture is too bright.",
    ),
    radiance(
        "radiance flip",
        "flip",
        Some("less"),
        4,
        true,
        "ꟻLIP of the tone-mapped pictures: the difference seen by somebody who flips between them, 0 to 1.",
    ),
    radiance(
        "negative %",
        "negative_pct",
        Some("less"),
        2,
        true,
        "Percentage of scored pixels with a channel under 0.",
    ),
];

impl Column {
    /// The number of a result given as JSON; `None` where it has none.
    pub fn value(&self, result: &Value) -> Option<f64> {
        result[self.path[0]][self.path[1]].as_f64()
    }

    /// The number as the table shows it.
    pub fn text(&self, result: &Value) -> String {
        self.value(result).map_or("–".into(), |v| format!("{:.*}", self.digits, v / self.scale))
    }
}
