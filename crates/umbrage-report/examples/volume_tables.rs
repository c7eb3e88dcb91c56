//! Measures the choices of shadow volumes that PX, ZA and GG quote prices for, and writes them
//! down.
//!
//!     cargo run --release -p umbrage-report --example volume_tables -- FOLDER [FRAMES]
//!
//! FOLDER gets the raw numbers of each arrangement of lights, as `umbrage bench --json` prints
//! them, and a README.md with the tables. Techniques take turns frame by frame, and the lights
//! move.

use std::{error::Error, fs, path::PathBuf};
use umbrage::Gpu;
use umbrage_core::{Light, LightShape, glam::DVec3};
use umbrage_report::{Bench, BenchCost, BenchLight, BenchReport, BenchResult, Choice, Made, Moving, Progress, Source};

const SIZE: (u32, u32) = (1024, 768);
const FRAMES: u32 = 20;

/// Which lights there are; the tables of one arrangement are measured in the same run.
#[derive(Clone, Copy, PartialEq)]
enum Lights {
    /// The scene's first one without extent.
    Own,
    /// A point light with a range.
    Ranged,
    /// Four point lights in the same frame.
    Four,
}

/// Ends the name of a way that is the single-pass algorithm.
const OVERLAY: &str = ", single-pass overlay";

/// Ways of doing the same; the others are set against the first.
struct Table {
    title: &'static str,
    lights: Lights,
    ways: &'static [&'static str],
}

const TABLES: &[Table] = &[
    Table {
        title: "Where silhouettes are found (PX 3.3.3)",
        lights: Lights::Own,
        ways: &["volume", "volume:extrude=vertex", "volume:extrude=cpu"],
    },
    Table {
        title: "From where shadows are counted (ZA 5; GG 9.5.4 is `auto` against `z-fail`)",
        lights: Lights::Own,
        ways: &["volume", "volume:count=auto", "volume:count=z-fail", "volume:count=z-pass", "volume:count=xor"],
    },
    Table {
        title: "Sides of parallel light that extend without end, as triangles and without dark caps (GG 9.5.1)",
        lights: Lights::Own,
        ways: &[
            "volume:reach=infinite",
            "volume:reach=infinite:parallel=quads",
            "volume:count=z-fail:reach=infinite",
            "volume:count=z-fail:reach=infinite:parallel=quads",
        ],
    },
    Table {
        title: "Casters out of the light's reach are left out (GG 9.5.2)",
        lights: Lights::Ranged,
        ways: &["volume:reach=finite:cull=light", "volume:reach=finite:cull=none"],
    },
    Table {
        title: "Casters that shadow nothing in view are left out (GG 9.5.3)",
        lights: Lights::Own,
        ways: &["volume:cull=view", "volume:cull=none"],
    },
    Table {
        title: "Caps out of view are left out (GG 9.5.3)",
        lights: Lights::Own,
        ways: &["volume:count=z-fail:cull=caps", "volume:count=z-fail:cull=none"],
    },
    Table {
        title: "Where shadows end (GG 9.6.1), with nothing left out and with all that can be",
        lights: Lights::Ranged,
        ways: &[
            "volume:reach=finite:cull=none",
            "volume:reach=scene:cull=none",
            "volume:reach=infinite:cull=none",
            "volume:reach=finite",
            "volume:reach=scene",
            "volume:reach=infinite",
        ],
    },
    Table {
        title: "Pixels out of the light's reach are left out by a rectangle (GG 9.6.2)",
        lights: Lights::Ranged,
        ways: &["volume:reach=finite:cull=scissor", "volume:reach=finite:cull=none"],
    },
    Table {
        title: "Pixels out of the light's reach are left out by their depth (GG 9.6.3), alone and with all the rest",
        lights: Lights::Ranged,
        ways: &[
            "volume:reach=finite:cull=none:depth-bounds=on",
            "volume:reach=finite:cull=none",
            "volume:reach=finite:depth-bounds=on",
            "volume:reach=finite",
        ],
    },
    Table {
        title: "What counts: both sides with the stencil at once, one after the other, floats",
        lights: Lights::Own,
        ways: &["volume:counter=stencil", "volume:stencil=two-pass", "volume:counter=float"],
    },
    Table {
        title: "Shadows of one light after the other, or of all lights at once (PX 3.4), without shading",
        lights: Lights::Four,
        ways: &["volume", "volume, single-pass overlay"],
    },
    Table {
        title: "The aims: all by the CPU from infinity takes at least 3 times as long, `z-fail` no less long",
        lights: Lights::Four,
        ways: &["volume", "volume:extrude=cpu:count=z-fail:reach=infinite:cull=none", "volume:count=z-fail"],
    },
];

