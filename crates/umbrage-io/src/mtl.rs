//! MTL, the material libraries of OBJ files.
//!
//! Kd → base colour; luminance of Ks → specular; Ns → shininess; Ke → emissive; map_Kd → texture.
//! map_d, or a map_Kd with transparent pixels, is an alpha mask at one half; -s, -o and -clamp are
//! read. A plain `d` or `Tr`
//! below 1 is noted: shadows are those of the opaque surface. (Source: Wavefront, "MTL material
//! format", version 4.2.)

use crate::error::{self, Error, Place, shown};
use crate::files::Files;
use crate::limits::{Budget, MOST_PIXELS_IN_ALL};
use crate::lines::{self, Line};
use crate::{pictures, text};
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use umbrage_core::{Material, Sampling, Texture, Wrap};

/// The alpha below which a masked surface is absent.
const ALPHA_CUTOFF: f32 = 0.5;

/// Larger numbers of options are slips: texture coordinates have to stay finite.
const LARGEST_OPTION: f32 = 1e6;

/// The materials of one or several libraries, with their pictures.
#[derive(Debug)]
pub(crate) struct Library {
    pub materials: Vec<Material>,
    /// How each of them looks up its picture.
    pub lookups: Vec<Lookup>,
    pub textures: Vec<Texture>,
    /// Index into `materials` by name.
    pub by_name: HashMap<String, usize>,
    pub notes: Vec<String>,
    /// Index into `textures` by base-colour and mask file, and whether they are clamped.
    texture_by_files: HashMap<([Option<PathBuf>; 2], bool), Option<usize>>,
    pixels: Budget,
}

impl Default for Library {
    fn default() -> Self {
        Self {
            materials: Vec::new(),
            lookups: Vec::new(),
            textures: Vec::new(),
            by_name: HashMap::new(),
            notes: Vec::new(),
            texture_by_files: HashMap::new(),
            pixels: Budget::new(MOST_PIXELS_IN_ALL),
        }
    }
}

/// A material as written, before its pictures are read.
#[derive(Default)]
struct Entry {
    name: String,
    line: usize,
    diffuse: Option<Vec3>,
    specular: f32,
    shininess: Option<f32>,
    emissive: Vec3,
    opacity: Option<f32>,
    diffuse_map: Option<Map>,
    opacity_map: Option<Map>,
}

/// A picture and how surfaces look it up.
#[derive(Clone)]
struct Map {
    file: PathBuf,
    lookup: Lookup,
    is_clamped: bool,
}

/// Texture coordinates of vertices as a map takes them: scaled by `-s`, then moved by `-o`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lookup {
    scale: Vec2,
    offset: Vec2,
}

impl Default for Lookup {
    fn default() -> Self {
        Self { scale: Vec2::ONE, offset: Vec2::ZERO }
    }
}

impl Lookup {
    /// Where a vertex looks up the picture; v of the file points up, here it points down.
    pub fn place(&self, uv: Vec2) -> Vec2 {
        let up = Vec2::new(uv.x, 1.0 - uv.y) * self.scale + self.offset;
        if *self == Self::default() { uv } else { Vec2::new(up.x, 1.0 - up.y) }
    }
}

impl Library {
    /// Adds the materials of a file, whose bytes these are; its pictures are among `files`.
    pub fn read(&mut self, files: Files<'_>, file: &Path, bytes: Vec<u8>) -> Result<(), Error> {
        let text = text::decode_old(file, bytes)?;
        let dir = file.parent().unwrap_or(Path::new(""));
        let mut entries: Vec<Entry> = Vec::new();
        lines::for_each(file, &text, |line| {
            if line.keyword == "newmtl" {
                entries.push(Entry { name: line.rest.to_owned(), line: line.number, ..Entry::default() });
                return Ok(());
            }
            match entries.last_mut() {
                Some(entry) => read_line(entry, &line, dir, &mut self.notes),
                None => Ok(()),
            }
        })?;
        for entry in entries {
            let material = self.material(files, &entry).map_err(|e| {
                let what = format!("material `{}` names", error::line(&entry.name));
                Error::new(file, what).at(Place::Line(entry.line, None)).passing_on(&e)
            })?;
            let lookup = self.lookup(&entry);
            self.lookups.push(lookup);
            self.by_name.insert(entry.name, self.materials.len());
            self.materials.push(material);
        }
        Ok(())
    }

