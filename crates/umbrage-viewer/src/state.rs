//! What the laboratory shows: all that a permalink holds, and that undo goes back to.

use serde::{Deserialize, Serialize};
use umbrage_core::{Camera, Light};
use umbrage_report::{CameraPath, Moving};

/// A state of the laboratory.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The scene, as users name it.
    pub scene: String,
    /// Where it is seen from.
    pub camera: Camera,
    /// The lights of the scene, as they were changed.
    pub lights: Vec<Light>,
    /// How far animations have moved on, seconds.
    pub time_s: f64,
    /// What moves, as in the bench.
    pub moving: Moving,
    /// The camera's way, as in the bench.
    pub path: Option<CameraPath>,
    /// The frame of both that is shown.
    pub frame: u32,
    /// Only this light shines; `None`: all do.
    pub light: Option<usize>,
    /// What is seen, one to four of them.
    pub panes: Vec<PaneState>,
    /// How panes lie on the screen.
    pub layout: Layout,
    /// Where the bar between two panes lies, as a share of the width, 0 to 1.
    pub split: f32,
    /// Errors are shown so many times as strong as they are.
    pub gain: f32,
    /// Values that are black and white in pictures of numbers; `None`: as the picture has them.
    pub range: Option<[f32; 2]>,
    /// The camera that looks on from outside while that of the scene stays.
    pub observer: Option<Camera>,
    /// Pixels of the window for each pixel of the picture; `None`: as the adapter needs it.
    pub divisor: Option<u32>,
}

/// What one pane shows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PaneState {
    /// The technique with its settings, as the command line has it, or `ray-traced`.
    pub technique: String,
    /// `color`, `visibility`, `error`, …, or a view into the technique.
    pub picture: String,
}

/// How panes lie on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// Beside and below each other.
    #[default]
    Grid,
    /// The first two in one place, with a bar between them.
    Split,
    /// The first two in one place, one after the other.
    Blink,
}

impl Layout {
    /// All of them, with the names users see.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::Grid, "side by side"), (Self::Split, "split bar"), (Self::Blink, "blink")];
}

/// The picture that is shown where none is asked for.
pub(crate) const COLOR: &str = "color";
/// The share of the light that each point sees.
pub(crate) const VISIBILITY: &str = "visibility";
/// Visibility less that of the truth.
pub(crate) const ERROR: &str = "error";
/// Pictures that a comparison makes, not `umbrage render`.
pub(crate) const COMPARED: [&str; 3] = [ERROR, "flip", "texel-size"];
/// Pictures that any technique has, with what they show.
pub(crate) const PICTURES: [(&str, &str); 7] = [
    (COLOR, "The shaded scene"),
    (VISIBILITY, "The share of the light that each point sees: black in the umbra, white in full light"),
    (ERROR, "Visibility less the truth's: red where light leaks in, blue where shadow is false"),
    ("flip", "FLIP: how much somebody sees who flips between the picture and the truth"),
    ("texel-size", "How many pixels of the screen a texel of the map covers: white at 2, red where it is large"),
    ("depth", "Distance along the view: near is white"),
    ("normal", "Normals of surfaces as colours"),
];

/// Pictures that the observer looks at; the others are those of the frozen camera.
pub(crate) fn is_overlooked(picture: &str) -> bool {
    [COLOR, VISIBILITY, ERROR].contains(&picture)
}

impl PaneState {
    /// The shaded scene under a technique.
    pub fn new(technique: &str) -> Self {
        Self { technique: technique.into(), picture: COLOR.into() }
    }

    /// The id of the technique without its settings.
    pub fn id(&self) -> &str {
        self.technique.split(':').next().unwrap_or_default()
    }
}

impl Default for State {
    /// The first built-in scene under one technique.
    fn default() -> Self {
        Self {
            scene: umbrage_core::scenes::SCENES[0].id.into(),
            camera: Camera::default(),
            lights: Vec::new(),
            time_s: 0.0,
            moving: Moving::None,
            path: None,
            frame: 0,
            light: Some(0),
            panes: vec![PaneState::new("pcf")],
            layout: Layout::default(),
            split: 0.5,
            gain: 4.0,
            range: None,
            observer: None,
            divisor: None,
        }
    }
}

impl State {
    /// The numbers of the lights that shine.
    pub fn shining(&self) -> Vec<usize> {
        match self.light {
            Some(light) => vec![light],
            None => (0..self.lights.len()).collect(),
        }
    }

    /// The light that pictures of one light show.
    pub fn main_light(&self) -> Option<&Light> {
        self.lights.get(self.light.unwrap_or_default())
    }

    /// The camera that pictures are taken from.
    pub fn eye(&self) -> &Camera {
        self.observer.as_ref().unwrap_or(&self.camera)
    }
}
