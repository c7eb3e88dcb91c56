//! The reference pictures of a scene: traced, or read from a folder.

use crate::{error::Error, progress::Progress, source::Source};
use std::{path::Path, time::Instant};
use umbrage_core::{Image, Light, Texture};
use umbrage_io::stored::StoredReference;
use umbrage_metrics::discontinuities;
use umbrage_reference::{Geometry, Options, Tracer};

/// A scene ready to be traced at one size.
pub struct Tracing {
    tracer: Tracer,
    /// What every pixel shows.
    pub geometry: Geometry,
    edges: Image<bool>,
}

/// The truth about one light.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Visibility, 0 where a pixel is not scored.
    pub visibility: Image<f32>,
    /// Pixels that count: receiving, facing the light, not beside a depth discontinuity.
    pub mask: Image<bool>,
    /// The perfect hard shadow, for lights with an extent.
    pub hard: Option<Image<f32>>,
    /// In words.
    pub source: String,
    /// Rays for each scored pixel; `None` for stored pictures.
    pub samples: Option<u32>,
    /// Time it took, seconds.
    pub seconds: f64,
}

impl Tracing {
    /// Builds the hierarchy and looks through every pixel.
    pub fn new(source: &Source, width: u32, height: u32) -> Self {
        let tracer = Tracer::new(&source.scene);
        let geometry = tracer.geometry(&source.scene.camera, width, height);
        let edges = discontinuities(&geometry.depth, &geometry.model);
        Self { tracer, geometry, edges }
    }

    /// Traces a light with `samples` rays for each pixel.
    pub fn trace(&self, light: &Light, textures: &[Texture], samples: u32, progress: &dyn Progress) -> Truth {
        let start = Instant::now();
        let traced = self.visibility(light, textures, samples, progress);
        let seconds = start.elapsed().as_secs_f64();
        let soft = light.shape.kind().is_soft();
        let samples = if soft { samples } else { 1 };
        Truth {
            mask: without(&traced.scored, &self.edges),
            hard: soft.then(|| self.hard(light, textures, progress)),
            visibility: traced.visibility,
            source: match samples {
                1 => "ray-traced, one ray to the light's centre".into(),
                n => format!("ray-traced, {n} samples"),
            },
            samples: Some(samples),
            seconds,
        }
    }

    /// Reads the truth about light number `index` from `folder`, where `NAME.lightK.visibility.png` and
    /// `NAME.lightK.mask.png` are.
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
        let light = &source.scene.lights[index];
        let soft = light.shape.kind().is_soft();
        Ok(Truth {
            mask: without(&stored.mask, &edges),
            hard: soft.then(|| self.hard(light, &source.scene.textures, progress)),
            visibility: stored.visibility,
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
        let options = Options { samples, ..Options::default() };
        self.tracer.visibility(&self.geometry, light, textures, &options, &|done, _| progress.at(done))
    }

    fn hard(&self, light: &Light, textures: &[Texture], progress: &dyn Progress) -> Image<f32> {
        self.visibility(light, textures, 1, progress).visibility
    }
}

fn without(scored: &Image<bool>, edges: &Image<bool>) -> Image<bool> {
    let data = scored.data.iter().zip(&edges.data).map(|(scored, edge)| *scored && !edge).collect();
    Image { width: scored.width, height: scored.height, data }
}
