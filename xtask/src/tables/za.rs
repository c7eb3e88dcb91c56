//! ZA 5.1 to 5.4: shadow volumes, filtered and soft maps on a basic and a huge scene, for static
//! and dynamic light, and how right they are.

use super::{Run, bunny, file, frame_ms, head, make_scenes, measure, number, result, row};
use crate::bench;
use anyhow::{Result, ensure};
use serde_json::Value;
use std::fmt::Write;

/// Triangles of each of the seven bunnies of the huge scene, which amount to 114,107.
const BUNNY: usize = 16_301;
const SIZES: [u32; 2] = [700, 900];
const FRAMES: u32 = 8;

/// Points of the light that brute force is measured with for tables of 64 and of 100 points, a
/// quarter of them each: the huge scene with 64 would take longer than all the rest.
const POINTS: [u32; 2] = [16, 25];
const TIMES: f64 = 4.0;

/// Frames of brute force: one alone tells nothing of how far times scatter.
const BRUTE_FRAMES: u32 = 3;

/// Hard maps with and without the automatic bias, which midpoint maps are to do without.
const BIAS: [&str; 4] =
    ["shadow-map", "shadow-map:faces=midpoint", "shadow-map:bias=0", "shadow-map:faces=midpoint:bias=0"];

/// Scale, degrees of turn, and place of each bunny.
const BUNNIES: [(f64, f64, [f64; 2]); 7] = [
    (9.7, 15.0, [0.0, 0.0]),
    (7.0, 130.0, [-1.9, 0.4]),
    (8.0, -60.0, [1.9, 0.6]),
    (6.0, 80.0, [-0.9, 1.9]),
    (7.5, 200.0, [1.0, -1.7]),
    (9.0, 30.0, [-1.7, -1.7]),
    (5.5, -20.0, [0.9, 2.1]),
];

/// A method of the thesis, or one of ours beside it.
struct Method {
    /// What the thesis calls it; ours are called what they are.
    name: &'static str,
    /// How we do it; `None` where we don't. Brute force is without its number of points.
    technique: Option<&'static str>,
    /// Whether it averages over points of the light.
    brute: bool,
    /// The thesis' milliseconds, static and dynamic, at 700² and 900²: 17,408 triangles with 64
    /// points of the light.
    basic: [f64; 4],
    /// The same with 100 points.
    hundred: [f64; 4],
    /// The same for 114,107 triangles with 64 points.
    huge: [f64; 4],
    /// The thesis' percentage of correct pixels.
    correct: f64,
}

const fn method(
    name: &'static str,
    technique: Option<&'static str>,
    basic: [f64; 4],
    hundred: [f64; 4],
    huge: [f64; 4],
    correct: f64,
) -> Method {
    Method { name, technique, brute: false, basic, hundred, huge, correct }
}

const fn brute(method: Method) -> Method {
    Method { brute: true, ..method }
}

/// The same milliseconds whether the light moves or not.
const fn same(small: f64, large: f64) -> [f64; 4] {
    [small, small, large, large]
}

/// A method that the thesis does not have, and so has no numbers of.
const fn ours(name: &'static str, technique: &'static str) -> Method {
    const NONE: [f64; 4] = same(f64::NAN, f64::NAN);
    method(name, Some(technique), NONE, NONE, NONE, f64::NAN)
}