    fn material(&mut self, files: Files<'_>, entry: &Entry) -> Result<Material, Error> {
        let texture = self.texture(files, entry)?;
        let default = Material::default();
        let plain = if texture.is_some() { Vec3::ONE } else { default.base_color.truncate() };
        let masked = texture.is_some_and(|t| self.textures[t].rgba.iter().any(|p| p[3] < 255));
        if let Some(opacity) = entry.opacity.filter(|o| *o < 1.0 && !masked) {
            self.notes.push(format!(
                "material `{}` is {:.0} % opaque: its shadow is that of an opaque surface",
                error::line(&entry.name),
                opacity * 100.0
            ));
        }
        Ok(Material {
            base_color: entry.diffuse.unwrap_or(plain).extend(1.0),
            texture,
            specular: entry.specular,
            shininess: entry.shininess.unwrap_or(default.shininess),
            emissive: entry.emissive,
            alpha_cutoff: masked.then_some(ALPHA_CUTOFF),
        })
    }

    /// How a material looks up its pictures; one way for both.
    fn lookup(&mut self, entry: &Entry) -> Lookup {
        let maps: Vec<&Map> = entry.opacity_map.iter().chain(&entry.diffuse_map).collect();
        if let [mask, color] = maps[..]
            && mask.lookup != color.lookup
        {
            let name = error::line(&entry.name);
            self.notes.push(format!("material `{name}`: `map_Kd` is looked up as `map_d` is, with its -s and -o"));
        }
        maps.first().map(|map| map.lookup).unwrap_or_default()
    }

    /// The picture of a material, with the mask of map_d as its alpha.
    fn texture(&mut self, files: Files<'_>, entry: &Entry) -> Result<Option<usize>, Error> {
        let maps = [&entry.diffuse_map, &entry.opacity_map];
        let is_clamped = maps.into_iter().flatten().any(|map| map.is_clamped);
        let named = maps.map(|map| map.as_ref().map(|map| map.file.clone()));
        let key = (named, is_clamped);
        if let Some(&known) = self.texture_by_files.get(&key) {
            return Ok(known);
        }
        let [color, mask] = &key.0;
        let color = self.load(files, entry, color.as_deref(), "its colour and holes are left out")?;
        let mask = self.load(files, entry, mask.as_deref(), "it has no holes")?;
        let texture = match (color, mask) {
            (color, None) => color,
            (None, Some(mask)) => {
                let white = Texture { rgba: vec![[255; 4]; mask.rgba.len()], ..mask.clone() };
                Some(with_mask(white, &mask))
            }
            (Some(color), Some(mask)) => Some(with_mask(color, &mask)),
        };
        let wrap = if is_clamped { Wrap::Clamp } else { Wrap::Repeat };
        let index = texture.map(|texture| {
            self.textures.push(Texture { sampling: Sampling { wrap: [wrap; 2], ..Sampling::default() }, ..texture });
            self.textures.len() - 1
        });
        self.texture_by_files.insert(key, index);
        Ok(index)
    }

    /// Reads a picture; a missing one is noted, with what follows from it.
    fn load(
        &mut self,
        files: Files<'_>,
        entry: &Entry,
        path: Option<&Path>,
        otherwise: &str,
    ) -> Result<Option<Texture>, Error> {
        let Some(path) = path else { return Ok(None) };
        if files.is_missing(path) {
            let (name, path) = (error::line(&entry.name), shown(path));
            self.notes.push(format!("material `{name}`: the picture `{path}` is missing: {otherwise}"));
            return Ok(None);
        }
        pictures::load_within(files, path, &mut self.pixels).map(Some)
    }
}

