//! What the technique of a pane costs, over the least that any can: measured when asked for, a
//! frame at a time.

use crate::stage::Stage;
use crate::state::State;
use umbrage::{Gpu, Owner, Registry, Technique, baseline};
use umbrage_renderer::{LightPass, Lights};
use umbrage_report::{Choice, Maps};

/// What is measured, as far as it depends on what is shown.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Of {
    pub technique: String,
    pub scene: String,
    pub light: usize,
}

impl Of {
    pub fn new(state: &State, pane: usize) -> Option<Self> {
        let technique = state.panes.get(pane)?.technique.clone();
        Some(Self { technique, scene: state.scene.clone(), light: state.light.unwrap_or_default() })
    }
}

/// What a technique takes over others, all doing the whole of their work in every frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ratios {
    /// Over a pass that reads depth and writes visibility.
    pub floor: f64,
    /// Over maps without bias, with one comparison.
    pub bare_minimum: f64,
}

/// Frames before the measurement, of each: pipelines are made in them.
const WARM_UP: usize = 3;
/// Frames measured, of each.
const FRAMES: usize = 9;

/// The floor, the bare minimum and the technique, which take turns.
pub(crate) struct Yardstick {
    pub of: Of,
    actors: Vec<Actor>,
    turn: usize,
}

struct Actor {
    lights: Lights,
    /// GPU time and preparation of each frame, milliseconds; `None` where no time was kept.
    times_ms: Vec<Option<f64>>,
}

impl Yardstick {
    /// Makes ready what is to be measured.
    pub fn new(gpu: &Gpu, registry: &Registry, stage: &Stage, of: Of) -> Result<Self, String> {
        let text = |e: umbrage_report::Error| e.to_string();
        let choice = Choice::parse(registry, &of.technique, &[]).map_err(text)?;
        let maps = Maps::of(&choice);
        let bare = baseline::bare_minimum(gpu, maps.size, maps.splits).map_err(|e| e.to_string())?;
        let techniques = [baseline::floor(gpu), bare, choice.make(gpu).map_err(text)?];
        let actor = |technique: Box<dyn Technique>| {
            let lights = stage.renderer.make_lights(vec![LightPass { light: of.light, technique }]);
            lights.map(|lights| Actor { lights, times_ms: Vec::new() }).map_err(|e| e.to_string())
        };
        let actors = techniques.into_iter().map(actor).collect::<Result<_, _>>()?;
        Ok(Self { of, actors, turn: 0 })
    }

    /// Draws a frame of whose turn it is.
    pub fn go_on(&mut self, stage: &mut Stage, seen: &State) -> Result<(), String> {
        let count = self.actors.len();
        let actor = &mut self.actors[self.turn % count];
        self.turn += 1;
        let renderer = &mut stage.renderer;
        renderer.exchange_lights(&mut actor.lights).map_err(|e| e.to_string())?;
        if let (Some(of_pass), Some(light)) = (renderer.light_mut(0), seen.lights.get(self.of.light)) {
            of_pass.clone_from(light);
        }
        // What is kept from frame to frame is no work.
        renderer.forget();
        renderer.set_clipping(false);
        let drawn = renderer.frame(seen.eye());
        let times = renderer.times();
        let of_light = times.iter().filter(|time| matches!(time.owner, Owner::Light(_))).map(|time| time.time_ms);
        let gpu_ms: f64 = of_light.sum();
        actor.times_ms.push((!times.is_empty()).then(|| gpu_ms + renderer.prepare_ms()));
        renderer.exchange_lights(&mut actor.lights).map_err(|e| e.to_string())?;
        drawn.map_err(|e| e.to_string())
    }

    /// What came of it, once all is measured.
    pub fn found(&self) -> Option<Result<Ratios, String>> {
        if self.turn < self.actors.len() * (WARM_UP + FRAMES) {
            return None;
        }
        let medians: Vec<Option<f64>> = self.actors.iter().map(|actor| median(&actor.times_ms[WARM_UP..])).collect();
        let [Some(floor), Some(bare), Some(own)] = medians[..] else {
            return Some(Err("this adapter keeps no time of passes, so nothing can be set against another".into()));
        };
        Some(Ok(Ratios { floor: own / floor.max(1e-6), bare_minimum: own / bare.max(1e-6) }))
    }
}

fn median(times_ms: &[Option<f64>]) -> Option<f64> {
    let mut times: Vec<f64> = times_ms.iter().flatten().copied().filter(|time| time.is_finite()).collect();
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_without_a_time_do_not_count() {
        assert_eq!(median(&[Some(3.0), None, Some(1.0), Some(2.0), Some(f64::NAN)]), Some(2.0));
        assert_eq!(median(&[None]), None);
    }
}