impl Lights {
    const ALL: [Self; 3] = [Self::Own, Self::Ranged, Self::Four];

    fn file(self) -> &'static str {
        match self {
            Self::Own => "own-light.json",
            Self::Ranged => "light-with-a-range.json",
            Self::Four => "four-lights.json",
        }
    }

    fn sources(self) -> Result<Vec<Source>, Box<dyn Error>> {
        if self == Self::Four {
            let mut atrium = Source::open("atrium")?;
            atrium.scene.lights =
                [(-4.0, -6.0), (4.0, -6.0), (-4.0, 6.0), (4.0, 6.0)].map(|(x, z)| point([x, 3.0, z], None)).into();
            return Ok(vec![atrium]);
        }
        let mut sources = vec![Source::open("atrium")?, Source::open("city")?, Source::open("lantern")?];
        sources.extend(bunny()?);
        for Source { asked, scene, .. } in &mut sources {
            scene.lights.retain(|light| !light.shape.kind().is_soft());
            scene.lights.truncate(1);
            if self == Self::Ranged {
                scene.lights[0] = match asked.as_str() {
                    "atrium" => point([0.0, 4.0, 0.0], Some(8.0)),
                    "city" => point([-4.0, 6.0, 8.0], Some(25.0)),
                    "lantern" => Light { range: Some(2.0), ..scene.lights[0].clone() },
                    _ => Light { range: Some(4.5), ..scene.lights[0].clone() },
                };
            }
        }
        Ok(sources)
    }

    /// Every way of the tables with these lights, once.
    fn choices(self) -> Result<Vec<Choice>, Box<dyn Error>> {
        let mut choices: Vec<Choice> = Vec::new();
        for way in TABLES.iter().filter(|t| t.lights == self).flat_map(|t| t.ways) {
            let choice = Choice::parse(&umbrage::Registry::default(), way.trim_end_matches(OVERLAY), &[])?;
            if choices.iter().all(|c| c.label() != choice.label()) {
                choices.push(choice);
            }
        }
        Ok(choices)
    }
}

fn point(position: [f64; 3], range: Option<f64>) -> Light {
    Light { range, ..Light::new(LightShape::Point { position: DVec3::from(position) }) }
}

/// The Stanford bunny of the optional reference data.
fn bunny() -> Result<Option<Source>, Box<dyn Error>> {
    let shared = std::env::var_os("UMBRAGE_SHARED").map_or_else(|| PathBuf::from("../shared"), PathBuf::from);
    let path = shared.join("references/scenes/bunny.scene.toml");
    if !path.is_file() {
        eprintln!("skipped the bunny: there is no {}; UMBRAGE_SHARED names the folder of the data", path.display());
        return Ok(None);
    }
    Ok(Some(Source { asked: "bunny".into(), ..Source::open(&path.to_string_lossy())? }))
}

fn main() -> Result<(), Box<dyn Error>> {
    let command: Vec<String> = std::env::args().collect();
    let (folder, frames) = match command.as_slice() {
        [_, folder] => (PathBuf::from(folder), FRAMES),
        [_, folder, frames] => (PathBuf::from(folder), frames.parse()?),
        _ => return Err("write volume_tables FOLDER [FRAMES]".into()),
    };
    let readme = folder.join("README.md");
    if readme.exists() {
        return Err(format!("{} is there already; choose another folder", readme.display()).into());
    }
    fs::create_dir_all(&folder)?;
    let gpu = Gpu::request(None)?;
    let mut reports = Vec::new();
    for lights in Lights::ALL {
        let numbered = |source: Source| {
            let numbers = (0..source.scene.lights.len()).collect();
            (source, numbers)
        };
        let plan = Bench {
            scenes: lights.sources()?.into_iter().map(numbered).collect(),
            choices: lights.choices()?,
            size: SIZE,
            frames,
            moving: Moving::Lights,
            path: None,
            samples: 1,
            together: lights == Lights::Four,
            overlay: lights == Lights::Four,
            bytes: false,
            churn: 0,
            bake_cache: None,
            command: command.clone(),
        };
        let report = plan.run(&gpu, &Lines)?;
        fs::write(folder.join(lights.file()), report.json())?;
        reports.push((lights, report));
    }
    let command =
        format!("cargo run --release -p umbrage-report --example volume_tables -- {}", command[1..].join(" "));
    let mut text = reports.first().map(|(_, r)| heading(&r.made, &command, frames)).unwrap_or_default();
    for table in TABLES {
        for (_, report) in reports.iter().filter(|(lights, _)| *lights == table.lights) {
            text += &rows(table, report)?;
        }
    }
    fs::write(&readme, text)?;
    println!("wrote {}", readme.display());
    Ok(())
}

