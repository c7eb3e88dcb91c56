//! The reference pictures of a scene: traced, kept from an earlier run, or read from a folder of
//! stored ones.

use crate::{error::Error, progress::Progress, source::Source};
use std::{path::Path, time::Instant};
use umbrage_core::{Environment, Image, Light, LightShape, Scene, Texture};
use umbrage_io::stored::StoredReference;
use umbrage_metrics::{contacts, discontinuities};
use umbrage_reference::{
    Geometry, Kept, KeptRadiance, Options, PathTracer, RadianceOptions, SceneKey, Traced, Tracer,
};

/// A scene ready to be traced at one size.
pub struct Tracing {
    tracer: Tracer,
    /// What every pixel shows.
    pub geometry: Geometry,
    edges: Image<bool>,
    contacts: Image<bool>,
    kept: Option<(Kept, SceneKey)>,
}

/// The truth about one light.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Visibility, 0 where a pixel is not scored.
    pub visibility: Image<f32>,
    /// The light that goes from each pixel to the eye, for techniques that answer with radiance;
    /// `None` where it is not known.
    pub radiance: Option<Image<[f32; 3]>>,
    /// Pixels that count: receiving, facing the light, not beside a depth discontinuity.
    pub mask: Image<bool>,
    /// The perfect hard shadow, for lights with an extent.
    pub hard: Option<Image<f32>>,
    /// Of radiance, its standard error at a pixel as a share of the mean luminance.
    pub noise: Option<f64>,
    /// In words.
    pub source: String,
    /// Rays for each scored pixel; `None` for stored pictures.
    pub samples: Option<u32>,
    /// Time that tracing it took, in an earlier run where it was kept, seconds.
    pub seconds: f64,
}

impl Tracing {
    /// Builds the hierarchy and looks through every pixel.
    pub fn new(source: &Source, width: u32, height: u32) -> Self {
        let tracer = Tracer::new(&source.scene);
        let geometry = tracer.geometry(&source.scene.camera, width, height);
        let edges = discontinuities(&geometry.depth, &geometry.model);
        let contacts = contacts(&source.scene.camera, &geometry.depth, &geometry.normal);
        Self { tracer, geometry, edges, contacts, kept: None }
    }

    /// Where surfaces touch, see [`contacts`](umbrage_metrics::contacts()).
    pub(crate) fn contacts(&self) -> &Image<bool> {
        &self.contacts
    }

    /// Keeps what is traced of `source` in `folder`, and traces nothing that is there already.
    pub fn kept_in(mut self, source: &Source, folder: Option<&Path>) -> Self {
        self.kept = folder.map(|folder| (Kept::new(folder), SceneKey::new(&source.scene)));
        self
    }

    /// The truth about light number `index`: stored in `folder`, else traced with `samples` rays
    /// for each pixel; of the environment with so many bounces.
    ///
    /// # Errors
    /// As [`Tracing::stored`].
    pub(crate) fn truth(
        &self,
        folder: Option<&Path>,
        source: &Source,
        index: usize,
        options: &RadianceOptions,
        progress: &dyn Progress,
    ) -> Result<Truth, Error> {
        let (scene, light) = (&source.scene, source.light(index)?);
        if let LightShape::Environment(environment) = &light.shape {
            return self.radiance(source, environment, folder.is_some(), options, progress);
        }
        let (width, height) = self.geometry.depth.size();
        let what = format!("{}, light {index} ({}): reference", scene.name, light.shape.kind().name());
        progress.begin(&what, u64::from(width) * u64::from(height));
        let truth = match folder {
            Some(folder) => self.stored(folder, source, index, progress),
            None => Ok(self.trace(&light, &scene.textures, options.samples, progress)),
        };
        progress.end();
        truth
    }

    /// Traces a light with `samples` rays for each pixel.
    pub fn trace(&self, light: &Light, textures: &[Texture], samples: u32, progress: &dyn Progress) -> Truth {
        let Traced { truth, seconds } = self.traced(light, textures, samples, progress);
        let soft = light.shape.kind().is_soft();
        let samples = if soft { samples } else { 1 };
        Truth {
            mask: without(&truth.scored, &self.edges),
            hard: soft.then(|| self.hard(light, textures, progress)),
            visibility: truth.visibility,
            radiance: None,
            noise: None,
            source: match samples {
                1 => "ray-traced, one ray to the light's centre".into(),
                n => format!("ray-traced, {n} samples"),
            },
            samples: Some(samples),
            seconds,
        }
    }