/// In the order of the thesis; basic maps are /b/, midpoint maps /m/.
const METHODS: [Method; 25] = [
    method("no shadow", Some("none"), same(0.89, 1.37), same(0.90, 1.38), same(3.92, 4.53), 57.193),
    method("volume, hard", Some("volume"), same(2.58, 3.62), same(2.52, 3.63), same(13.86, 16.08), 88.113),
    brute(method(
        "volume, depth pass",
        Some("volume:count=z-pass:reach=infinite:cull=none"),
        same(61.69, 88.26),
        same(96.43, 139.47),
        same(512.82, 568.18),
        99.939,
    )),
    brute(method(
        "volume, depth fail",
        Some("volume:count=z-fail:reach=infinite:cull=none"),
        same(100.00, 147.06),
        same(161.55, 234.19),
        same(645.16, 763.36),
        99.942,
    )),
    brute(method(
        "volume, XOR",
        Some("volume:count=xor:reach=infinite:cull=none"),
        same(97.28, 142.65),
        same(151.75, 222.22),
        same(558.66, 684.93),
        94.078,
    )),
    method("projective, hard", Some("projective"), same(1.45, 2.20), same(1.54, 2.24), same(6.62, 7.66), 88.348),
    brute(method(
        "projective, soft",
        Some("projective"),
        same(17.69, 26.06),
        same(26.79, 39.75),
        same(154.56, 163.93),
        95.759,
    )),
    method(
        "projective, fake",
        Some("projective-fake"),
        same(12.84, 19.66),
        same(13.78, 19.65),
        same(18.46, 25.36),
        92.288,
    ),
    method(
        "map, hard /b/",
        Some("shadow-map"),
        [1.85, 3.85, 2.64, 4.64],
        [1.84, 3.84, 2.65, 4.65],
        [6.62, 12.62, 7.68, 13.68],
        89.251,
    ),
    method(
        "map, hard /m/",
        Some("shadow-map:faces=midpoint"),
        [1.72, 14.72, 2.37, 15.37],
        [1.63, 14.63, 2.33, 15.33],
        [6.67, 25.67, 7.54, 26.54],
        88.770,
    ),
    brute(method(
        "map, soft /b/",
        Some("shadow-map"),
        [36.22, 152.22, 55.37, 171.37],
        [56.59, 238.59, 86.51, 268.51],
        [162.07, 390.07, 183.82, 411.82],
        99.549,
    )),
    brute(method(
        "map, soft /m/",
        Some("shadow-map:faces=midpoint"),
        [33.33, 204.33, 49.55, 220.55],
        [51.76, 317.76, 76.57, 342.57],
        [157.48, 585.48, 173.01, 601.01],
        99.416,
    )),
    method(
        "map, pcf 7×7 /b/",
        Some("pcf:kernel=7"),
        [35.29, 37.29, 52.60, 54.60],
        [34.28, 36.28, 51.55, 53.55],
        [67.52, 73.52, 90.09, 96.09],
        90.699,
    ),
    method(
        "map, pcf 7×7 /m/",
        Some("pcf:kernel=7:faces=midpoint"),
        [28.68, 41.68, 42.18, 55.18],
        [28.00, 41.00, 41.79, 54.79],
        [49.02, 68.02, 64.81, 83.81],
        90.710,
    ),
    method(
        "map, blur /b/",
        Some("pcf-blur:radius=7"),
        [11.75, 13.75, 12.34, 14.34],
        [11.81, 13.81, 12.38, 14.38],
        [19.28, 25.28, 19.22, 25.22],
        90.699,
    ),
    method(
        "map, blur /m/",
        Some("pcf-blur:radius=7:faces=midpoint"),
        [11.27, 24.27, 12.08, 25.08],
        [11.34, 24.34, 12.10, 25.10],
        [17.39, 36.39, 18.37, 37.37],
        90.710,
    ),
    method(
        "map, jitter /b/",
        Some("pcf-jitter"),
        [37.38, 39.38, 55.52, 57.52],
        [36.89, 38.89, 54.38, 56.38],
        [74.96, 80.96, 102.04, 108.04],
        93.925,
    ),
    method(
        "map, jitter /m/",
        Some("pcf-jitter:faces=midpoint"),
        [33.77, 46.77, 50.05, 63.05],
        [33.92, 46.92, 50.38, 63.38],
        [65.10, 84.10, 88.11, 107.11],
        94.008,
    ),
    method(
        "map, pcss /b/",
        Some("pcss:bounds=off"),
        [52.94, 56.94, 78.93, 82.93],
        [51.52, 55.52, 80.19, 84.19],
        [85.98, 94.98, 118.76, 127.76],
        94.994,
    ),
    method(
        "map, pcss /m/",
        Some("pcss:bounds=off:faces=midpoint"),
        [37.81, 59.81, 56.21, 78.21],
        [36.60, 58.60, 57.34, 79.34],
        [61.80, 89.80, 84.67, 112.67],
        95.756,
    ),
    method(
        "map, combined /b/",
        Some("pcss-jitter:noise=stratified"),
        [32.26, 36.26, 46.58, 50.58],
        [31.59, 35.59, 46.25, 50.25],
        [59.88, 68.88, 81.17, 90.17],
        94.560,
    ),
    method(
        "map, combined /m/",
        Some("pcss-jitter:noise=stratified:faces=midpoint"),
        [38.71, 60.71, 56.40, 78.40],
        [39.02, 61.02, 57.67, 79.67],
        [69.78, 97.78, 93.81, 121.81],
        95.325,
    ),
    ours("silhouette map, hard", "silhouette-map"),
    ours("smoothies", "smoothies"),
    ours("maps of a line light's ends", "linear-light"),
];

