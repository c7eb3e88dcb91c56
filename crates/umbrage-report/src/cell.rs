//! One technique on one light: rendered, scored, timed.

use crate::{
    choice::Choice,
    error::Error,
    given::Given,
    measure::{Frames, is_of_technique},
    path_traced::lit_by_sky,
    pictures::{Pictures, grey, opaque, tone_mapped},
    record::{CostRecord, PassRecord, RadianceRecord, ReferenceRecord, ResultRecord, ScoresRecord},
    source::Source,
    stage::{Actor, Stage},
    truth::{Tracing, Truth},
};
use std::{collections::BTreeMap, time::Duration};
use umbrage::{Answer, Gpu, Technique};
use umbrage_core::Image;
use umbrage_metrics::{
    Comparison, RadianceComparison, Scores, aliasing, around_borders, flip_of_colors, footprint_colors, heat, luminance, reach_of,
    score, score_radiance, seam, standard_error, texel_footprint,
};
use umbrage_reference::Geometry;
use umbrage_renderer::{LightPass, Renderer};

/// What all techniques on one light share.
pub(crate) struct Cell<'a> {
    pub gpu: &'a Gpu,
    pub source: &'a Source,
    pub light: usize,
    pub truth: &'a Truth,
    pub tracing: &'a Tracing,
    /// Frames in which nothing changes, before the one that is scored.
    pub still: u32,
}

/// A technique's last frame, held against the truth.
pub(crate) struct Scored {
    pub found: Found,
    pub cost: CostRecord,
}

/// The answer of a technique, and its errors.
pub(crate) enum Found {
    Visibility {
        scores: ScoresRecord,
        picture: Image<f32>,
        /// For techniques with maps: how large their texels are on the screen.
        footprint: Option<Image<f32>>,
    },
    Radiance {
        scores: RadianceRecord,
        picture: Image<[f32; 3]>,
    },
}

/// Time for the frames of one technique; one that needs longer is measured over fewer.
pub(crate) const TIME_LIMIT: Duration = Duration::from_secs(4);

