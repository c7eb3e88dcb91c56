//! Ground truth that other software has traced and stored in a folder.
//!
//! A scene NAME is `scenes/NAME.scene.toml`, `NAME.geometry.npz` (what the camera sees), and for
//! its K-th light `NAME.lightK.visibility.png` (16-bit grey, linear) and `NAME.lightK.mask.png`
//! (white: scored). For its environment and B bounces it is `NAME.bouncesB.radiance.exr` with
//! `NAME.mask.png` and `NAME.radiance.json`.

mod radiance;

pub use radiance::{StoredRadiance, list_radiance};

use crate::error::Error;
use crate::npz::Arrays;
use crate::pictures::{load_grey, load_mask};
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use umbrage_core::Image;

/// The stored pictures of one light of one scene. All are of the same size.
#[derive(Clone, Debug)]
pub struct StoredReference {
    /// The scene file.
    pub scene: PathBuf,
    /// Visibility, 0…1; 0 where it is not scored.
    pub visibility: Image<f32>,
    /// True: scored.
    pub mask: Image<bool>,
    /// Along the view direction, metres from the eye; 0 where nothing is seen.
    pub depth: Image<f32>,
    /// Geometric normal of the triangle seen, turned to the camera; unit length, or zero where
    /// nothing is seen.
    pub normal: Image<[f32; 3]>,
    /// Index of the `[[model]]` seen; −1 where nothing is.
    pub model: Image<i16>,
    /// The camera that saw it.
    pub camera: StoredCamera,
}

/// The camera of stored pictures. The point that pixel (i, j) of w × h shows is `eye + depth *
/// (forward + x * right + y * up)` with `x = (2 (i + 0.5) / w − 1) * tan_half_fov_y * w / h` and
/// `y = (1 − 2 (j + 0.5) / h) * tan_half_fov_y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredCamera {
    /// Where rays start, metres.
    pub eye: DVec3,
    /// Unit vector along the view.
    pub forward: DVec3,
    /// Unit vector to the right.
    pub right: DVec3,
    /// Unit vector up.
    pub up: DVec3,
    /// Tangent of half the full vertical angle of view.
    pub tan_half_fov_y: f64,
}

impl StoredReference {
    /// Reads the pictures of the `light`-th light (from 0) of the scene called `scene`.
    ///
    /// # Errors
    /// A scene or light that the folder does not hold; files that are damaged or do not fit each
    /// other.
    pub fn open(dir: &Path, scene: &str, light: usize) -> Result<Self, Error> {
        let stored = list(dir)?;
        let Some(lights) = stored.get(scene) else {
            let error = Error::new(dir, format!("holds no reference of a scene `{scene}`"));
            return Err(error.did_you_mean(scene, stored.keys().map(String::as_str)));
        };
        if !lights.contains(&light) {
            let what = format!("holds no reference of light {light} of the scene `{scene}`");
            return Err(Error::new(dir, what).remedy(format!("it has lights {lights:?}")));
        }
        let picture = |what: &str| dir.join(format!("{scene}.light{light}.{what}.png"));
        let visibility = load_grey(&picture("visibility"))?;
        let mask = load_mask(&picture("mask"))?;
        let geometry = dir.join(format!("{scene}.geometry.npz"));
        let mut arrays = Arrays::open(&geometry)?;
        let size = visibility.size();
        if mask.size() != size {
            return Err(Error::new(picture("mask"), format!("is {:?}, the visibility {size:?}", mask.size())));
        }
        let normal = arrays.picture::<f32>("normal", size, 3)?;
        Ok(Self {
            scene: dir.join(format!("scenes/{scene}.scene.toml")),
            visibility,
            mask,
            depth: image(size, arrays.picture("depth", size, 1)?),
            normal: image(size, normal.as_chunks::<3>().0.to_vec()),
            model: image(size, arrays.picture("model", size, 1)?),
            camera: StoredCamera {
                eye: arrays.vector("eye")?,
                forward: arrays.vector("forward")?,
                right: arrays.vector("right")?,
                up: arrays.vector("up")?,
                tan_half_fov_y: arrays.array::<f64, 1>("tan_half_fov_y")?[0],
            },
        })
    }
}

/// The scenes that a folder holds references of, each with its lights in order.
///
/// # Errors
/// A folder that cannot be read or holds none.
pub fn list(dir: &Path) -> Result<BTreeMap<String, Vec<usize>>, Error> {
    let entries = std::fs::read_dir(dir).map_err(|e| {
        Error::new(dir, format!("cannot be read as a folder: {e}")).remedy("name the folder of the references")
    })?;
    let mut stored: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for name in entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()) {
        let parts = name.strip_suffix(".visibility.png").and_then(|rest| rest.rsplit_once(".light"));
        if let Some((scene, Ok(light))) = parts.map(|(scene, light)| (scene, light.parse())) {
            stored.entry(scene.to_owned()).or_default().push(light);
        }
    }
    if stored.is_empty() {
        return Err(Error::new(dir, "holds no NAME.lightK.visibility.png").remedy("name a folder of stored references"));
    }
    stored.values_mut().for_each(|lights| lights.sort_unstable());
    Ok(stored)
}

fn image<T>((width, height): (u32, u32), data: Vec<T>) -> Image<T> {
    Image { width, height, data }
}