impl Method {
    /// As a list of techniques has it, brute force with so many points.
    fn label(&self, points: u32) -> Option<String> {
        let technique = self.technique?;
        Some(if self.brute { format!("{technique}:light-samples={points}") } else { technique.into() })
    }
}

/// Measures and writes `maps/`. Where techniques are named, only their methods and `none`.
pub fn run(only: &[&str]) -> Result<()> {
    let id = |m: &Method| m.technique.and_then(|technique| technique.split(':').next());
    for name in only {
        ensure!(METHODS.iter().any(|m| id(m) == Some(name)), "no method of tables ZA is done by `{name}`");
    }
    let is_wanted = |m: &&Method| only.is_empty() || id(m).is_some_and(|id| id == "none" || only.contains(&id));
    let methods: Vec<&Method> = METHODS.iter().filter(is_wanted).collect();

    let scenes = make_scenes(&[
        ("bunny-16301.obj", bunny(BUNNY)?),
        ("za-basic.scene.toml", include_str!("basic.scene.toml").into()),
        ("za-huge.scene.toml", huge()),
    ])?;
    let scenes = scenes[1..].join(" ");
    let labels = |brute: bool, points: &[u32]| -> Vec<String> {
        let of = |points: u32| methods.iter().filter(move |m| m.brute == brute).filter_map(move |m| m.label(points));
        points.iter().flat_map(|points| of(*points)).collect()
    };
    let (fast, mut brute) = (labels(false, &POINTS[..1]).join(","), labels(true, &POINTS).join(","));
    if brute.is_empty() {
        // Runs are found by their places.
        brute = "none".into();
    }
    let bench = |techniques: &str, size: u32, moving: &str, frames: u32| {
        let how = format!("--moving {moving} --frames {frames} --size {size}x{size} --json");
        format!("bench {scenes} --techniques {techniques} {how}")
    };
    let mut all = [labels(false, &POINTS[..1]), labels(true, &POINTS[..1])].concat();
    if only.is_empty() {
        all.extend(BIAS.iter().filter(|way| way.contains("bias")).map(|way| way.to_string()));
    }
    let all = all.join(",");
    let compare = format!(
        "compare {scenes} --techniques {all} --samples 1024 --size 350x350 --frames 1 --json -o target/tables/za"
    );
    let runs = [
        Run { file: "static-700.json", line: bench(&fast, SIZES[0], "still", FRAMES) },
        Run { file: "static-900.json", line: bench(&fast, SIZES[1], "still", FRAMES) },
        Run { file: "dynamic-700.json", line: bench(&fast, SIZES[0], "lights", FRAMES) },
        Run { file: "dynamic-900.json", line: bench(&fast, SIZES[1], "lights", FRAMES) },
        Run { file: "brute-force-700.json", line: bench(&brute, SIZES[0], "lights", BRUTE_FRAMES) },
        Run { file: "brute-force-900.json", line: bench(&brute, SIZES[1], "lights", BRUTE_FRAMES) },
        Run { file: "correctness.json", line: compare },
    ];
    let (folder, found) = measure("maps", &runs)?;
    file(&folder, &text(&found, &methods, only))
}

fn huge() -> String {
    let mut text = include_str!("huge.head.toml").to_string();
    for (scale, turn, [x, z]) in BUNNIES {
        // Its feet are 0.033 over its origin.
        let up = -0.033 * scale;
        let place =
            format!("scale = {scale:.1}\nrotate = [0.0, {turn:.1}, 0.0]\ntranslate = [{x:.2}, {up:.4}, {z:.2}]");
        // Writing to a string does not fail.
        let _ = write!(text, "\n[[model]]\npath = \"bunny-16301.obj\"\n{place}\n");
    }
    text
}