impl Cell<'_> {
    /// Runs a technique over up to `frames`; what it can't do and what goes wrong is in the record.
    pub(crate) fn run(
        &self,
        stage: &mut Stage<'_>,
        choice: &Choice,
        frames: u32,
        place: &str,
        pictures: &mut Pictures,
    ) -> ResultRecord {
        let mut record = ResultRecord::of(choice);
        let mut shown = Pictures::default();
        let filled = self.actor(stage, choice).and_then(|actor| {
            let name = format!("{place}-{}", choice.label());
            stage.act(self.light, actor, |renderer| self.fill(&mut record, renderer, frames, &name, &mut shown))
        });
        match filled {
            Ok(_) => pictures.files.append(&mut shown.files),
            Err(error) => record.fail(&error),
        }
        record
    }

    /// The technique of a choice, where it can do the light.
    pub(crate) fn actor(&self, stage: &Stage<'_>, choice: &Choice) -> Result<Actor, Error> {
        choice.supports(self.source.light(self.light)?.shape.kind())?;
        stage.actor(choice)
    }

    fn fill(
        &self,
        record: &mut ResultRecord,
        renderer: &mut Renderer,
        frames: u32,
        name: &str,
        pictures: &mut Pictures,
    ) -> Result<(), Error> {
        let Scored { found, cost } = self.scored(renderer, frames)?;
        record.cost = Some(cost);
        let mut add = |kind, picture: &Image<[u8; 3]>| {
            record.pictures.insert(kind, pictures.add(&format!("{name}-{kind}"), picture)?);
            Ok::<_, Error>(())
        };
        add("color", &opaque(&renderer.color()?))?;
        match found {
            Found::Visibility { scores, picture, footprint } => {
                record.scores = Some(scores);
                add("visibility", &grey(&picture))?;
                add("error", &heat(&picture, &self.truth.visibility, &self.truth.mask))?;
                if let Some(footprint) = footprint {
                    record.aliasing = aliasing(&footprint, &self.truth.mask).map(Into::into);
                    add("aliasing", &footprint_colors(&footprint))?;
                }
            }
            Found::Radiance { scores, picture } => {
                record.radiance = Some(scores);
                add("error", &self.radiance_heat(&picture)?)?;
            }
        }
        Ok(())
    }

    /// Measures up to `frames` of the technique on stage, and scores the last.
    pub(crate) fn scored(&self, renderer: &mut Renderer, frames: u32) -> Result<Scored, Error> {
        let frames = Frames::measure(renderer, &self.source.scene.camera, frames, TIME_LIMIT)?;
        for _ in 0..self.still {
            renderer.frame(&self.source.scene.camera)?;
            renderer.wait()?;
        }
        let found = match renderer.technique(0).map(Technique::answer).unwrap_or_default() {
            Answer::Visibility => self.visibility(renderer)?,
            Answer::Radiance => self.radiance(renderer)?,
        };
        Ok(Scored { found, cost: cost(&frames, renderer) })
    }

    fn visibility(&self, renderer: &Renderer) -> Result<Found, Error> {
        let picture = renderer.visibility(0)?;
        let footprint = self.footprint(renderer);
        let scores = self.score(&picture, footprint.as_ref().map(reach_of).as_ref())?;
        let (seam, reference_error) = (self.seam(&picture, renderer)?, self.standard_error());
        let scores = ScoresRecord { seam, reference_error, ..scores.into() };
        Ok(Found::Visibility { scores, picture, footprint })
    }

    fn radiance(&self, renderer: &Renderer) -> Result<Found, Error> {
        let picture = renderer.radiance(0)?;
        let (reference, mask) = (self.true_radiance()?, &self.truth.mask);
        let scores = score_radiance(&RadianceComparison { produced: &picture, reference, mask })?;
        let scores = RadianceRecord::new(scores, self.radiance_flip(&picture)?);
        Ok(Found::Radiance { scores, picture })
    }

    /// How different the tone-mapped pictures look; they are the same where nothing is scored.
    fn radiance_flip(&self, produced: &Image<[f32; 3]>) -> Result<f64, Error> {
        let reference = self.true_radiance()?;
        let mut judged = reference.clone();
        let pixels = judged.data.iter_mut().zip(&produced.data).zip(&self.truth.mask.data);
        pixels.filter(|(_, scored)| **scored).for_each(|((into, color), _)| *into = *color);
        let shown = |image: &Image<[f32; 3]>| opaque(&image.map(|color| tone_mapped((*color).into())));
        Ok(flip_of_colors(&shown(&judged), &shown(reference)))
    }

    fn true_radiance(&self) -> Result<&Image<[f32; 3]>, Error> {
        self.truth.radiance.as_ref().ok_or_else(|| {
            let what = "lights other than the environment: the truth of their radiance is not known".into();
            umbrage::Error::Unsupported { technique: "radiance".into(), what }.into()
        })
    }

    /// Where radiance is wrong. The truth's mean luminance is a grey of one half.
    fn radiance_heat(&self, produced: &Image<[f32; 3]>) -> Result<Image<[u8; 3]>, Error> {
        let (reference, mask) = (self.true_radiance()?, &self.truth.mask);
        let scored = || reference.data.iter().zip(&mask.data).filter(|(_, scored)| **scored);
        let mean = scored().map(|(color, _)| luminance(color)).sum::<f64>() / scored().count().max(1) as f64;
        let grey = |picture: &Image<[f32; 3]>| picture.map(|color| (0.5 * luminance(color) / mean.max(1e-30)) as f32);
        Ok(heat(&grey(produced), &grey(reference), mask))
    }

    /// The record of the truth itself, with the scene shaded under it. Where the GPU fails, that
    /// picture is left out: the techniques' own records say why.
    pub(crate) fn reference(&self, place: &str, pictures: &mut Pictures) -> Result<ReferenceRecord, Error> {
        let Truth { visibility, hard, radiance, .. } = self.truth;
        let mut shown = BTreeMap::new();
        if let Some(radiance) = radiance {
            let color = opaque(&lit_by_sky(self.source, &self.tracing.geometry, radiance));
            shown.insert("color", pictures.add(&format!("{place}-reference-color"), &color)?);
            return Ok(self.reference_record(shown));
        }
        if let Ok(color) = self.shade(visibility) {
            shown.insert("color", pictures.add(&format!("{place}-reference-color"), &opaque(&color))?);
        }
        shown.insert("visibility", pictures.add(&format!("{place}-reference-visibility"), &grey(visibility))?);
        if let Some(hard) = hard {
            shown.insert("hard", pictures.add(&format!("{place}-reference-hard"), &grey(hard))?);
        }
        Ok(self.reference_record(shown))
    }

    fn reference_record(&self, shown: BTreeMap<&'static str, String>) -> ReferenceRecord {
        let Truth { mask, hard, source, samples, seconds, .. } = self.truth;
        ReferenceRecord {
            source: source.clone(),
            samples: *samples,
            seconds: *seconds,
            scored_pixels: mask.data.iter().filter(|m| **m).count(),
            hard_mae: hard.as_ref().and_then(|hard| self.score(hard, None).ok()).map(|s| s.mae),
            standard_error: self.standard_error(),
            pictures: shown,
        }
    }

    /// The scene in colour under visibility that is known.
    fn shade(&self, visibility: &Image<f32>) -> Result<Image<[u8; 4]>, Error> {
        let mut renderer = self.renderer(Box::new(Given::new(self.gpu, visibility)?))?;
        renderer.frame(&self.source.scene.camera)?;
        Ok(renderer.color()?)
    }

    /// Errors of a visibility picture of this light.
    fn score(&self, produced: &Image<f32>, reach: Option<&Image<f32>>) -> Result<Scores, Error> {
        let Truth { visibility, mask, hard, .. } = self.truth;
        let contacts = Some(self.tracing.contacts()).filter(|contacts| contacts.size() == mask.size());
        Ok(score(&Comparison { produced, reference: visibility, mask, hard: hard.as_ref(), reach, contacts })?)
    }

    /// What the truth's own randomness is about, where it is known.
    fn standard_error(&self) -> Option<f64> {
        let Truth { visibility, mask, samples, noise, .. } = self.truth;
        noise.or_else(|| samples.map(|samples| if samples == 1 { 0.0 } else { standard_error(visibility, mask, samples) }))
    }

    /// For techniques with maps: how large their texels are on the screen.
    fn footprint(&self, renderer: &Renderer) -> Option<Image<f32>> {
        let technique = renderer.technique(0)?;
        let (views, splits) = (technique.inside().light_views(), technique.inside().split_distances());
        let Geometry { depth, normal, .. } = &self.tracing.geometry;
        (!views.is_empty()).then(|| texel_footprint(views, splits, &self.source.scene.camera, depth, normal))
    }

    /// For techniques with splits: how much worse shadows are around their borders.
    fn seam(&self, produced: &Image<f32>, renderer: &Renderer) -> Result<Option<f64>, Error> {
        let Some(technique) = renderer.technique(0) else { return Ok(None) };
        let (views, splits) = (technique.inside().light_views(), technique.inside().split_distances());
        let around = around_borders(views, splits, &self.source.scene.camera, &self.tracing.geometry.depth);
        let Truth { visibility, mask, .. } = self.truth;
        Ok(seam(produced, visibility, mask, &around)?)
    }

    fn renderer(&self, technique: Box<dyn Technique>) -> Result<Renderer, Error> {
        let (width, height) = self.tracing.geometry.depth.size();
        let pass = LightPass { light: self.light, technique };
        let mut renderer = Renderer::new(self.gpu, &self.source.scene, width, height, vec![pass])?;
        // What is scored is the technique's own answer, whatever the light lights.
        renderer.set_clipping(false);
        Ok(renderer)
    }
}

