//! Parameters shared by all techniques with maps.

use crate::params::{Param, ParamKind, Settings};
use umbrage_core::light_view::Omni;

/// Texels of a map.
pub(crate) const SIZE: Param = Param {
    name: "size",
    help: "Width and height of a map; a light to all sides has several, see `omni`.",
    unit: "texels",
    kind: ParamKind::Int { min: 1, max: 16384, default: 1024 },
};

/// Surfaces in a map.
pub(crate) const FACES: Param = Param {
    name: "faces",
    help: "Which surface the map holds: the nearest one, the nearest that faces away (closed meshes only), or the \
           middle between the nearest two.",
    unit: "",
    kind: ParamKind::Choice { values: &["front", "back", "midpoint"] },
};

/// What maps cover.
pub(crate) const FOCUS: Param = Param {
    name: "focus",
    help: "What the map covers: what the camera sees of the receivers, or all that the light reaches (steady under a \
           moving camera).",
    unit: "",
    kind: ParamKind::Choice { values: &["visible", "light"] },
};

/// For experiments.
pub(crate) const BIAS: Param = Param {
    name: "bias",
    help: "Multiplies the automatic depth bias; for experiments, 1 is right.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 100.0, default: 1.0 },
};

/// Layout for lights to all sides.
pub(crate) const OMNI: Param = Param {
    name: "omni",
    help: "The maps of a light that shines to all sides: six faces of a cube, two paraboloids (finely tessellated casters only) or \
           four faces of a tetrahedron.",
    unit: "",
    kind: ParamKind::Choice { values: &["cube", "dual-paraboloid", "tetrahedral"] },
};

/// Depth in maps seen from a point.
pub(crate) const DEPTH: Param = Param {
    name: "depth",
    help: "What maps seen from a point store: near / distance as the projection has it, or a depth that falls linearly with \
           the distance. Maps of parallel light are linear.",
    unit: "",
    kind: ParamKind::Choice { values: &["projective", "linear"] },
};

/// Keeping maps.
pub(crate) const CACHE: Param = Param {
    name: "cache",
    help: "Keeps a map while its view stays the same and draws only what moves; see `focus` for views that stay.",
    unit: "",
    kind: ParamKind::Switch { default: true },
};

/// What [`OMNI`] is set to.
pub(super) fn omni(settings: &Settings) -> Omni {
    match settings.choice("omni") {
        "dual-paraboloid" => Omni::DualParaboloid,
        "tetrahedral" => Omni::Tetrahedral,
        _ => Omni::Cube,
    }
}