/// The reading's frame: the tables, and room for what they say.
fn text(found: &[Value], methods: &[&Method], only: &[&str]) -> String {
    let command = ["cargo xtask tables za", &only.join(" ")].join(" ");
    let mut text =
        bench::heading("Filtered and soft shadow maps, tables ZA 5.1 to 5.4,", &found[0]["made"], command.trim_end());
    let triangles = |scene: usize| found[0]["scenes"][scene]["triangles"].to_string();
    let _ = writeln!(
        text,
        "Scenes of {} and {} triangles under a sphere light of radius 0.5 m. Milliseconds of a frame, medians of {FRAMES} frames, techniques in \
         turn; *static*: nothing moves, and what a technique keeps is kept; *dynamic*: the light moves; *dynamic part*: the passes that only \
         frames with a moving light have. Brute force is measured with {} points of a light that moves for the tables of 64 and with {} for that \
         of 100, medians of {BRUTE_FRAMES} frames after three to warm up, and multiplied by {TIMES}; volumes have neither end nor culling \
         there, as in the thesis. In brackets the thesis' numbers of 2007: only ratios within a column compare.\n\nRaw numbers: the JSON files here.\n\n## What the numbers say\n",
        triangles(0),
        triangles(1),
        POINTS[0],
        POINTS[1],
    );
    let tables = [
        ("5.1: basic scene, 64 points of the light", 0, POINTS[0], (|m| m.basic) as fn(&Method) -> [f64; 4]),
        ("5.2: basic scene, 100 points of the light", 0, POINTS[1], |m| m.hundred),
        ("5.3: huge scene, 64 points of the light", 1, POINTS[0], |m| m.huge),
    ];
    for (title, scene, points, thesis) in tables {
        text += &times(title, found, methods, (scene, points), thesis);
    }
    text += &correctness(&found[6], methods);
    if only.is_empty() { text + &biased(&found[6]) } else { text }
}

/// Milliseconds of the passes that frames with a moving light have and others have not: what is
/// kept otherwise.
fn dynamic_ms(still: &Value, moving: &Value) -> Option<f64> {
    let passes = |result: &Value| result["cost"]["passes"].as_array().cloned();
    let (still, moving) = (passes(still)?, passes(moving)?);
    let is_kept = |pass: &&Value| still.iter().any(|s| (&s["owner"], &s["pass"]) == (&pass["owner"], &pass["pass"]));
    let parts = moving.iter().filter(|pass| !is_kept(pass)).filter_map(|pass| pass["time_ms"]["median"].as_f64());
    // The sum of none is −0.
    Some(parts.sum::<f64>() + 0.0)
}

fn times(
    title: &str,
    found: &[Value],
    methods: &[&Method],
    (scene, points): (usize, u32),
    thesis: fn(&Method) -> [f64; 4],
) -> String {
    let columns = ["method", "technique", "dynamic part", "700² static", "700² dynamic", "900² static", "900² dynamic"];
    let mut text = format!("\n## {title}\n{}", head(&columns));
    for method in methods {
        // Static and dynamic at either size.
        let own = [0, 2, 1, 3].map(|run: usize| {
            let label = method.label(points)?;
            if !method.brute {
                return frame_ms(result(&found[run], scene, &label)?);
            }
            let size = run.checked_sub(2)?;
            let rest = frame_ms(result(&found[run], scene, "none")?)?;
            let all = frame_ms(result(&found[4 + size], scene, &label)?)?;
            // What is not the technique's own does not multiply.
            Some(rest + (all - rest) * TIMES)
        });
        let thesis = thesis(method);
        let label = method.label(points).filter(|_| !method.brute);
        let part =
            label.and_then(|label| dynamic_ms(result(&found[0], scene, &label)?, result(&found[2], scene, &label)?));
        let mut cells = vec![
            method.name.to_string(),
            method.technique.map_or("–".into(), |technique| format!("`{technique}`")),
            format!("{} ({})", number(part, 1), known(thesis[1] - thesis[0], 0)),
        ];
        cells.extend(own.iter().zip(thesis).map(|(own, thesis)| format!("{} ({})", number(*own, 1), known(thesis, 1))));
        text += &row(cells);
    }
    text
}

/// What the thesis says; a dash of what it does not have.
fn known(value: f64, digits: usize) -> String {
    number(Some(value).filter(|value| value.is_finite()), digits)
}

