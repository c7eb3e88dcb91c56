//! Depth maps of a light, for every technique that compares with them. What happens to a light in a
//! frame is in four folders: views are chosen (`fit`), casters are drawn into them (`draw`), passes
//! of a technique's own follow (`stages`), and receivers are compared with what came out
//! (`lookup`). One value goes from each to the next, [`MapFrame`].

mod draw;
mod fit;
mod frame;
mod layers;
mod lookup;
mod nearest;
mod point_maps;
mod setup;
mod stages;
mod technique;
mod texels;

use crate::shader::{Shader, Shared};
pub(crate) use draw::CONTOUR_SHADER;
pub use draw::{CasterPass, EdgeDraw, EdgePass, EdgeTarget};
pub use frame::MapFrame;

pub use layers::{LAYER_NAMES, Layers, MOST_LAYERS};
pub(crate) use lookup::Lookup;
pub(crate) use point_maps::PointMaps;
pub use setup::{
    Bias, Blend, Cover, Covers, Depth, Faces, Fitting, Held, Kernel, Layout, Map, MapSetup, Softness, Splits, Storage,
};
pub use stages::Noise;
pub use stages::Stage;
pub(crate) use stages::{BOUNDS_SHADER, SPLIT_FIT_SHADER, TESTS, TapStage, Taps};
pub use technique::MapTechnique;
pub(crate) use technique::RECEIVER_BYTES;
use umbrage_core::{LightKind, LightKinds};

/// The shaders that render maps, which every technique of this family has.
pub const SHADERS: [Shader; 3] = draw::SHADERS;

/// What the host has to agree on with the modules of this folder.
pub(crate) const SHARED: &[Shared] =
    &[draw::SHARED[0], draw::SHARED[1], draw::SHARED[2], lookup::SHARED, stages::SHARED[0], stages::SHARED[1]];

/// The lights of this family: every kind, soft ones hard from their centre.
pub const LIGHTS: LightKinds = LightKinds::of(&LightKind::ALL);
