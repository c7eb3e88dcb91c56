//! PX 4.5: wedges one by one and loop by loop against all of a light's in one draw, and how far
//! that goes.

use super::{Run, file, head, make_scenes, measure, number, result, row};
use crate::bench;
use anyhow::Result;
use serde_json::Value;
use std::fmt::Write;

const FRAMES: u32 = 5;

/// Wedges of the thesis' scenes.
const SMALL: [usize; 4] = [4, 64, 538, 756];

/// Wedges of ours beyond.
const LARGE: [usize; 3] = [5_000, 20_000, 100_000];

const SIZES: [&str; 2] = ["640x480", "1024x768"];

/// One wedge after the other, one loop after the other, and all at once.
const WAYS: [&str; 3] = ["wedges:batch=per-wedge", "wedges:batch=per-loop", "wedges"];

/// Frames a second of the thesis by size, scene and way: one by one and by loop, on 900 MHz and on
/// 3 GHz.
const THESIS: [[[f64; 4]; 4]; 2] = [
    [[175.0, 168.0, 190.0, 179.0], [82.0, 103.5, 136.5, 108.0], [13.0, 21.5, 35.0, 22.0], [8.5, 16.0, 22.5, 16.5]],
    [[71.0, 68.0, 78.0, 73.0], [55.0, 42.0, 59.5, 44.0], [13.0, 9.0, 19.0, 8.5], [8.5, 6.5, 15.0, 6.5]],
];

/// Measures and writes `loops/`.
pub fn run() -> Result<()> {
    let mut files: Vec<(String, String)> = Vec::new();
    let small = SMALL.map(|wedges| (format!("px-{wedges}.scene.toml"), scene(wedges, &models(wedges))));
    files.extend(LARGE.map(|wedges| (format!("plates-{wedges}.obj"), plates(wedges / 4))));
    let large = LARGE.map(|wedges| {
        let model = format!("\n[[model]]\npath = \"plates-{wedges}.obj\"\n");
        (format!("px-{wedges}.scene.toml"), scene(wedges, &model))
    });
    files.extend(small.into_iter().chain(large));
    let files: Vec<(&str, String)> = files.iter().map(|(name, text)| (name.as_str(), text.clone())).collect();
    let scenes = make_scenes(&files)?;
    let (small, large) = scenes[LARGE.len()..].split_at(SMALL.len());
    let line = |scenes: &[String], techniques: &str, size: &str| {
        format!("bench {} --techniques {techniques} --frames {FRAMES} --size {size} --json", scenes.join(" "))
    };
    let runs = [
        Run { file: "small.json", line: line(small, &WAYS.join(","), SIZES[0]) },
        Run { file: "medium.json", line: line(small, &WAYS.join(","), SIZES[1]) },
        Run { file: "beyond.json", line: line(large, "wedges,volume", SIZES[1]) },
    ];
    let (folder, found) = measure("loops", &runs)?;
    file(&folder, &text(&found))
}

fn scene(wedges: usize, models: &str) -> String {
    format!("name = \"{wedges} wedges\"\n\n{}{models}", include_str!("px.head.toml"))
}

/// Where plates are and how large they are: over a square of 8 m, as far above the ground as they
/// are apart.
fn places(count: usize) -> impl Iterator<Item = ([f64; 3], f64)> {
    let columns = (count as f64).sqrt().ceil() as usize;
    let apart = 8.0 / columns as f64;
    let at = move |i: usize| (i as f64 + 0.5) * apart - 4.0;
    (0..count).map(move |i| ([at(i % columns), (0.8 * apart).min(1.5), at(i / columns)], 0.5 * apart))
}

/// Plates of four edges each, and a box of six for what does not divide by four.
fn models(wedges: usize) -> String {
    let is_box = |i: usize| i == 0 && !wedges.is_multiple_of(4);
    let count = if wedges.is_multiple_of(4) { wedges / 4 } else { (wedges - 6) / 4 + 1 };
    let mut text = String::new();
    for (i, ([x, y, z], size)) in places(count).enumerate() {
        let shape = match is_box(i) {
            true => format!("primitive = \"box\"\nsize = [{size}, {size}, {size}]"),
            false => format!("primitive = \"plane\"\nsize = [{size}, {size}]"),
        };
        // Writing to a string does not fail.
        let _ = write!(text, "\n[[model]]\n{shape}\ntranslate = [{x}, {y}, {z}]\n");
    }
    text
}