fn correctness(json: &Value, methods: &[&Method]) -> String {
    let columns = ["method", "technique", "thesis, %", "basic, %", "huge, %", "basic, mae", "huge, mae"];
    let mut text = format!(
        "\n## 5.4: correctness\nPercentage of scored pixels whose visibility is off by at most 0.02 from 1024 rays, 350×350; brute force with \
         {} points. The thesis compares shaded pictures with its own depth-fail volumes of 1,000 and more points.\n\n{}",
        POINTS[0],
        head(&columns)
    );
    for method in methods {
        let label = method.label(POINTS[0]);
        let score = |scene: usize, name: &str| result(json, scene, label.as_deref()?)?["scores"][name].as_f64();
        text += &row([
            method.name.to_string(),
            label.as_ref().map_or("–".into(), |label| format!("`{label}`")),
            known(method.correct, 2),
            number(score(0, "correct_pct"), 2),
            number(score(1, "correct_pct"), 2),
            number(score(0, "mae"), 4),
            number(score(1, "mae"), 4),
        ]);
    }
    text
}

/// What the bias does to maps, and midpoint maps for it.
fn biased(json: &Value) -> String {
    let columns =
        ["technique", "basic: interior, %", "false shadow", "leak", "huge: interior, %", "false shadow", "leak"];
    let mut text = format!("\n## Bias: what midpoint maps do without\n{}", head(&columns));
    for way in BIAS {
        let score = |scene: usize, name: &str| result(json, scene, way)?["scores"][name].as_f64();
        let scores = |scene| {
            let [interior, shadow, leak] = ["interior_pct", "false_shadow", "leak"].map(|name| score(scene, name));
            [number(interior, 2), number(shadow, 4), number(leak, 4)]
        };
        text += &row(std::iter::once(format!("`{way}`")).chain(scores(0)).chain(scores(1)));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn dynamic_light_costs_no_less_than_static() {
        let of_the_thesis = METHODS.iter().filter(|m| m.correct.is_finite());
        assert_eq!(of_the_thesis.clone().count(), 22);
        for Method { name, basic, hundred, huge, correct, .. } in of_the_thesis {
            for [still, moving, still_large, moving_large] in [basic, hundred, huge] {
                assert!(still <= moving && still_large <= moving_large, "{name}");
            }
            assert!((50.0..100.0).contains(correct), "{name}");
        }
    }

    #[test]
    fn times_go_to_their_columns_and_brute_force_is_multiplied() {
        let report = |none: f64| {
            let pass = |name: &str| json!({"owner": "light 0", "pass": name, "time_ms": {"median": none}});
            // Only the light that moves, of the third and fourth report, draws a map.
            let passes = if none > 2.5 { vec![pass("map"), pass("visibility")] } else { vec![pass("visibility")] };
            let of = |id: &str, samples: Value, ms: f64| {
                let cost = json!({"frame_ms": {"median": ms}, "passes": passes});
                json!({"technique": id, "settings": {}, "light_samples": samples, "cost": cost})
            };
            let results = [of("none", Value::Null, none), of("shadow-map", POINTS[1].into(), 10.0)];
            json!({"scenes": [{"lights": [{"results": results}]}]})
        };
        let found = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(report);
        let all: Vec<&Method> = METHODS.iter().collect();
        let text = times("a", &found, &all, (0, POINTS[1]), |m| m.basic);
        assert!(
            text.contains("| no shadow | `none` | 3.0 (0) | 1.0 (0.9) | 3.0 (0.9) | 2.0 (1.4) | 4.0 (1.4) |"),
            "{text}"
        );
        // 3 + 4 × (10 − 3), and 4 + 4 × (10 − 4).
        assert!(
            text.contains("`shadow-map` | – (116) | – (36.2) | 31.0 (152.2) | – (55.4) | 28.0 (171.4) |"),
            "{text}"
        );
    }

    #[test]
    fn without_results_every_table_is_there_with_dashes() {
        let all: Vec<&Method> = METHODS.iter().collect();
        let text = text(&vec![Value::Null; 7], &all, &[]);
        assert_eq!(text.matches("\n## ").count(), 6);
        assert!(text.contains("| smoothies | `smoothies` | – (–) | – (–) | – (–) | – (–) | – (–) |"), "{text}");
        assert_eq!(text.matches("| map, combined /m/ |").count(), 4);
        assert!(
            text.contains("| projective, soft | `projective` | – (0) | – (17.7) | – (17.7) | – (26.1) | – (26.1) |"),
            "{text}"
        );
        assert_eq!(huge().matches("bunny-16301.obj").count(), 7);
    }
}
