//! The techniques of a pane.

use super::{Drawn, Made, Pane, Shared, truth_of};
use crate::stage::Stage;
use umbrage_core::Image;
use umbrage_renderer::LightPass;
use umbrage_report::{Choice, Given, RAY_TRACED};

impl Pane {
    /// Makes the techniques where others are asked for; settings that can be taken over are.
    pub(super) fn make(&mut self, shared: &Shared<'_>, stage: &mut Stage, drawn: &Drawn) -> Result<(), String> {
        let numbers: Vec<usize> = drawn.lights.iter().map(|(number, _)| *number).collect();
        if let Some(made) = &self.made
            && (&made.technique, &made.numbers, made.truth) == (&drawn.pane.technique, &numbers, truth_of(drawn))
        {
            return Ok(());
        }
        let text = |e: &dyn std::fmt::Display| e.to_string();
        let mut passes = Vec::new();
        if drawn.pane.technique == RAY_TRACED {
            for &number in &numbers {
                let traced = shared.truth.iter().find(|t| t.light == number && t.visibility.size() == drawn.size);
                let nothing = Image::filled(drawn.size.0, drawn.size.1, 0.0);
                let picture = traced.map_or(&nothing, |traced| &traced.visibility);
                let technique = Box::new(Given::new(shared.gpu, picture).map_err(|e| text(&e))?);
                passes.push(LightPass { light: number, technique });
            }
        } else {
            let choice = Choice::parse(shared.registry, &drawn.pane.technique, &[]).map_err(|e| text(&e))?;
            for (number, light) in &drawn.lights {
                choice.supports(light.shape.kind()).map_err(|e| text(&e))?;
                if self.took_over(&choice, stage, &numbers)? {
                    break;
                }
                passes.push(LightPass { light: *number, technique: choice.make(shared.gpu).map_err(|e| text(&e))? });
            }
            if let (Some(made), true) = (&mut self.made, passes.is_empty()) {
                made.technique.clone_from(&drawn.pane.technique);
                return Ok(());
            }
        }
        let lights = stage.renderer.make_lights(passes).map_err(|e| text(&e))?;
        let technique = drawn.pane.technique.clone();
        if self.made.as_ref().is_none_or(|made| made.technique != technique) {
            self.history.clear();
        }
        self.made = Some(Made { technique, numbers, lights, truth: truth_of(drawn) });
        Ok(())
    }

    /// True where the techniques that are there took the settings over.
    fn took_over(&mut self, choice: &Choice, stage: &mut Stage, numbers: &[usize]) -> Result<bool, String> {
        let Some(made) = self.made.as_mut().filter(|made| made.numbers == numbers) else { return Ok(false) };
        let is_same = made.technique.split(':').next() == Some(choice.info.id);
        if !is_same || choice.light_samples.is_some() || made.technique.contains(umbrage_report::LIGHT_SAMPLES) {
            return Ok(false);
        }
        stage.renderer.exchange_lights(&mut made.lights).map_err(|e| e.to_string())?;
        let taken =
            (0..numbers.len()).try_for_each(|pass| stage.renderer.set_settings(pass, &choice.settings).map(|_| ()));
        stage.renderer.exchange_lights(&mut made.lights).map_err(|e| e.to_string())?;
        taken.map_err(|e| e.to_string())?;
        Ok(true)
    }
}