    /// Reads the truth about light number `index` from `folder`, where `NAME.lightK.visibility.png`
    /// and `NAME.lightK.mask.png` are.
    ///
    /// # Errors
    /// Pictures that are missing, damaged or of another size.
    pub fn stored(
        &self,
        folder: &Path,
        source: &Source,
        index: usize,
        progress: &dyn Progress,
    ) -> Result<Truth, Error> {
        let stored = StoredReference::open(folder, &source.stem(), index)?;
        let edges = discontinuities(&stored.depth, &stored.model.map(|&m| m.into()));
        let light = &*source.light(index)?;
        let soft = light.shape.kind().is_soft();
        Ok(Truth {
            mask: without(&stored.mask, &edges),
            hard: soft.then(|| self.hard(light, &source.scene.textures, progress)),
            visibility: stored.visibility,
            radiance: None,
            noise: None,
            source: format!("stored in {}", folder.display()),
            samples: None,
            seconds: 0.0,
        })
    }

    /// Pixels that show a receiving surface facing the light, with those beside discontinuities.
    pub fn visibility(
        &self,
        light: &Light,
        textures: &[Texture],
        samples: u32,
        progress: &dyn Progress,
    ) -> umbrage_reference::Truth {
        self.traced(light, textures, samples, progress).truth
    }

    /// Paths under an environment.
    fn radiance(
        &self,
        source: &Source,
        environment: &Environment,
        is_stored: bool,
        options: &RadianceOptions,
        progress: &dyn Progress,
    ) -> Result<Truth, Error> {
        if is_stored {
            let what = "radiance under the environment is traced, not read from --reference; choose another --light";
            return Err(Error::scene(&source.asked, what));
        }
        let (width, height) = self.geometry.depth.size();
        let scene = &source.scene;
        let what = format!("{}: tracing paths, {} bounces", scene.name, options.bounces);
        progress.begin(&what, u64::from(width) * u64::from(height));
        let traced = self.traced_paths(scene, environment, options, progress);
        progress.end();
        let KeptRadiance { truth, seconds } = traced.map_err(|what| Error::scene(&source.asked, what))?;
        Ok(Truth {
            mask: without(&truth.scored, &self.edges),
            noise: Some(truth.relative_error()),
            visibility: Image::filled(width, height, 0.0),
            samples: Some(truth.samples),
            source: format!("path-traced, {} paths, {} bounces", truth.samples, options.bounces),
            radiance: Some(truth.radiance),
            hard: None,
            seconds,
        })
    }

    /// What was kept of paths, or else is traced and kept.
    fn traced_paths(
        &self,
        scene: &Scene,
        environment: &Environment,
        options: &RadianceOptions,
        progress: &dyn Progress,
    ) -> Result<KeptRadiance, String> {
        let size = self.geometry.depth.size();
        let kept = self.kept.as_ref().map(|(kept, key)| (kept, key.of_radiance(environment, size, options)));
        if let Some((kept, key)) = &kept {
            match kept.read_radiance(*key, size) {
                Ok(Some(traced)) => return Ok(traced),
                Ok(None) => {}
                Err(error) => progress.note(&format!("{}: {error}; traced anew", kept.path(*key).display())),
            }
        }
        let start = Instant::now();
        let paths = PathTracer::under(&self.tracer, scene, environment)?;
        let truth = paths.radiance((&self.geometry, &scene.camera), options, &|done, _| progress.at(done))?;
        let traced = KeptRadiance { truth, seconds: start.elapsed().as_secs_f64() };
        if let Some((kept, key)) = kept
            && let Err(error) = kept.write_radiance(key, &traced)
        {
            progress.note(&format!("{}: can't be kept ({error})", kept.path(key).display()));
        }
        Ok(traced)
    }

    fn hard(&self, light: &Light, textures: &[Texture], progress: &dyn Progress) -> Image<f32> {
        self.visibility(light, textures, 1, progress).visibility
    }

