//! A walk through all techniques, one after the other, which says how far each is from the truth:
//! in a browser and on this machine it has to be the same.

use crate::{Lab, PaneState, state::VISIBILITY};
use umbrage::Registry;

/// The scene.
const SCENE: &str = "primitives";
/// Samples of the truth that pictures are compared with.
const SAMPLES: u32 = 16;
/// Pixels of the window for each pixel of the pictures: drivers place edges differently, and the
/// share of pixels beside edges has to be small.
const DIVISOR: u32 = 2;

/// Where the walk is.
#[derive(Debug)]
pub struct Walk {
    /// Techniques to come, the next one last.
    left: Vec<&'static str>,
    now: Option<&'static str>,
    /// Frames since the technique was chosen.
    frames: u32,
    has_begun: bool,
    has_ended: bool,
}

impl Walk {
    /// Before the first technique of the registry.
    pub fn new(registry: &Registry) -> Self {
        let mut left: Vec<_> = registry.techniques().iter().rev().map(|info| info.id).collect();
        // The panel of settings grows with what it shows, and pictures shrink with that: the first
        // of the registry, which has no settings, comes last.
        left.rotate_right(1);
        Self { left, now: None, frames: 0, has_begun: false, has_ended: false }
    }

    /// True after the last one.
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Looks at the laboratory after each frame. Says the size of the pictures, `picture ID MAE
    /// INTERIOR` of each technique or `error ID: WHY`, and `end`.
    pub fn step(&mut self, lab: &mut Lab, mut say: impl FnMut(&str)) {
        if self.has_ended || lab.opening.is_some() {
            return;
        }
        if !self.has_begun {
            self.has_begun = true;
            lab.state.divisor = Some(DIVISOR);
            // Pictures are then as large everywhere: the panel is as wide as its numbers.
            lab.face.shows_text = false;
            if lab.stage.as_ref().is_none_or(|stage| stage.source.asked != SCENE) {
                return lab.open(SCENE);
            }
        }
        self.frames += 1;
        let Some(id) = self.now else { return self.next(lab, say) };
        let Some(pane) = lab.panes.first().filter(|pane| self.frames > 2 && !pane.is_waiting()) else { return };
        let error = pane.error.as_ref().map(|error| format!("error {id}: {error}"));
        let light = lab.state.light.unwrap_or_default();
        let is_traced = lab.truth.of(light).is_some_and(|truth| truth.samples >= SAMPLES || !truth.goes_on);
        let scored = pane.scores.as_ref().filter(|_| is_traced).map(|scores| {
            let interior = scores.interior_pct.unwrap_or(100.0);
            format!("picture {id} {:.5} {interior:.3}", scores.mae)
        });
        if let Some(line) = error.or(scored) {
            say(&line);
            self.next(lab, say);
        }
    }

    fn next(&mut self, lab: &mut Lab, mut say: impl FnMut(&str)) {
        self.now = self.left.pop();
        self.frames = 0;
        let Some(id) = self.now else {
            let (width, height) = lab.panes.first().map_or((0, 0), crate::pane::Pane::size);
            say(&format!("size {width} {height}"));
            say("end");
            self.has_ended = true;
            return;
        };
        lab.state.panes = vec![PaneState { technique: id.into(), picture: VISIBILITY.into() }];
        lab.panes.iter_mut().for_each(crate::pane::Pane::forget);
    }
}
