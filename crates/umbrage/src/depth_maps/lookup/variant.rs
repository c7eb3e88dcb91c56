//! What the pipelines of a look-up differ in.

use crate::depth_maps::layers::Layers;

/// What pipelines are made for.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Variant {
    /// The light turns the same side to all.
    pub round: bool,
    pub perspective: bool,
    pub warped: bool,
    pub layout: Layers,
    pub linear: bool,
    pub has_normals: bool,
    /// Splits stand still.
    pub steady: bool,
}

impl Variant {
    /// Those of the shader.
    pub fn constants(self) -> [(&'static str, f64); 8] {
        let on = |switch: bool| if switch { 1.0 } else { 0.0 };
        [
            ("ROUND", on(self.round)),
            ("PERSPECTIVE", on(self.perspective)),
            ("WARPED", on(self.warped)),
            ("LAYOUT", self.layout.number()),
            ("LAYERS", f64::from(self.layout.count())),
            ("STEADY", on(self.steady)),
            ("LINEAR", on(self.linear)),
            ("HAS_NORMALS", on(self.has_normals)),
        ]
    }
}