    /// What was kept, or else is traced and kept. Neither a damaged file nor a full disk is worth
    /// ending a run.
    fn traced(&self, light: &Light, textures: &[Texture], samples: u32, progress: &dyn Progress) -> Traced {
        let options = Options { samples, ..Options::default() };
        let size = self.geometry.depth.size();
        let Some((kept, scene)) = &self.kept else { return self.trace_anew(light, textures, &options, progress) };
        let key = scene.of(light, size, &options);
        let file = kept.path(key);
        match kept.read(key, size) {
            Ok(Some(traced)) => return traced,
            Ok(None) => {}
            Err(error) => progress.note(&format!("{}: {error}; traced anew", file.display())),
        }
        let traced = self.trace_anew(light, textures, &options, progress);
        if let Err(error) = kept.write(key, &traced) {
            progress.note(&format!("{}: can't be kept ({error})", file.display()));
        }
        traced
    }

    fn trace_anew(&self, light: &Light, textures: &[Texture], options: &Options, progress: &dyn Progress) -> Traced {
        let start = Instant::now();
        let truth = self.tracer.visibility(&self.geometry, light, textures, options, &|done, _| progress.at(done));
        Traced { truth, seconds: start.elapsed().as_secs_f64() }
    }
}

/// The size of a light's picture: that of the stored reference in `folder`, or the one asked for.
///
/// # Errors
/// A reference that can't be read.
pub(crate) fn size_of(
    asked: (u32, u32),
    folder: Option<&Path>,
    source: &Source,
    light: usize,
) -> Result<(u32, u32), Error> {
    match folder {
        None => Ok(asked),
        Some(folder) => Ok(StoredReference::open(folder, &source.stem(), light)?.visibility.size()),
    }
}

fn without(scored: &Image<bool>, edges: &Image<bool>) -> Image<bool> {
    let data = scored.data.iter().zip(&edges.data).map(|(scored, edge)| *scored && !edge).collect();
    Image { width: scored.width, height: scored.height, data }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{
        fs,
        sync::{
            Mutex,
            atomic::{AtomicU64, Ordering},
        },
    };

    /// Counts what is traced, and keeps notes.
    #[derive(Default)]
    struct Watch {
        traced: AtomicU64,
        notes: Mutex<Vec<String>>,
    }

    impl Progress for Watch {
        fn begin(&self, _: &str, _: u64) {}
        fn at(&self, _: u64) {
            self.traced.fetch_add(1, Ordering::Relaxed);
        }
        fn end(&self) {}
        fn note(&self, text: &str) {
            self.notes.lock().unwrap().push(text.into());
        }
    }

    /// The truth about the soft light of `contact`, whether tracing was needed, and what was noted.
    fn truth(folder: &Path, change: impl Fn(&mut Source)) -> (Truth, bool, Vec<String>) {
        let mut source = Source::open("contact:0.2").unwrap();
        change(&mut source);
        let watch = Watch::default();
        let tracing = Tracing::new(&source, 24, 18).kept_in(&source, Some(folder));
        let options = RadianceOptions { samples: 4, bounces: 0 };
        let truth = tracing.truth(None, &source, 1, &options, &watch).unwrap();
        (truth, watch.traced.into_inner() > 0, watch.notes.into_inner().unwrap())
    }

    #[test]
    fn truth_is_traced_once_and_anew_where_the_scene_or_the_file_changed() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("truth");
        let (first, traced, _) = truth(&folder, |_| ());
        assert!(traced && first.hard.is_some());
        // The soft shadow and the hard one.
        let files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        assert_eq!(files.len(), 2, "{files:?}");

        let (again, traced, notes) = truth(&folder, |_| ());
        assert!(!traced && notes.is_empty(), "{notes:?}");
        assert_eq!((&again.visibility, &again.hard, &again.mask), (&first.visibility, &first.hard, &first.mask));
        assert_eq!((again.seconds, again.source), (first.seconds, first.source));

        let (_, traced, notes) = truth(&folder, |source| source.scene.meshes[0].positions[0].x += 0.01);
        assert!(traced && notes.is_empty(), "another scene has the same truth");

        for file in &files {
            let bytes = fs::read(file).unwrap();
            fs::write(file, &bytes[..bytes.len() / 2]).unwrap();
        }
        let (mended, traced, notes) = truth(&folder, |_| ());
        assert!(traced && notes.len() == 2 && notes[0].contains("damaged"), "{notes:?}");
        assert_eq!(mended.visibility, first.visibility);
        assert!(!truth(&folder, |_| ()).1, "the damaged file was not replaced");
    }
}