/// Plates as one mesh, in OBJ.
fn plates(count: usize) -> String {
    let mut text = String::new();
    for (i, ([x, y, z], size)) in places(count).enumerate() {
        for (right, front) in [(-0.5, 0.5), (0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] {
            let _ = writeln!(text, "v {} {y} {}", x + right * size, z + front * size);
        }
        let first = 4 * i + 1;
        let _ = writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
    }
    text
}

/// The reading's frame: the tables, and room for what they say.
fn text(found: &[Value]) -> String {
    let made = &found[0]["made"];
    let mut text =
        bench::heading("Wedges one by one, by loop and all at once, table PX 4.5,", made, "cargo xtask tables px");
    // Writing to a string does not fail.
    let _ = writeln!(
        text,
        "Plates over a ground under one sphere light, a box for two wedges of the second but last of the thesis' scenes; medians of {FRAMES} frames. \
         *GPU* is the light's own passes, *frame* all of it from start to finished picture, *CPU* what choosing casters and uploading takes; \
         in brackets the thesis' frames a second on a Radeon 9700 Pro beside 900 MHz and 3 GHz (2003): only ratios compare.\n\n\
         Raw numbers: the JSON files here.\n\n## What the numbers say"
    );
    for (run, size) in SIZES.iter().enumerate() {
        let _ = write!(text, "\n## {size}\n\n");
        text += &head(&["wedges", "way", "draws", "GPU, ms", "CPU, ms", "frame, ms", "over `all`", "thesis, fps"]);
        for (number, wedges) in SMALL.iter().enumerate() {
            for (way, name) in WAYS.iter().enumerate() {
                let thesis = THESIS[run][number];
                let thesis = if way < 2 { format!("{}, {}", thesis[way], thesis[way + 2]) } else { "–".into() };
                text += &line(&found[run], number, *wedges, name, &thesis);
            }
        }
    }
    let _ = write!(text, "\n## Beyond, {}\n\n", SIZES[1]);
    text += &head(&["wedges", "way", "draws", "GPU, ms", "CPU, ms", "frame, ms", "over `all`", "thesis, fps"]);
    for (number, wedges) in LARGE.iter().enumerate() {
        for name in ["wedges", "volume"] {
            text += &line(&found[2], number, *wedges, name, "–");
        }
    }
    text
}

fn line(found: &Value, scene: usize, wedges: usize, way: &str, thesis: &str) -> String {
    let get = |way: &str, path: &[&str]| {
        let result = result(found, scene, way)?;
        path.iter().fold(result, |value, key| &value[*key]).as_f64()
    };
    let gpu_ms = |way| get(way, &["cost", "gpu_ms", "median"]);
    let ratio = gpu_ms(way).zip(gpu_ms("wedges")).map(|(ms, all)| ms / all);
    let name = way.strip_prefix("wedges:batch=").unwrap_or(if way == "wedges" { "all" } else { way });
    row([
        wedges.to_string(),
        name.to_string(),
        number(get(way, &["cost", "draws"]), 0),
        number(gpu_ms(way), 1),
        number(get(way, &["cost", "prepare_ms", "median"]), 2),
        number(get(way, &["cost", "frame_ms", "median"]), 1),
        number(ratio, 2),
        thesis.to_string(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn scenes_have_as_many_wedges_as_they_say() {
        for wedges in SMALL {
            let text = models(wedges);
            let edges = 4 * text.matches("\"plane\"").count() + 6 * text.matches("\"box\"").count();
            assert_eq!(edges, wedges);
        }
        assert_eq!(plates(1250).matches("\nf ").count(), 1250);
    }

    #[test]
    fn our_numbers_stand_beside_the_thesis() {
        let of = |settings: Value, ms: f64| {
            let cost = json!({"gpu_ms": {"median": ms}, "prepare_ms": {"median": 0.5}, "frame_ms": {"median": 20.0}, "draws": 9});
            json!({"technique": "wedges", "settings": settings, "light_samples": null, "cost": cost})
        };
        let results = [of(json!({"batch": "per-wedge"}), 30.0), of(json!({}), 10.0)];
        let text = text(&vec![json!({"scenes": [{"lights": [{"results": results}]}]}); 3]);
        assert!(text.contains("| 4 | per-wedge | 9 | 30.0 | 0.50 | 20.0 | 3.00 | 175, 190 |"), "{text}");
        assert!(text.contains("| 100000 | volume | – | – | – | – | – | – |"), "{text}");
    }
}
