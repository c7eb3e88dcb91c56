//! The light of a sky as coefficients, read and written.

use crate::{Error, Source};
use std::path::{Path, PathBuf};
use umbrage_core::glam::DQuat;
use umbrage_core::harmonics::{Light, Order, project_equirect};
use umbrage_io::{Probe, open_probe};

/// Columns of the picture that a sky is projected from; half as many rows.
const COLUMNS: u32 = 256;

/// Where light comes from, and how it is written.
#[derive(Clone, Debug)]
pub struct SkyProbe {
    /// A file of coefficients, or a scene with an environment.
    pub from: String,
    /// How to write it.
    pub form: Probe,
    /// Where; the text is handed back where this is none.
    pub path: Option<PathBuf>,
}

impl SkyProbe {
    /// Writes the light, or gives its text.
    ///
    /// # Errors
    /// Files that can't be read or written; a scene without an environment.
    pub fn run(&self) -> Result<Option<String>, Error> {
        let light = self.light()?;
        let Some(path) = &self.path else { return Ok(Some(self.form.text(&light))) };
        self.form.save(&light, path)?;
        Ok(None)
    }

    fn light(&self) -> Result<Light, Error> {
        let path = Path::new(&self.from);
        if ["txt", "json"].iter().any(|ending| path.extension().is_some_and(|e| e == *ending)) {
            return Ok(open_probe(path)?);
        }
        let scene = Source::open(&self.from)?.scene;
        let environment = scene.environment.as_ref().ok_or_else(|| {
            Error::scene(&self.from, "there is no environment in it; add an [environment], or take a scene that has one")
        })?;
        let picture = environment.sky.picture(COLUMNS, COLUMNS / 2);
        let light = project_equirect(Order::of_functions(9).unwrap_or_default(), &picture);
        let turned: Vec<_> = light.coefficients().iter().map(|c| *c * f64::from(environment.intensity)).collect();
        let light = Light::new(turned).unwrap_or(light);
        Ok(light.rotated(DQuat::from_mat3(&environment.world_from_sky())))
    }
}
