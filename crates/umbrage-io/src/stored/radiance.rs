//! Stored radiance under an environment.

use crate::error::{self, Error, Place};
use crate::pictures::{load_mask, load_rgb};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use umbrage_core::Image;

/// The stored picture of one scene with one number of bounces. All are of the same size.
#[derive(Clone, Debug)]
pub struct StoredRadiance {
    /// The scene file.
    pub scene: PathBuf,
    /// What surfaces send to the eye, linear RGB; 0 where it is not scored.
    pub radiance: Image<[f32; 3]>,
    /// True: scored.
    pub mask: Image<bool>,
    /// Mean standard error of a pixel's luminance over the mean luminance.
    pub relative_error: f64,
}

impl StoredRadiance {
    /// Reads the picture with so many `bounces` of the scene called `scene`.
    ///
    /// # Errors
    /// A scene or number that the folder does not hold; files that are damaged or do not fit each
    /// other.
    pub fn open(dir: &Path, scene: &str, bounces: u32) -> Result<Self, Error> {
        let stored = list_radiance(dir)?;
        let Some(numbers) = stored.get(scene) else {
            let error = Error::new(dir, format!("holds no radiance of a scene `{scene}`"));
            return Err(error.did_you_mean(scene, stored.keys().map(String::as_str)));
        };
        if !numbers.contains(&bounces) {
            let what = format!("holds no radiance of the scene `{scene}` with {bounces} bounces");
            return Err(Error::new(dir, what).remedy(format!("it has {numbers:?}")));
        }
        let radiance = load_rgb(&dir.join(format!("{scene}.bounces{bounces}.radiance.exr")))?;
        let mask_file = dir.join(format!("{scene}.mask.png"));
        let mask = load_mask(&mask_file)?;
        if mask.size() != radiance.size() {
            let what = format!("is {:?}, the radiance {:?}", mask.size(), radiance.size());
            return Err(Error::new(mask_file, what));
        }
        let relative_error = relative_error(&dir.join(format!("{scene}.radiance.json")), bounces)?;
        Ok(Self { scene: dir.join(format!("scenes/{scene}.scene.toml")), radiance, mask, relative_error })
    }
}

/// The scenes that a folder holds radiance of, each with its numbers of bounces in order.
///
/// # Errors
/// A folder that cannot be read or holds none.
pub fn list_radiance(dir: &Path) -> Result<BTreeMap<String, Vec<u32>>, Error> {
    let entries = std::fs::read_dir(dir).map_err(|e| {
        Error::new(dir, format!("cannot be read as a folder: {e}")).remedy("name the folder of the references")
    })?;
    let mut stored: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    for name in entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()) {
        let parts = name.strip_suffix(".radiance.exr").and_then(|rest| rest.rsplit_once(".bounces"));
        if let Some((scene, Ok(bounces))) = parts.map(|(scene, bounces)| (scene, bounces.parse())) {
            stored.entry(scene.to_owned()).or_default().push(bounces);
        }
    }
    if stored.is_empty() {
        return Err(Error::new(dir, "holds no NAME.bouncesB.radiance.exr").remedy("name a folder of stored references"));
    }
    stored.values_mut().for_each(|numbers| numbers.sort_unstable());
    Ok(stored)
}

fn relative_error(file: &Path, bounces: u32) -> Result<f64, Error> {
    let json: Value = serde_json::from_slice(&error::read(file)?)
        .map_err(|e| Error::new(file, format!("is damaged or cut off: {e}")))?;
    let pictures = json["pictures"].as_array().map_or(&[][..], Vec::as_slice);
    let picture = pictures.iter().find(|picture| picture["bounces"] == bounces);
    let number = picture.and_then(|picture| picture["standard_error_of_luminance_over_its_mean"].as_f64());
    number.ok_or_else(|| {
        let place = Place::Part(format!("the picture with {bounces} bounces"));
        Error::new(file, "there is no `standard_error_of_luminance_over_its_mean`").at(place)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::{save_exr_rgb, save_png};

    #[test]
    fn what_is_stored_is_found_or_missed_by_name() {
        let dir = tempfile::tempdir().unwrap();
        assert!(list_radiance(dir.path()).unwrap_err().to_string().contains("holds no NAME"));
        save_exr_rgb(&dir.path().join("court.bounces2.radiance.exr"), &Image::filled(2, 1, [0.5; 3])).unwrap();
        save_png(&dir.path().join("court.mask.png"), &Image { width: 2, height: 1, data: vec![255_u8, 0] }).unwrap();
        let json = dir.path().join("court.radiance.json");
        std::fs::write(&json, r#"{"pictures": [{"bounces": 2, "standard_error_of_luminance_over_its_mean": 0.01}]}"#)
            .unwrap();
        let stored = StoredRadiance::open(dir.path(), "court", 2).unwrap();
        assert_eq!((stored.mask.data, stored.relative_error), (vec![true, false], 0.01));
        let error = |scene, bounces| StoredRadiance::open(dir.path(), scene, bounces).unwrap_err().to_string();
        assert!(error("cuort", 2).contains("did you mean `court`?"));
        assert!(error("court", 1).contains("it has [2]"));
        std::fs::write(&json, "{}").unwrap();
        assert!(error("court", 2).contains("standard_error"));
        std::fs::write(&json, "{").unwrap();
        assert!(error("court", 2).contains("damaged"));
    }
}