fn cost(frames: &Frames, renderer: &Renderer) -> CostRecord {
    let stats = renderer.stats(0);
    let passes = frames.passes().into_iter().filter(|(owner, ..)| is_of_technique(*owner));
    CostRecord {
        frames: frames.count(),
        passes: passes.map(|(_, pass, spread)| PassRecord { pass, time_ms: spread.median }).collect(),
        gpu_ms: frames.technique().map(|t| t.median),
        prepare_ms: frames.prepare().median,
        frame_ms: frames.frame().median,
        draws: stats.draws,
        triangles: stats.triangles,
        bytes: stats.bytes,
        counts: renderer.counts(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{bakes::Bakes, progress::Silent};
    use umbrage_reference::RadianceOptions;
    use umbrage::{InOrder, Inside, Passes, RadianceTarget, Stats, View, VisibilityTarget, fullscreen::attachment};

    /// The same radiance from everywhere.
    struct Constant([f64; 3]);

    impl Technique for Constant {
        fn prepare_view(&mut self, _: &Gpu, _: &View<'_>, _: InOrder) -> Result<(), umbrage::Error> {
            Ok(())
        }

        fn record_visibility(
            &mut self,
            _: &mut Passes<'_>,
            _: &View<'_>,
            _: &VisibilityTarget,
            _: InOrder,
        ) -> Result<(), umbrage::Error> {
            self.answer().refuse()
        }

        fn answer(&self) -> Answer {
            Answer::Radiance
        }

        fn record_radiance(
            &mut self,
            passes: &mut Passes<'_>,
            _: &View<'_>,
            radiance: &RadianceTarget,
            _: InOrder,
        ) -> Result<(), umbrage::Error> {
            let [r, g, b] = self.0;
            let color = wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 });
            passes.render("constant", &[attachment(&radiance.view, color)], None);
            Ok(())
        }

        fn inside(&self) -> &dyn Inside {
            self
        }

        fn inside_mut(&mut self) -> &mut dyn Inside {
            self
        }
    }

    impl Inside for Constant {
        fn stats(&self) -> Stats {
            Stats::default()
        }
    }

    #[test]
    fn radiance_is_scored_as_radiance() {
        let gpu = Gpu::request(None).unwrap();
        let source = Source::open("contact:0.2").unwrap();
        let tracing = Tracing::new(&source, 48, 36);
        let options = RadianceOptions { samples: 1, bounces: 0 };
        let mut truth = tracing.truth(None, &source, 0, &options, &Silent).unwrap();
        truth.radiance = Some(Image::filled(48, 36, [0.5; 3]));
        let choice = Choice::parse(&umbrage::Registry::default(), "none", &[]).unwrap();
        let run = |truth: &Truth, technique: Box<dyn Technique>| {
            let cell = Cell { gpu: &gpu, source: &source, light: 0, truth, tracing: &tracing, still: 0 };
            let mut stage = Stage::new(&gpu, &source, (48, 36), Bakes::new(&source, None, &Silent));
            let mut record = ResultRecord::of(&choice);
            let mut pictures = Pictures::default();
            let acted = stage.act(0, Actor::new(&gpu, technique), |renderer| {
                cell.fill(&mut record, renderer, 1, "constant", &mut pictures)
            });
            acted.map(|_| (record, pictures))
        };
        let (record, pictures) = run(&truth, Box::new(Constant([0.625; 3]))).unwrap();
        let scores = record.radiance.unwrap();
        for error in [scores.relative_mae, scores.relative_rmse, scores.relative_bias] {
            assert!(error.is_some_and(|e| (e - 0.25).abs() < 1e-6), "{scores:?}");
        }
        assert!(record.scores.is_none() && record.cost.is_some());
        assert_eq!(record.pictures.keys().copied().collect::<Vec<_>>(), ["color", "error"]);
        assert_eq!(pictures.files.len(), 2);
        let (below, _) = run(&truth, Box::new(Constant([0.5, 0.5, -0.5]))).unwrap();
        assert_eq!(below.radiance.map(|scores| scores.negative_pct), Some(100.0));

        let (shadow, _) = run(&truth, choice.make(&gpu).unwrap()).unwrap();
        assert!(shadow.radiance.is_none() && shadow.scores.is_some(), "visibility is scored as visibility");

        truth.radiance = None;
        let unknown = run(&truth, Box::new(Constant([1.0; 3]))).err().unwrap().to_string();
        assert!(unknown.contains("truth of their radiance"), "{unknown}");
    }
}
