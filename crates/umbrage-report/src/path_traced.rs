//! Pictures of radiance under a scene's environment, traced on the CPU.

use crate::{
    choice::PATH_TRACED,
    error::Error,
    pictures::tone_mapped,
    progress::Progress,
    shot::{Aov, Picture, check_side},
    source::Source,
};
use std::time::Instant;
use umbrage::Registry;
use umbrage_core::glam::{DVec2, Vec3};
use umbrage_core::{Environment, Image};
use umbrage_reference::{Geometry, PathTracer, RadianceOptions, RadianceTruth, Tracer};

umbrage::settings! {
    /// Its settings.
    pub struct PathTraced {
        /// Paths for each pixel.
        samples: u32 = 256, in 2..=1048576,
        /// How often light is reflected on its way from the sky, before the surface that is seen.
        bounces: u32 = 0, in 0..=64,
    }
}

impl PathTraced {
    /// From pairs of name and value.
    ///
    /// # Errors
    /// Names that are not known, with the nearest one, and values out of range.
    pub fn read(registry: &Registry, set: &[(String, String)]) -> Result<Self, Error> {
        let mut settings = Self::default();
        umbrage::read_settings(registry, PATH_TRACED, &mut settings, set)?;
        Ok(settings)
    }

    /// Takes a picture of what the camera of `source` sees, and tells `progress` how noisy it is.
    ///
    /// # Errors
    /// A scene without an environment, or with materials that reflect more light than falls on
    /// them; a picture that shows something else than radiance or surfaces.
    pub fn take(
        &self,
        source: &Source,
        (width, height): (u32, u32),
        aov: &Aov,
        progress: &dyn Progress,
    ) -> Result<Picture, Error> {
        check_side(width, height)?;
        let scene = &source.scene;
        let wrong = |what: String| Error::scene(&source.asked, what);
        let tracer = Tracer::new(scene);
        let paths = PathTracer::new(&tracer, scene).map_err(wrong)?;
        let geometry = tracer.geometry(&scene.camera, width, height);
        let radiance = |progress: &dyn Progress| {
            progress.begin(&format!("{}: tracing paths", scene.name), u64::from(width) * u64::from(height));
            let options = RadianceOptions { samples: self.samples, bounces: self.bounces };
            let start = Instant::now();
            let seen = (&geometry, &scene.camera);
            let truth = paths.radiance(seen, &options, &|done, _| progress.at(done)).map_err(wrong);
            progress.end();
            let truth = truth?;
            progress.note(&summary(&truth, self.bounces, start.elapsed().as_secs_f64()));
            Ok::<_, Error>(truth)
        };
        match aov {
            Aov::Radiance => Ok(Picture::Radiance(radiance(progress)?.radiance)),
            Aov::Color => Ok(Picture::Color(lit_by_sky(source, &geometry, &radiance(progress)?.radiance))),
            Aov::Scored => Ok(Picture::Mask(geometry.receives)),
            Aov::Depth => Ok(Picture::Depth(geometry.depth)),
            Aov::Normal => Ok(Picture::Normal(geometry.normal.map(|n| n.to_array()))),
            Aov::Visibility => Err(Error::Name(format!(
                "`{PATH_TRACED}` finds radiance; take `--aov radiance`, or the technique `ray-traced` for visibility"
            ))),
            Aov::Inside(name) => Err(Error::Name(format!(
                "`{PATH_TRACED}` has no picture `{name}`; there are color, radiance, scored, depth, normal"
            ))),
        }
    }
}

fn summary(truth: &RadianceTruth, bounces: u32, seconds: f64) -> String {
    format!(
        "{} paths a pixel, {bounces} bounces: standard error of a pixel {:.2} % of the mean luminance; {:.1} million rays in {seconds:.1} s",
        truth.samples,
        100.0 * truth.relative_error(),
        truth.rays as f64 * 1e-6,
    )
}

/// Radiance as the renderer shows it, with the sky where there is no surface; what does not receive
/// is black.
pub(crate) fn lit_by_sky(source: &Source, geometry: &Geometry, radiance: &Image<[f32; 3]>) -> Image<[u8; 4]> {
    let (width, height) = radiance.size();
    let camera = &source.scene.camera;
    let environment = source.scene.environment.as_ref();
    let sky = |x: u32, y: u32| {
        let pixel = DVec2::new(x.into(), y.into()) + 0.5;
        let behind = |e: &Environment| e.radiance(camera.ray(pixel, width, height).normalize());
        environment.map_or(Vec3::ZERO, behind)
    };
    Image::from_fn(width, height, |x, y| {
        let is_sky = geometry.surface(x, y).is_none();
        tone_mapped(if is_sky { sky(x, y) } else { Vec3::from(radiance[(x, y)]) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Silent;

    #[test]
    fn a_picture_shows_the_sky_and_what_it_lights() {
        let source = Source::open("courtyard:0.1").unwrap();
        let settings = PathTraced { samples: 4, bounces: 1 };
        let take = |aov: &Aov| settings.take(&source, (32, 24), aov, &Silent);
        let Picture::Radiance(radiance) = take(&Aov::Radiance).unwrap() else { panic!("another picture") };
        let Picture::Color(color) = take(&Aov::Color).unwrap() else { panic!("another picture") };
        // The sky is at the top, the floor at the bottom.
        assert!(radiance[(16, 0)] == [0.0; 3] && color[(16, 0)][2] > 60);
        assert!(radiance[(16, 23)][1] > 0.05);
        assert!(take(&Aov::Visibility).unwrap_err().to_string().contains("--aov radiance"));
        assert!(take(&Aov::Inside("map".into())).is_err());
    }

    #[test]
    fn scenes_without_a_sky_are_refused() {
        let source = Source::open("contact").unwrap();
        let error = PathTraced::default().take(&source, (4, 4), &Aov::Radiance, &Silent).unwrap_err().to_string();
        assert!(error.starts_with("contact: ") && error.contains("no environment"), "{error}");
    }
}
