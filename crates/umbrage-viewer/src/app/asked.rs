//! What programs and tests ask of a laboratory, and what they set.

use super::Lab;
use crate::link;
use crate::pane::Pane;
use crate::state::State;
use umbrage::Gpu;

impl Lab {
    /// Messages that are shown.
    pub fn messages(&self) -> Vec<String> {
        self.face.all_messages()
    }

    /// Shows another picture in a pane.
    pub fn set_picture(&mut self, pane: usize, picture: &str) {
        if let Some(pane) = self.state.panes.get_mut(pane) {
            pane.picture = picture.into();
        }
    }

    /// Has another technique work for a pane, written with its settings as on the command line.
    pub fn set_technique(&mut self, pane: usize, technique: &str) {
        if let Some(pane) = self.state.panes.get_mut(pane) {
            pane.technique = technique.into();
        }
    }

    /// The device that everything is drawn with.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Pixels of each pane's picture across and down.
    pub fn picture_size(&self) -> (u32, u32) {
        self.panes.first().map_or((0, 0), Pane::size)
    }

    /// GPU time of the newest frame, all panes together, milliseconds; 0 where the adapter keeps no
    /// time.
    pub fn frame_ms(&self) -> f64 {
        self.panes.iter().flat_map(|pane| &pane.times).map(|time| time.time_ms).sum()
    }

    /// Pixels of the window for each pixel of pictures; `None`: as the adapter can.
    pub fn set_divisor(&mut self, divisor: Option<u32>) {
        self.state.divisor = divisor.map(|divisor| divisor.clamp(1, crate::LARGEST_DIVISOR));
    }

    /// The device is gone: a window has to be opened anew.
    pub fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// All that is seen, as [`crate::Options::state`] takes it; `None` while no scene is open.
    pub fn permalink(&self) -> Option<String> {
        Some(link::write(&self.state, &self.stage.as_ref()?.source.scene))
    }

    /// The command that takes the picture of a pane; `None` while no scene is open.
    pub fn command(&self, pane: usize) -> Option<String> {
        let stage = self.stage.as_ref()?;
        let samples = Some(self.truth_samples().max(1));
        Some(link::command(
            &self.state,
            self.state.panes.get(pane)?,
            &stage.source.scene,
            stage.renderer.size(),
            samples,
        ))
    }

    /// The picture of a pane as it is seen; waits for the device.
    ///
    /// # Errors
    /// [`umbrage::Error::Scene`] where there is no such pane, and what reading gives.
    #[cfg(not(target_family = "wasm"))]
    pub fn picture(&self, pane: usize) -> Result<umbrage_core::Image<[u8; 4]>, umbrage::Error> {
        let none = || umbrage::Error::Scene(format!("there is no pane {pane}"));
        umbrage::read::rgba8(&self.gpu, &self.panes.get(pane).ok_or_else(none)?.texture)
    }

    /// A scene is open, and the panes show it.
    pub fn is_shown(&self) -> bool {
        let is_drawn = |pane: &Pane| pane.error.is_some() || pane.visibility.is_some();
        self.opening.is_none() && self.panes.len() == self.state.panes.len() && self.panes.iter().all(is_drawn)
    }

    /// Rays for each pixel of the truth about the light that is shown, so far.
    pub fn truth_samples(&self) -> u32 {
        self.truth.of(self.state.light.unwrap_or_default()).map_or(0, |truth| truth.samples)
    }

    /// The mean absolute error of a pane against the truth as far as it is known.
    pub fn mae(&self, pane: usize) -> Option<f64> {
        self.panes.get(pane)?.scores.map(|scores| scores.mae)
    }

    /// Why a pane shows no picture.
    pub fn error(&self, pane: usize) -> Option<&str> {
        self.panes.get(pane)?.error.as_deref()
    }

    /// What the laboratory shows.
    pub fn state(&self) -> &State {
        &self.state
    }
}
