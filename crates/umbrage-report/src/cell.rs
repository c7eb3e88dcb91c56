//! One technique on one light: rendered, scored, timed.

use crate::{
    choice::Choice,
    error::Error,
    given::Given,
    measure::{Frames, is_of_technique},
    pictures::{Pictures, grey, opaque},
    record::{CostRecord, PassRecord, ReferenceRecord, ResultRecord, ScoresRecord},
    source::Source,
    stage::{Actor, Stage},
    truth::{Tracing, Truth},
};
use std::{collections::BTreeMap, time::Duration};
use umbrage::{Gpu, Technique};
use umbrage_core::Image;
use umbrage_metrics::{
    Comparison, Scores, aliasing, around_borders, footprint_colors, heat, reach_of, score, seam, texel_footprint,
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
}

/// A technique's last frame, held against the truth.
pub(crate) struct Scored {
    pub scores: ScoresRecord,
    pub cost: CostRecord,
    visibility: Image<f32>,
    /// For techniques with maps: how large their texels are on the screen.
    footprint: Option<Image<f32>>,
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
        let filled = self.actor(choice).and_then(|actor| {
            stage.act(self.light, actor, |renderer| self.fill(&mut record, renderer, choice, frames, place, &mut shown))
        });
        match filled {
            Ok(_) => pictures.files.append(&mut shown.files),
            Err(error) => record.fail(&error),
        }
        record
    }

    /// The technique of a choice, where it can do the light.
    pub(crate) fn actor(&self, choice: &Choice) -> Result<Actor, Error> {
        choice.supports(self.source.scene.lights[self.light].shape.kind())?;
        Actor::of(choice, self.gpu)
    }

    fn fill(
        &self,
        record: &mut ResultRecord,
        renderer: &mut Renderer,
        choice: &Choice,
        frames: u32,
        place: &str,
        pictures: &mut Pictures,
    ) -> Result<(), Error> {
        let Scored { scores, cost, visibility, footprint } = self.scored(renderer, frames)?;
        (record.scores, record.cost) = (Some(scores), Some(cost));
        let error = heat(&visibility, &self.truth.visibility, &self.truth.mask);
        let name = format!("{place}-{}", choice.label());
        record.pictures = BTreeMap::from([
            ("color", pictures.add(&format!("{name}-color"), &opaque(&renderer.color()?))?),
            ("visibility", pictures.add(&format!("{name}-visibility"), &grey(&visibility))?),
            ("error", pictures.add(&format!("{name}-error"), &error)?),
        ]);
        if let Some(footprint) = footprint {
            record.aliasing = aliasing(&footprint, &self.truth.mask).map(Into::into);
            let picture = pictures.add(&format!("{name}-aliasing"), &footprint_colors(&footprint))?;
            record.pictures.insert("aliasing", picture);
        }
        Ok(())
    }

    /// Measures up to `frames` of the technique on stage, and scores the last.
    pub(crate) fn scored(&self, renderer: &mut Renderer, frames: u32) -> Result<Scored, Error> {
        let frames = Frames::measure(renderer, &self.source.scene.camera, frames, TIME_LIMIT)?;
        let visibility = renderer.visibility(0)?;
        let footprint = self.footprint(renderer);
        let scores = self.score(&visibility, footprint.as_ref().map(reach_of).as_ref())?;
        let scores = ScoresRecord { seam: self.seam(&visibility, renderer)?, ..scores.into() };
        Ok(Scored { scores, cost: cost(&frames, renderer), visibility, footprint })
    }

    /// The record of the truth itself, with the scene shaded under it. Where the GPU fails, that picture is left out:
    /// the techniques' own records say why.
    pub(crate) fn reference(&self, place: &str, pictures: &mut Pictures) -> Result<ReferenceRecord, Error> {
        let Truth { visibility, mask, hard, source, samples, seconds } = self.truth;
        let mut shown = BTreeMap::new();
        if let Ok(color) = self.shade(visibility) {
            shown.insert("color", pictures.add(&format!("{place}-reference-color"), &opaque(&color))?);
        }
        shown.insert("visibility", pictures.add(&format!("{place}-reference-visibility"), &grey(visibility))?);
        if let Some(hard) = hard {
            shown.insert("hard", pictures.add(&format!("{place}-reference-hard"), &grey(hard))?);
        }
        Ok(ReferenceRecord {
            source: source.clone(),
            samples: *samples,
            seconds: *seconds,
            scored_pixels: mask.data.iter().filter(|m| **m).count(),
            hard_mae: hard.as_ref().and_then(|hard| self.score(hard, None).ok()).map(|s| s.mae),
            pictures: shown,
        })
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
        Ok(score(&Comparison { produced, reference: visibility, mask, hard: hard.as_ref(), reach })?)
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
        Ok(Renderer::new(self.gpu, &self.source.scene, width, height, vec![pass])?)
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
