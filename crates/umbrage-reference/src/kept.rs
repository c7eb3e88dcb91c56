//! Truth that is kept on disk: the same scene, light, camera, size and rays are traced once.

use crate::light_view::LEAST_COSINE;
use crate::{Options, Tracer, Truth};
use glam::{DMat3, DVec2, DVec3};
use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::{
        OnceLock,
        atomic::{AtomicU32, Ordering},
    },
};
use umbrage_core::{Fnv, Image, Light, LightShape, Scene, scenes};

/// The first bytes of a file, with the version of its form.
const MAGIC: &[u8; 16] = b"umbrage truth 1\n";

/// Width, height, rays and seconds, after the magic.
const HEAD: usize = 16 + 4 + 4 + 8 + 8;

/// A visibility takes four bytes, and whether the pixel is scored one.
const PIXEL: usize = 5;

/// The check over all before it, at the end.
const CHECK: usize = 16;

/// A folder of truth.
#[derive(Clone, Debug)]
pub struct Kept {
    folder: PathBuf,
}

/// What of a scene determines the truth about any light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneKey(Fnv);

/// What determines one truth: the name of its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key(u128);

impl Key {
    /// Of all that was added to a hash.
    pub(crate) fn of(hash: &Fnv) -> Self {
        Self(hash.value())
    }
}

/// A truth, and the time that tracing it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// The truth.
    pub truth: Truth,
    /// Seconds.
    pub seconds: f64,
}

impl SceneKey {
    /// Of the scene's geometry, materials and camera. Its name, its ambient light and its lights
    /// make no difference.
    pub fn new(scene: &Scene) -> Self {
        let mut hash = Fnv::default();
        hash.add(&fingerprint().to_le_bytes());
        // The debug text names every number to the last bit.
        hash.text(format_args!("{:?} {:?} {:?}", scene.camera, scene.instances, scene.materials));
        hash.text(format_args!("{:?} {:?} {:?}", scene.meshes, scene.rigs, scene.textures));
        Self(hash)
    }

    /// To be gone on with.
    pub(crate) fn hash(&self) -> Fnv {
        self.0
    }

    /// Of a light in a picture of this size.
    pub fn of(&self, light: &Light, size: (u32, u32), options: &Options) -> Key {
        let mut hash = self.0;
        let samples = if light.shape.kind().is_soft() { options.samples } else { 1 };
        // Light is the same, whatever its colour and strength.
        hash.text(format_args!("{:?} {} ", light.shape, light.casts));
        hash.text(format_args!("{size:?} {samples} {}", options.same_points));
        Key(hash.value())
    }
}

impl Kept {
    /// In this folder, which is made when something is kept.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_path_buf() }
    }

    /// Where a truth is, or would be.
    pub fn path(&self, key: Key) -> PathBuf {
        self.folder.join(format!("{:032x}.truth", key.0))
    }

    /// What is kept; `None` where nothing is.
    ///
    /// # Errors
    /// A file that can't be read or is not as it was written.
    pub fn read(&self, key: Key, size: (u32, u32)) -> io::Result<Option<Traced>> {
        self.read_with(key, |bytes| decoded(bytes, size))
    }

    /// What `decoded` makes of a file.
    pub(crate) fn read_with<T>(&self, key: Key, decoded: impl FnOnce(&[u8]) -> Option<T>) -> io::Result<Option<T>> {
        match fs::read(self.path(key)) {
            Ok(bytes) => decoded(&bytes).map(Some).ok_or_else(|| {
                io::Error::new(io::ErrorKind::InvalidData, "the file is damaged, or of another version or picture")
            }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Keeps a truth: whole, or not at all.
    ///
    /// # Errors
    /// A folder that can't be written to.
    pub fn write(&self, key: Key, traced: &Traced) -> io::Result<()> {
        self.write_bytes(key, &encoded(traced))
    }

    /// Writes a file whole, or not at all.
    pub(crate) fn write_bytes(&self, key: Key, bytes: &[u8]) -> io::Result<()> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        fs::create_dir_all(&self.folder)?;
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let beside = self.folder.join(format!(".{:032x}.{}.{number}", key.0, std::process::id()));
        let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, self.path(key)));
        if written.is_err() {
            // What could not be written whole is of no use; that it may stay changes nothing.
            let _ = fs::remove_file(&beside);
        }
        written
    }
}

/// What the tracer makes of a small scene under every kind of light that it samples: a tracer that
/// traces otherwise finds nothing of what was kept.
fn fingerprint() -> u128 {
    static FOUND: OnceLock<u128> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let mut hash = Fnv::default();
        hash.add(&LEAST_COSINE.to_le_bytes());
        let Some(entry) = scenes::find("contact") else { return hash.value() };
        let scene = (entry.build)(0.2);
        let tracer = Tracer::new(&scene);
        let geometry = tracer.geometry(&scene.camera, 24, 18);
        hash.text(format_args!("{:?} {:?}", geometry.depth, geometry.normal));
        for light in scene.lights.iter().take(1).flat_map(probes) {
            let options = Options { samples: 5, ..Options::default() };
            let truth = tracer.visibility(&geometry, &light, &scene.textures, &options, &|_, _| ());
            hash.text(format_args!("{:?} {:?}", truth.visibility.data, truth.scored.data));
        }
        hash.value()
    })
}

