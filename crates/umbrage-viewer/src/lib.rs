//! The laboratory: every shadow technique beside the ray-traced truth in one window, native and in
//! the browser.
//!
//! No algorithm is in here and no technique is named: menus, sliders, views and help come from the
//! [`umbrage::Registry`]. [`Lab`] is the laboratory without a window, driven by [`eframe`]; `run`
//! opens the window.

mod app;
mod background;
mod camera;
mod doing;
mod gizmo;
#[cfg(not(target_family = "wasm"))]
mod keep;
mod kinds;
mod later;
mod lessons;
mod link;
mod loupe;
#[cfg(not(target_family = "wasm"))]
mod native;
mod observe;
mod overlay;
mod pace;
mod pane;
mod record;
mod screen;
mod see;
mod show;
mod slow;
mod stage;
mod state;
mod text;
mod truth;
mod ui;
mod undo;
mod walk;
#[cfg(target_family = "wasm")]
pub mod web;
mod yardstick;

pub use app::{Lab, Options};
#[cfg(not(target_family = "wasm"))]
pub use native::{run, setup};
pub use observe::OBSERVE;
pub use see::Reading;
pub use show::SHADER;
pub use state::{Layout, PaneState, State};
pub use walk::Walk;

/// How many times as strong as they are errors can be shown.
pub(crate) const GAINS: [f32; 2] = [1.0, 64.0];
/// Pixels of the window for each pixel of the picture, at most.
pub(crate) const LARGEST_DIVISOR: u32 = 8;
/// Panes, at most.
pub(crate) const MOST_PANES: usize = 4;
