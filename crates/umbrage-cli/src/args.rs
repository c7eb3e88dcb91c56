//! Arguments that several subcommands take, and how they are read.

use crate::say;
use anyhow::Result;
use clap::Args;
use std::path::PathBuf;
use umbrage::{Answer, Gpu, Registry};
use umbrage_report::{CameraPath, Choice, Folder, Moving, Source};

/// Which adapter to use.
#[derive(Args)]
pub struct Adapter {
    /// Graphics adapter: a part of its name, `software`, or its number in `umbrage list`
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

impl Adapter {
    /// The device to work with.
    pub fn gpu(&self) -> Result<Gpu> {
        Ok(Gpu::request(self.adapter.as_deref())?)
    }
}

/// What of a scene is not as it is stored.
#[derive(Args)]
pub struct Changed {
    /// Another camera and other lights than the scene's, as the laboratory copies them: tables
    /// `camera = { … }` and `light = [{ number = 0, … }]` in the words of the scene format
    #[arg(long, value_name = "TOML")]
    change: Option<String>,
    /// Moves every animation on by so many seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    time: f64,
}

impl Changed {
    /// Opens a scene with what is changed in it.
    pub fn open(&self, asked: &str) -> Result<Source> {
        Ok(Source::open(asked)?.changed(self.change.as_deref(), self.time)?)
    }
}

/// A frame of what moves in a scene.
#[derive(Args)]
pub struct Moved {
    /// What moves, as in `umbrage bench`: lights, casters, camera, all
    #[arg(long, value_name = "WHAT", default_value = "none", hide_default_value = true)]
    moving: Moving,
    /// The camera's way, as in `umbrage bench`: walk, strafe, turn, fly
    #[arg(long, value_name = "NAME")]
    path: Option<CameraPath>,
    /// The frame of what moves, and of the camera's way, that is shown
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
}

impl Moved {
    /// The scene in that frame.
    pub fn of(&self, source: Source, size: Size) -> Source {
        source.moved(self.moving, self.path, self.frame, size.height)
    }
}

/// What several techniques are run on.
#[derive(Args)]
pub struct What {
    /// Built-in scenes or files
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Techniques with settings, `id` or `id:name=value`, separated by commas; `all` is every one
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "all")]
    techniques: Vec<String>,
    /// Parameter of a technique wherever it is in the list
    #[arg(long, value_name = "TECHNIQUE.NAME=VALUE", value_parser = triple)]
    set: Vec<(String, String, String)>,
    /// Average every hard technique of the list over so many points of the light
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    light_samples: Option<u32>,
    /// Only this light of each scene, from 0 [default: all]
    #[arg(long, value_name = "N")]
    light: Option<usize>,
    /// Folder where baked transfer is kept and found again, by what determines it
    #[arg(long, value_name = "DIR")]
    bake_cache: Option<PathBuf>,
    #[command(flatten)]
    changed: Changed,
}

impl What {
    /// Where baked transfer is kept.
    pub fn bake_cache(&self) -> Result<Option<PathBuf>> {
        kept_in(self.bake_cache.clone())
    }

    /// The techniques with their settings.
    pub fn choices(&self, registry: &Registry) -> Result<Vec<Choice>> {
        let choices = Choice::list(registry, &self.techniques, &self.set)?;
        choices.iter().for_each(print_note);
        Ok(choices.into_iter().map(|c| c.or_light_samples(self.light_samples)).collect())
    }

    /// The scenes, each with the lights to work on, those that the choices have an answer for; what
    /// the loader has to say goes to the standard error.
    pub fn scenes(&self, choices: &[Choice]) -> Result<Vec<(Source, Vec<usize>)>> {
        let mut answers: Vec<Answer> = choices.iter().map(|choice| choice.info.answer()).collect();
        answers.sort_by_key(|answer| answer.name());
        answers.dedup();
        let mut scenes = Vec::new();
        for name in &self.scenes {
            let source = self.changed.open(name)?;
            let lights = source.lights(self.light, &answers)?;
            source.notes.iter().for_each(|note| say::note(&format!("{name}: {note}")));
            scenes.push((source, lights));
        }
        Ok(scenes)
    }
}

/// Says what its user should know of a choice.
pub fn print_note(choice: &Choice) {
    choice.note.iter().for_each(|note| say::note(note));
}

/// A folder to keep things in that can be written to.
pub fn kept_in(folder: Option<PathBuf>) -> Result<Option<PathBuf>> {
    if let Some(folder) = &folder {
        Folder::check(folder)?;
    }
    Ok(folder)
}

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

/// Reads `WxH`. Whether the adapter allows it is its own affair, except that nobody allows 0.
pub fn size(text: &str) -> Result<Size, String> {
    let number = |t: &str| t.trim().parse::<u32>().ok();
    let (width, height) = text
        .split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some((number(w)?, number(h)?)))
        .ok_or("write WIDTHxHEIGHT, such as 640x480")?;
    if width == 0 || height == 0 {
        return Err("a picture has at least 1 pixel and at most what the adapter allows, 16384 on most".into());
    }
    Ok(Size { width, height })
}

/// Reads `name=value`.
pub fn pair(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE, such as size=1024")?;
    Ok((name.trim().into(), value.trim().into()))
}

/// Reads `technique.name=value`.
pub fn triple(text: &str) -> Result<(String, String, String), String> {
    const FORM: &str = "write TECHNIQUE.NAME=VALUE, such as shadow-map.size=1024";
    let (name, value) = pair(text).map_err(|_| FORM)?;
    let (technique, name) = name.split_once('.').ok_or(FORM)?;
    Ok((technique.into(), name.into(), value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_or_refused() {
        assert_eq!(size("640x480"), Ok(Size { width: 640, height: 480 }));
        for wrong in ["640", "x", "-1x2", "1.5x2", "", "99999999999x1"] {
            assert!(size(wrong).unwrap_err().contains("WIDTHxHEIGHT"), "{wrong}");
        }
        assert!(size("0x480").unwrap_err().contains("16384"));
    }

    #[test]
    fn settings_are_read_or_refused() {
        assert_eq!(pair("size = 512"), Ok(("size".into(), "512".into())));
        assert!(pair("size").is_err());
        assert_eq!(triple("pcf.kernel=7"), Ok(("pcf".into(), "kernel".into(), "7".into())));
        assert!(triple("kernel=7").is_err() && triple("pcf.kernel").is_err());
    }
}
