//! FE 5.1 to 5.4: one shadow map against parallel splits, with one compare and with a filter of
//! 7×7.

use super::{Run, bunny, file, head, make_scenes, measure, number, result, row};
use crate::bench;
use anyhow::Result;
use serde_json::Value;
use std::fmt::Write;

const SIZE: &str = "1366x768";
const FRAMES: u32 = 10;

/// Triangles of the thesis' scenes. Its dragon's place is taken by a bunny of as many.
const SCENES: [(&str, usize); 3] = [("primitives", 1300), ("bunny", 2947), ("dragon-sized", 47_826)];

/// A table: two ways, and for each scene the thesis' frames a second and what it says of the
/// quality.
struct Table {
    title: &'static str,
    ways: [(&'static str, &'static str); 2],
    thesis: [[(f64, &'static str); 2]; 3],
}

const TABLES: [Table; 4] = [
    Table {
        title: "5.1: one map",
        ways: [("1024²", "shadow-map"), ("2048²", "shadow-map:size=2048")],
        thesis: [
            [(328.3, "medium"), (180.0, "medium to high")],
            [(320.0, "medium"), (161.3, "medium to high")],
            [(75.9, "low"), (71.0, "medium")],
        ],
    },
    Table {
        title: "5.2: three splits, λ = 0.5",
        ways: [
            ("3 × 512²", "cascaded:size=512:splits=3:lambda=0.5:filter=shadow-map"),
            ("3 × 1024²", "cascaded:splits=3:lambda=0.5:filter=shadow-map"),
        ],
        thesis: [
            [(231.0, "low to medium"), (162.7, "high")],
            [(214.3, "medium"), (147.2, "high")],
            [(36.9, "low to medium"), (36.9, "high")],
        ],
    },
    Table {
        title: "5.3: one map, 7×7",
        ways: [("1024²", "pcf:kernel=7"), ("2048²", "pcf:kernel=7:size=2048")],
        thesis: [
            [(68.0, "medium"), (55.0, "medium")],
            [(70.3, "medium"), (61.0, "high")],
            [(42.0, "low"), (38.0, "medium")],
        ],
    },
    Table {
        title: "5.4: three splits, λ = 0.5, 7×7",
        ways: [
            ("3 × 512²", "cascaded:size=512:splits=3:lambda=0.5:kernel=7"),
            ("3 × 1024²", "cascaded:splits=3:lambda=0.5:kernel=7"),
        ],
        thesis: [
            [(55.0, "low"), (53.0, "high")],
            [(65.0, "medium"), (51.2, "high")],
            [(27.5, "medium"), (24.3, "high")],
        ],
    },
];

/// Measures and writes `splits/`.
pub fn run() -> Result<()> {
    let scenes = make_scenes(&[
        ("bunny-2947.obj", bunny(SCENES[1].1)?),
        ("bunny-47826.obj", bunny(SCENES[2].1)?),
        ("fe-primitives.scene.toml", scene(SCENES[0].0, include_str!("fe-primitives.toml"))),
        ("fe-bunny.scene.toml", scene(SCENES[1].0, &model("bunny-2947.obj"))),
        ("fe-dragon-sized.scene.toml", scene(SCENES[2].0, &model("bunny-47826.obj"))),
    ])?;
    let scenes = scenes[2..].join(" ");
    let ways: Vec<&str> = TABLES.iter().flat_map(|table| table.ways.map(|(_, way)| way)).collect();
    let techniques = ways.join(",");
    let runs = [
        Run {
            file: "times.json",
            line: format!(
                "bench {scenes} --techniques {techniques} --moving lights --frames {FRAMES} --size {SIZE} --json"
            ),
        },
        Run {
            file: "quality.json",
            line: format!(
                "compare {scenes} --techniques {techniques} --frames 1 --size {SIZE} --json -o target/tables/fe"
            ),
        },
        Run {
            file: "shaking.json",
            line: format!("bench {scenes} --techniques {techniques} --path strafe --frames 16 --size 683x384 --json"),
        },
    ];
    let (folder, found) = measure("splits", &runs)?;
    file(&folder, &text(&found))
}

fn scene(name: &str, models: &str) -> String {
    format!("name = \"{name}\"\n\n{}{models}", include_str!("fe.head.toml"))
}

fn model(obj: &str) -> String {
    format!("\n[[model]]\npath = \"{obj}\"\nscale = 9.7\nrotate = [0.0, 15.0, 0.0]\ntranslate = [0.15, -0.32, 0.0]\n")
}

/// The reading's frame: the tables, and room for what they say.
fn text(found: &[Value]) -> String {
    let made = &found[0]["made"];
    let mut text =
        bench::heading("One map against parallel splits, tables FE 5.1 to 5.4,", made, "cargo xtask tables fe");
    // Writing to a string does not fail.
    let _ = writeln!(
        text,
        "{SIZE}, parallel light, a model on a ground of 120 m. *fps*: frames a second, from the median of {FRAMES} frames with the light moving, \
         ways in turn; in brackets those of the thesis (GeForce 310M, 2010): only ratios compare. *Quality* is what the thesis says by eye. *mae* \
         and *correct* are set against ray tracing, *texel* is its size on the screen that 95 of 100 pixels don't exceed, *shaking* the flicker \
         along `--path strafe` over that of the truth.\n\nRaw numbers: the JSON files here.\n\n## What the numbers say\n"
    );
    for table in &TABLES {
        let _ = write!(text, "\n## {}\n", table.title);
        text += &head(&[
            "scene",
            "triangles",
            "map",
            "fps",
            "ms",
            "quality",
            "mae",
            "correct, %",
            "texel, pixels",
            "seam",
            "shaking",
        ]);
        for (number, (name, _)) in SCENES.iter().enumerate() {
            for (way, thesis) in table.ways.iter().zip(table.thesis[number]) {
                text += &line(found, number, name, way, thesis);
            }
        }
    }
    text
}

fn line(found: &[Value], scene: usize, name: &str, (map, way): &(&str, &str), (fps, quality): (f64, &str)) -> String {
    let get = |run: usize, path: &[&str]| {
        let result = result(&found[run], scene, way)?;
        path.iter().fold(result, |value, key| &value[*key]).as_f64()
    };
    let frame_ms = get(0, &["cost", "frame_ms", "median"]);
    let triangles = found[0]["scenes"][scene]["triangles"].as_u64();
    row([
        name.to_string(),
        format!("{} ({})", triangles.map_or("–".into(), |n| n.to_string()), SCENES[scene].1),
        map.to_string(),
        format!("{} ({fps})", number(frame_ms.map(|ms| 1e3 / ms), 1)),
        number(frame_ms, 1),
        quality.to_string(),
        number(get(1, &["scores", "mae"]), 4),
        number(get(1, &["scores", "correct_pct"]), 2),
        number(get(1, &["aliasing", "p95"]), 2),
        number(get(1, &["scores", "seam"]), 2),
        number(get(2, &["flicker_ratio"]), 2),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn our_numbers_stand_beside_the_thesis() {
        let result = json!({
            "technique": "shadow-map", "settings": {}, "light_samples": null, "flicker_ratio": 1.5,
            "cost": {"frame_ms": {"median": 20.0}}, "scores": {"mae": 0.01, "correct_pct": 99.0, "seam": null},
            "aliasing": {"p95": 2.5},
        });
        let report = json!({"scenes": [{"triangles": 1280, "lights": [{"results": [result]}]}]});
        let text = text(&vec![report; 3]);
        let wanted =
            "| primitives | 1280 (1300) | 1024² | 50.0 (328.3) | 20.0 | medium | 0.0100 | 99.00 | 2.50 | – | 1.50 |";
        assert!(text.contains(wanted), "{text}");
        assert_eq!(text.matches("| dragon-sized | – (47826) |").count(), 8, "{text}");
    }
}
