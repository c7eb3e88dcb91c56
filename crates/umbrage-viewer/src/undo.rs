//! Back to earlier states.

use crate::state::State;

/// States kept.
const MOST: usize = 200;

/// The states before this one, and those that were left by going back.
#[derive(Default)]
pub(crate) struct Undo {
    past: Vec<State>,
    future: Vec<State>,
    now: Option<State>,
}

impl Undo {
    /// Keeps `state` as a step, unless it is the newest one.
    pub fn keep(&mut self, state: &State) {
        if self.now.as_ref() == Some(state) {
            return;
        }
        if let Some(before) = self.now.replace(state.clone()) {
            // Another scene has another camera and other lights: nothing leads back.
            if before.scene == state.scene {
                self.past.push(before);
                self.past.drain(..self.past.len().saturating_sub(MOST));
            } else {
                self.past.clear();
            }
            self.future.clear();
        }
    }

    /// The state before.
    pub fn back(&mut self) -> Option<State> {
        let before = self.past.pop()?;
        self.future.extend(self.now.replace(before));
        self.now.clone()
    }

    /// The state that was left by going back last.
    pub fn forward(&mut self) -> Option<State> {
        let next = self.future.pop()?;
        self.past.extend(self.now.replace(next));
        self.now.clone()
    }

    pub fn can_go_back(&self) -> bool {
        !self.past.is_empty()
    }

    pub fn can_go_forward(&self) -> bool {
        !self.future.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(gain: f32) -> State {
        State { gain, ..State::default() }
    }

    #[test]
    fn steps_lead_back_and_forward_until_something_else_is_done() {
        let mut undo = Undo::default();
        [1.0, 2.0, 2.0, 3.0].into_iter().for_each(|gain| undo.keep(&state(gain)));
        assert_eq!(undo.back(), Some(state(2.0)));
        undo.keep(&state(2.0));
        assert_eq!(undo.forward(), Some(state(3.0)));
        assert_eq!((undo.back(), undo.back(), undo.back()), (Some(state(2.0)), Some(state(1.0)), None));
        undo.keep(&state(9.0));
        assert!(!undo.can_go_forward() && undo.can_go_back());
    }

    #[test]
    fn nothing_leads_back_into_another_scene() {
        let mut undo = Undo::default();
        undo.keep(&state(1.0));
        undo.keep(&State { scene: "another".into(), ..state(1.0) });
        assert_eq!(undo.back(), None);
    }
}