fn read_line(entry: &mut Entry, line: &Line<'_>, dir: &Path, notes: &mut Vec<String>) -> Result<(), Error> {
    let color = || line.numbers().map(|c| Vec3::from(c).max(Vec3::ZERO));
    let share = || line.numbers().map(|[d]| d.clamp(0.0, 1.0));
    match line.keyword {
        "Kd" => entry.diffuse = Some(color()?),
        "Ks" => entry.specular = color()?.dot(Vec3::new(0.2126, 0.7152, 0.0722)),
        "Ke" => entry.emissive = color()?,
        // Exponents of 0 are common for surfaces without a highlight; the lighting model wants them
        // over 0.
        "Ns" => entry.shininess = Some(line.numbers().map(|[n]| n.max(1.0))?),
        // `d -halo factor` depends on the angle of sight; its factor is not an opacity.
        "d" if !line.rest.starts_with('-') => entry.opacity = Some(share()?),
        "Tr" => entry.opacity = Some(1.0 - share()?),
        "map_Kd" => entry.diffuse_map = Some(map_file(line, dir, notes)?),
        "map_d" => entry.opacity_map = Some(map_file(line, dir, notes)?),
        _ => {}
    }
    Ok(())
}

/// A map: its options, and the file, which is what is left of the line after them.
fn map_file(line: &Line<'_>, dir: &Path, notes: &mut Vec<String>) -> Result<Map, Error> {
    let mut map = Map { file: PathBuf::new(), lookup: Lookup::default(), is_clamped: false };
    let mut rest = line.rest;
    let next = |rest: &mut &str| {
        let (word, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        let word = word.to_owned();
        *rest = after.trim_start();
        word
    };
    while rest.starts_with('-') {
        let option = next(&mut rest);
        let (fixed, numbers) = match option.as_str() {
            "-mm" => (2, 0),
            // Two of their three numbers may be left out.
            "-o" | "-s" | "-t" => (1, 2),
            _ => (1, 0),
        };
        let mut words: Vec<String> = (0..fixed).map(|_| next(&mut rest)).collect();
        for _ in 0..numbers {
            if rest.split_whitespace().next().is_some_and(|w| w.parse::<f32>().is_ok()) {
                words.push(next(&mut rest));
            }
        }
        if map.take_option(&option, &words) {
            continue;
        }
        notes.push(format!("{}:{}: `{}` was left out", shown(line.file), line.number, error::line(&option)));
    }
    if rest.is_empty() {
        return Err(line.error(format!("`{}` names no file", line.keyword)).remedy("name one, or remove the line"));
    }
    map.file = dir.join(rest.replace('\\', "/"));
    Ok(map)
}

impl Map {
    /// Takes an option that changes where a surface looks up the picture; false for others.
    fn take_option(&mut self, option: &str, words: &[String]) -> bool {
        let number = |i: usize, default: f32| {
            let number = words.get(i).and_then(|w| w.parse::<f32>().ok());
            number.filter(|n| n.is_finite() && n.abs() <= LARGEST_OPTION).unwrap_or(default)
        };
        match option {
            "-s" => self.lookup.scale = Vec2::new(number(0, 1.0), number(1, 1.0)),
            "-o" => self.lookup.offset = Vec2::new(number(0, 0.0), number(1, 0.0)),
            "-clamp" => self.is_clamped = words.first().is_some_and(|w| w == "on"),
            _ => return false,
        }
        true
    }
}

/// `color` with the alpha of `mask`, or with its brightness where the mask is opaque all over.
fn with_mask(mut color: Texture, mask: &Texture) -> Texture {
    let has_alpha = mask.rgba.iter().any(|p| p[3] < 255);
    let value = |x: u32, y: u32| {
        // The mask may be of another size: its nearest pixel.
        let scaled = |i: u32, from: u32, to: u32| (u64::from(i) * u64::from(to) / u64::from(from)) as usize;
        let (i, j) = (scaled(x, color.width, mask.width), scaled(y, color.height, mask.height));
        let [r, g, b, a] = mask.rgba[j * mask.width as usize + i];
        let brightness = (u32::from(r) + u32::from(g) + u32::from(b)) / 3;
        if has_alpha { a } else { brightness as u8 }
    };
    let alpha: Vec<u8> = (0..color.height).flat_map(|y| (0..color.width).map(move |x| value(x, y))).collect();
    for (pixel, alpha) in color.rgba.iter_mut().zip(alpha) {
        pixel[3] = alpha;
    }
    color
}