/// A light of every kind where `light` is.
fn probes(light: &Light) -> [Light; 7] {
    let position = light.shape.center().truncate();
    let (direction, up) = (DVec3::NEG_Y, DVec3::Z);
    let shapes = [
        LightShape::Point { position },
        LightShape::Directional { direction: DVec3::new(0.36, -0.8, 0.48), angle_deg: 4.0 },
        LightShape::Sphere { position, radius: 0.4 },
        LightShape::Ellipsoid { position, radii: DVec3::new(0.6, 0.2, 0.3), rotation: DMat3::from_rotation_z(0.5) },
        LightShape::Disc { position, direction, radius: 0.4 },
        LightShape::Rect { position, direction, up, size: DVec2::new(0.8, 0.5), texture: None },
        LightShape::Line { from: position - 0.4 * DVec3::X, to: position + 0.4 * DVec3::X },
    ];
    shapes.map(|shape| Light { shape, ..light.clone() })
}

fn encoded(Traced { truth, seconds }: &Traced) -> Vec<u8> {
    let Image { width, height, data } = &truth.visibility;
    let mut bytes = Vec::with_capacity(HEAD + PIXEL * data.len() + CHECK);
    bytes.extend(MAGIC);
    bytes.extend(width.to_le_bytes());
    bytes.extend(height.to_le_bytes());
    bytes.extend(truth.rays.to_le_bytes());
    bytes.extend(seconds.to_le_bytes());
    bytes.extend(data.iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend(truth.scored.data.iter().map(|scored| u8::from(*scored)));
    let check = Fnv::of(&bytes);
    bytes.extend(check.to_le_bytes());
    bytes
}

/// The other way; `None` for bytes that no truth of this size gives.
fn decoded(bytes: &[u8], (width, height): (u32, u32)) -> Option<Traced> {
    let pixels = usize::try_from(u64::from(width) * u64::from(height)).ok()?;
    if bytes.len() != HEAD + PIXEL * pixels + CHECK {
        return None;
    }
    let (content, check) = bytes.split_last_chunk::<CHECK>()?;
    if u128::from_le_bytes(*check) != Fnv::of(content) {
        return None;
    }
    let (magic, rest) = content.split_first_chunk::<16>()?;
    let (own_width, rest) = rest.split_first_chunk::<4>()?;
    let (own_height, rest) = rest.split_first_chunk::<4>()?;
    let (rays, rest) = rest.split_first_chunk::<8>()?;
    let (seconds, rest) = rest.split_first_chunk::<8>()?;
    let size = (u32::from_le_bytes(*own_width), u32::from_le_bytes(*own_height));
    if magic != MAGIC || size != (width, height) {
        return None;
    }
    let (visibility, scored) = rest.split_at_checked(4 * pixels)?;
    let visibility = visibility.as_chunks::<4>().0.iter().map(|v| f32::from_le_bytes(*v)).collect();
    let truth = Truth {
        visibility: Image { width, height, data: visibility },
        scored: Image { width, height, data: scored.iter().map(|scored| *scored != 0).collect() },
        rays: u64::from_le_bytes(*rays),
    };
    Some(Traced { truth, seconds: f64::from_le_bytes(*seconds) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        (scenes::find("contact").expect("a scene").build)(0.2)
    }

    fn traced() -> Traced {
        let visibility = Image { width: 2, height: 1, data: vec![0.25, 1.0] };
        let scored = Image { width: 2, height: 1, data: vec![true, false] };
        Traced { truth: Truth { visibility, scored, rays: 7 }, seconds: 1.5 }
    }

    #[test]
    fn what_determines_the_truth_changes_its_key_and_nothing_else_does() {
        let (mut scene, options) = (scene(), Options { samples: 8, ..Options::default() });
        let light = scene.lights[1].clone();
        let key = |scene: &Scene, light: &Light, size, options: &Options| SceneKey::new(scene).of(light, size, options);
        let before = key(&scene, &light, (8, 6), &options);
        let dim = Light { intensity: 0.5, ..light.clone() };
        scene.name.push('x');
        scene.lights.clear();
        assert_eq!(key(&scene, &dim, (8, 6), &options), before);
        let other = [
            key(&scene, &light, (6, 8), &options),
            key(&scene, &light, (8, 6), &Options { samples: 9, ..options }),
            key(&scene, &probes(&light)[4], (8, 6), &options),
        ];
        scene.meshes[0].positions[0].x += 1e-6;
        let moved = key(&scene, &light, (8, 6), &options);
        assert!(other.iter().chain([&moved]).all(|other| *other != before), "{other:?} {moved:?}");
    }

    #[test]
    fn truth_comes_back_as_it_was() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("truth");
        let kept = Kept::new(&folder);
        let key = Key(3);
        assert_eq!(kept.read(key, (2, 1)).unwrap(), None);
        kept.write(key, &traced()).unwrap();
        assert_eq!(kept.read(key, (2, 1)).unwrap(), Some(traced()));
        assert!(kept.read(key, (1, 2)).is_err(), "a picture of another size was taken");
        let whole = fs::read(kept.path(key)).unwrap();
        let mut changed = whole.clone();
        changed[HEAD] ^= 1;
        for wrong in [&whole[..whole.len() - 1], &whole[..8], &changed, b"not a truth at all"] {
            fs::write(kept.path(key), wrong).unwrap();
            assert!(kept.read(key, (2, 1)).unwrap_err().to_string().contains("damaged"));
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "something was left beside the truth");
    }
}
