//! Radiance that is kept on disk, beside what is kept of visibility.

use crate::kept::{Kept, Key, SceneKey};
use crate::{RadianceOptions, RadianceTruth};
use std::io;
use umbrage_core::{Environment, Fnv, Image};

/// The first bytes of a file, with the version of its form and of what the path tracer computes.
const MAGIC: &[u8; 16] = b"umbrage paths 1\n";

/// Width, height, paths, rays and seconds, after the magic.
const HEAD: usize = 16 + 4 + 4 + 4 + 8 + 8;

/// Three colours and an error of four bytes each, and whether the pixel is scored.
const PIXEL: usize = 17;

/// The check over all before it, at the end.
const CHECK: usize = 16;

/// A truth about radiance, and the time that tracing it took.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptRadiance {
    /// The truth.
    pub truth: RadianceTruth,
    /// Seconds.
    pub seconds: f64,
}

impl SceneKey {
    /// Of an environment in a picture of this size.
    pub fn of_radiance(&self, environment: &Environment, size: (u32, u32), options: &RadianceOptions) -> Key {
        let mut hash = self.hash();
        // The debug text of a picture has a hash of its pixels.
        hash.text(format_args!("{environment:?} {size:?} {options:?}"));
        hash.add(MAGIC);
        Key::of(&hash)
    }
}

impl Kept {
    /// What is kept; `None` where nothing is.
    ///
    /// # Errors
    /// A file that can't be read or is not as it was written.
    pub fn read_radiance(&self, key: Key, size: (u32, u32)) -> io::Result<Option<KeptRadiance>> {
        self.read_with(key, |bytes| decoded(bytes, size))
    }

    /// Keeps a truth: whole, or not at all.
    ///
    /// # Errors
    /// A folder that can't be written to.
    pub fn write_radiance(&self, key: Key, traced: &KeptRadiance) -> io::Result<()> {
        self.write_bytes(key, &encoded(traced))
    }
}

fn encoded(KeptRadiance { truth, seconds }: &KeptRadiance) -> Vec<u8> {
    let Image { width, height, data } = &truth.radiance;
    let mut bytes = Vec::with_capacity(HEAD + PIXEL * data.len() + CHECK);
    bytes.extend(MAGIC);
    bytes.extend(width.to_le_bytes());
    bytes.extend(height.to_le_bytes());
    bytes.extend(truth.samples.to_le_bytes());
    bytes.extend(truth.rays.to_le_bytes());
    bytes.extend(seconds.to_le_bytes());
    bytes.extend(data.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend(truth.error.data.iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend(truth.scored.data.iter().map(|scored| u8::from(*scored)));
    let check = Fnv::of(&bytes);
    bytes.extend(check.to_le_bytes());
    bytes
}

/// The other way; `None` for bytes that no truth of this size gives.
fn decoded(bytes: &[u8], (width, height): (u32, u32)) -> Option<KeptRadiance> {
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
    let (samples, rest) = rest.split_first_chunk::<4>()?;
    let (rays, rest) = rest.split_first_chunk::<8>()?;
    let (seconds, rest) = rest.split_first_chunk::<8>()?;
    let size = (u32::from_le_bytes(*own_width), u32::from_le_bytes(*own_height));
    if magic != MAGIC || size != (width, height) {
        return None;
    }
    let (numbers, scored) = rest.split_at_checked(16 * pixels)?;
    let numbers: Vec<f32> = numbers.as_chunks::<4>().0.iter().map(|v| f32::from_le_bytes(*v)).collect();
    let (radiance, error) = numbers.split_at_checked(3 * pixels)?;
    let truth = RadianceTruth {
        radiance: Image { width, height, data: radiance.as_chunks::<3>().0.to_vec() },
        error: Image { width, height, data: error.to_vec() },
        scored: Image { width, height, data: scored.iter().map(|scored| *scored != 0).collect() },
        samples: u32::from_le_bytes(*samples),
        rays: u64::from_le_bytes(*rays),
    };
    Some(KeptRadiance { truth, seconds: f64::from_le_bytes(*seconds) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use std::fs;
    use umbrage_core::{Scene, Sky};

    #[test]
    fn radiance_comes_back_as_it_was_and_is_told_by_its_sky() {
        let place = tempfile::tempdir().unwrap();
        let kept = Kept::new(place.path());
        let scene = SceneKey::new(&Scene::default());
        let options = RadianceOptions::default();
        let sky = Environment::new(Sky::Constant(Vec3::ONE));
        let key = scene.of_radiance(&sky, (2, 1), &options);
        let traced = KeptRadiance {
            truth: RadianceTruth {
                radiance: Image { width: 2, height: 1, data: vec![[0.5, 1.0, 2.0], [0.0; 3]] },
                error: Image { width: 2, height: 1, data: vec![0.125, 0.0] },
                scored: Image { width: 2, height: 1, data: vec![true, false] },
                samples: 16,
                rays: 99,
            },
            seconds: 1.5,
        };
        assert_eq!(kept.read_radiance(key, (2, 1)).unwrap(), None);
        kept.write_radiance(key, &traced).unwrap();
        assert_eq!(kept.read_radiance(key, (2, 1)).unwrap(), Some(traced));
        assert!(kept.read_radiance(key, (1, 2)).is_err(), "a picture of another size was taken");
        let bytes = fs::read(kept.path(key)).unwrap();
        fs::write(kept.path(key), &bytes[..bytes.len() - 1]).unwrap();
        assert!(kept.read_radiance(key, (2, 1)).unwrap_err().to_string().contains("damaged"));
        let turned = Environment { rotate_deg: 1.0, ..sky.clone() };
        let bounced = RadianceOptions { bounces: 1, ..options };
        let others = [scene.of_radiance(&turned, (2, 1), &options), scene.of_radiance(&sky, (2, 1), &bounced)];
        assert!(others.iter().all(|other| *other != key));
    }
}
