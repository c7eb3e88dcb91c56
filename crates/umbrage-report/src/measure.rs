//! Times of repeated frames.

use crate::spread::Spread;
use std::time::{Duration, Instant};
use umbrage::{Error, Owner, PassTime};
use umbrage_core::Camera;
use umbrage_renderer::Renderer;

/// What some frames of one renderer took.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frames {
    frame_ms: Vec<f64>,
    prepare_ms: Vec<f64>,
    change_ms: Vec<f64>,
    /// What changing casters took before the next frame, where they are.
    pub changed_ms: Option<f64>,
    passes: Vec<Vec<PassTime>>,
}

impl Frames {
    /// Renders a frame, waits for it and keeps its times.
    pub(crate) fn add(&mut self, renderer: &mut Renderer, camera: &Camera) -> Result<(), Error> {
        let start = Instant::now();
        renderer.frame(camera)?;
        renderer.wait()?;
        self.frame_ms.push(start.elapsed().as_secs_f64() * 1e3);
        self.prepare_ms.push(renderer.prepare_ms());
        self.change_ms.extend(self.changed_ms.take().map(|ms| ms + renderer.record_casters_ms()));
        self.passes.push(renderer.times());
        Ok(())
    }

    /// A frame to warm up, then up to `count` frames, fewer where they take longer than `limit`
    /// together. Each does all of the work, as if nothing had been drawn before.
    pub(crate) fn measure(
        renderer: &mut Renderer,
        camera: &Camera,
        count: u32,
        limit: Duration,
    ) -> Result<Self, Error> {
        let start = Instant::now();
        let mut warm_up = Self::default();
        renderer.forget();
        warm_up.add(renderer, camera)?;
        // A frame that took the whole time alone is measurement enough, its pipelines aside.
        let mut frames = Self::default();
        while frames.frame_ms.is_empty() || frames.count() < count && start.elapsed() < limit {
            renderer.forget();
            frames.add(renderer, camera)?;
        }
        Ok(frames)
    }

    pub(crate) fn count(&self) -> u32 {
        self.frame_ms.len() as u32
    }

    /// All of them together.
    pub(crate) fn spent(&self) -> Duration {
        Duration::from_secs_f64(self.frame_ms.iter().sum::<f64>() * 1e-3)
    }

    /// Whole frames, milliseconds.
    pub(crate) fn frame(&self) -> Spread {
        Spread::of(self.frame_ms.iter().copied())
    }

    /// The CPU time of preparing techniques, milliseconds.
    pub(crate) fn prepare(&self) -> Spread {
        Spread::of(self.prepare_ms.iter().copied())
    }

    /// The CPU time of changing casters and of recording that, milliseconds; `None` where they did
    /// not change.
    pub(crate) fn change(&self) -> Option<Spread> {
        (!self.change_ms.is_empty()).then(|| Spread::of(self.change_ms.iter().copied()))
    }

    /// GPU time of each pass, in the order in which they were recorded. Passes of one name in a
    /// frame are added up; one that a frame left out took no time.
    pub(crate) fn passes(&self) -> Vec<(Owner, String, Spread)> {
        let mut names: Vec<(Owner, &str)> = Vec::new();
        for time in self.passes.iter().flatten() {
            if !names.contains(&(time.owner, &time.pass)) {
                names.push((time.owner, &time.pass));
            }
        }
        let of = |(owner, pass): (Owner, &str)| {
            let is_it = |t: &&PassTime| t.owner == owner && t.pass == pass;
            let times = self.passes.iter().map(|frame| frame.iter().filter(is_it).map(|t| t.time_ms).sum());
            (owner, pass.to_string(), Spread::of(times))
        };
        names.into_iter().map(of).collect()
    }

    /// GPU time of the technique's passes together; `None` where the adapter keeps no time.
    pub(crate) fn technique(&self) -> Option<Spread> {
        let sum = |frame: &Vec<PassTime>| frame.iter().filter(|t| is_of_technique(t.owner)).map(|t| t.time_ms).sum();
        let timed = self.passes.iter().any(|frame| !frame.is_empty());
        timed.then(|| Spread::of(self.passes.iter().map(sum)))
    }
}

/// Passes of a light are its technique's; others are the renderer's own.
pub(crate) fn is_of_technique(owner: Owner) -> bool {
    matches!(owner, Owner::Light(_))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_of_one_name_are_added_up_and_missing_ones_take_no_time() {
        let pass = |light, pass: &str, time_ms| PassTime { owner: Owner::Light(light), pass: pass.into(), time_ms };
        let passes = vec![
            vec![pass(0, "blur", 1.0), pass(0, "blur", 2.0), pass(1, "blur", 8.0)],
            vec![pass(0, "blur", 4.0), pass(0, "blur", 3.0)],
        ];
        let found = Frames { passes, ..Frames::default() }.passes();
        let medians: Vec<_> = found.iter().map(|(owner, pass, time)| (*owner, &**pass, time.median)).collect();
        assert_eq!(medians, [(Owner::Light(0), "blur", 5.0), (Owner::Light(1), "blur", 4.0)]);
    }
}
