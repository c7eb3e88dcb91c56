//! What the laboratory does by itself: what moves, and what is measured.

use crate::app::Lab;
use crate::stage::Stage;
use crate::state::State;
use crate::yardstick::{Of, Yardstick};
use umbrage_report::{CameraPath, Moving};

impl Lab {
    /// The state with the camera and the lights where they are in its frame.
    pub(crate) fn seen(&self) -> State {
        self.stage.as_ref().map_or_else(|| self.state.clone(), |stage| stage.seen(&self.state))
    }

    /// While casters move, the truth waits until they stand.
    pub(crate) fn truth_waits(&self) -> bool {
        let is_animated = self.stage.as_ref().is_some_and(Stage::is_animated);
        self.face.plays && (is_animated || self.state.moving.moves(Moving::Casters))
    }

    /// Shows a frame of a motion and of a way of the camera.
    pub fn set_motion(&mut self, moving: Moving, path: Option<CameraPath>, frame: u32) {
        (self.state.moving, self.state.path, self.state.frame) = (moving, path, frame);
    }

    /// How many times the floor the technique of the active pane takes, once it was measured.
    pub fn times_floor(&self) -> Option<f64> {
        self.ratios.as_ref().map(|(_, ratios)| ratios.floor)
    }

    /// Starts to measure the active pane against the least that any technique can cost.
    pub(crate) fn start_to_measure(&mut self) {
        let Some(stage) = &self.stage else { return };
        let Some(of) = Of::new(&self.state, self.face.active) else { return };
        match Yardstick::new(&self.gpu, &self.registry, stage, of) {
            Ok(yardstick) => self.yardstick = Some(yardstick),
            Err(error) => self.face.say(error),
        }
    }

    /// Continues with that, a frame at a time.
    pub(crate) fn measure(&mut self) {
        let (Some(mut yardstick), Some(stage)) = (self.yardstick.take(), &mut self.stage) else { return };
        let is_of_now = Of::new(&self.state, self.face.active).as_ref() == Some(&yardstick.of);
        if !is_of_now {
            return;
        }
        let seen = stage.seen(&self.state);
        match (yardstick.go_on(stage, &seen), yardstick.found()) {
            (Err(error), _) | (_, Some(Err(error))) => self.face.say(error),
            (_, Some(Ok(ratios))) => self.ratios = Some((yardstick.of, ratios)),
            _ => self.yardstick = Some(yardstick),
        }
    }
}