/// Says what is under way, a line a scene.
struct Lines;

impl Progress for Lines {
    fn begin(&self, what: &str, _: u64) {
        eprintln!("{what}");
    }
    fn at(&self, _: u64) {}
    fn end(&self) {}
}

fn heading(made: &Made, command: &str, frames: u32) -> String {
    let (machine, adapter) = (&made.machine, &made.adapter);
    let (day, commit) = (made.date.get(..10).unwrap_or_default(), made.commit.unwrap_or("unknown"));
    format!(
        "# Shadow volumes, {day}\n\n| | |\n|---|---|\n\
         | machine | {}, {} cores, {} |\n\
         | adapter | {} ({}, {}) |\n\
         | driver | {} |\n\
         | commit | {commit} |\n\
         | command | `{command}` |\n\n\
         Milliseconds of the GPU + of the CPU (lights × that of one), medians of {frames} frames at {}×{}, lights moving, ways in turn.\n\
         ×: both together, over those of the first row. Raw numbers, with counts of casters and edges, are in {}.\n",
        machine.cpu,
        machine.cores,
        machine.os,
        adapter.name,
        adapter.backend,
        adapter.kind,
        adapter.driver,
        SIZE.0,
        SIZE.1,
        Lights::ALL.map(|lights| format!("`{}`", lights.file())).join(", "),
    )
}

/// A table in Markdown: a row a way, a column a scene.
fn rows(table: &Table, report: &BenchReport) -> Result<String, Box<dyn Error>> {
    let columns: Vec<(&str, &BenchLight)> =
        report.scenes.iter().flat_map(|s| s.lights.iter().map(|l| (s.source.as_str(), l))).collect();
    let mut text = format!("\n## {}\n| |", table.title);
    for (scene, light) in &columns {
        text += &match &light.together {
            Some(lights) => format!(" {scene}, {} lights |", lights.len()),
            None => format!(" {scene}, {} light |", light.kind),
        };
    }
    text += &format!("\n|---|{}\n", "---|".repeat(columns.len()));
    for way in table.ways {
        text += &format!("| `{way}` |");
        for (_, light) in &columns {
            text += &format!(" {} |", cell(light, way, table.ways[0])?);
        }
        text += "\n";
    }
    Ok(text)
}

/// What a way costs, and how many times as much as the first one of its table; or why it was not
/// measured.
fn cell(light: &BenchLight, way: &str, first: &str) -> Result<String, Box<dyn Error>> {
    let (this, first) = (result(light, way)?, result(light, first)?);
    let Some(cost) = &this.cost else { return Ok(this.reason.clone().unwrap_or_default()) };
    let lights = light.together.as_ref().map_or(1, Vec::len);
    let prepare_ms = cost.prepare_ms.median / lights as f64;
    let times = if lights == 1 { String::new() } else { format!("{lights} × ") };
    let gpu = cost.gpu_ms.map_or("–".into(), |gpu_ms| format!("{:.2}", gpu_ms.median));
    let ratio =
        cost.added_ms().zip(first.cost.as_ref().and_then(BenchCost::added_ms)).map(|(this, first)| this / first);
    let ratio = ratio.map_or(String::new(), |ratio| format!(", × {ratio:.2}"));
    Ok(format!("{gpu} + {times}{prepare_ms:.2}{ratio}"))
}

fn result<'a>(light: &'a BenchLight, way: &str) -> Result<&'a BenchResult, Box<dyn Error>> {
    // The single-pass algorithm is no setting; the benchmark says so in its results.
    let (way, overlay) = way.strip_suffix(OVERLAY).map_or((way, false), |way| (way, true));
    let choice = Choice::parse(&umbrage::Registry::default(), way, &[])?;
    let mut settings = choice.changed().clone();
    settings.extend(overlay.then(|| ("overlay".into(), "on".into())));
    let found = light.results.iter().find(|r| r.technique == choice.info.id && r.settings == settings);
    Ok(found.ok_or_else(|| format!("`{way}` was not measured"))?)
}
