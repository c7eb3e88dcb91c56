//! What the layers of a map are.

use super::setup::Blend;
use crate::shader::HostConstant;
use umbrage_core::light_view::{CUBE_SIDES, Omni};

/// Most layers of a light's maps: as many as there may be splits.
pub const MOST_LAYERS: usize = umbrage_core::splits::MOST_SPLITS;

/// Layers that one look-up reads: those of two points with the sides of a cube each.
pub(super) const LOOKUP_LAYERS: usize = 2 * CUBE_SIDES as usize;

/// Names of the pictures inside, one a layer.
pub const LAYER_NAMES: [&str; MOST_LAYERS] =
    ["map-0", "map-1", "map-2", "map-3", "map-4", "map-5", "map-6", "map-7", "map-8"];

/// What the layers of a map are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layers {
    /// One view.
    #[default]
    Single,
    /// Directions from the light.
    Omni(Omni),
    /// So many parts of what the camera sees.
    Splits(u32),
    /// Sides of a post-perspective cube: a receiver is in any layer that covers it.
    Sides,
}

impl From<Option<Omni>> for Layers {
    fn from(omni: Option<Omni>) -> Self {
        omni.map_or(Self::Single, Self::Omni)
    }
}

impl Layers {
    /// Layers of the map.
    pub fn count(self) -> u32 {
        match self {
            Self::Single => 1,
            Self::Omni(omni) => omni.layers(),
            Self::Splits(count) => count,
            Self::Sides => CUBE_SIDES,
        }
    }

    /// `LAYOUT` in `lookup/map_layers.wgsl`.
    pub(super) const fn number(self) -> f64 {
        match self {
            Self::Single => 0.0,
            Self::Omni(Omni::Cube) => 1.0,
            Self::Omni(Omni::Tetrahedral) => 2.0,
            Self::Omni(Omni::DualParaboloid) => 3.0,
            Self::Splits(_) => 4.0,
            Self::Sides => 5.0,
        }
    }
}

impl Blend {
    /// `BLEND` in `lookup/map_layers.wgsl`.
    pub(super) const fn number(self) -> f64 {
        match self {
            Self::Off => 0.0,
            Self::Dither => 1.0,
            Self::Lerp => 2.0,
        }
    }
}

/// What `lookup/map_layers.wgsl` calls the limit and the kinds of layers and blends.
pub(super) const LAYER_CONSTANTS: &[HostConstant] = &[
    ("MOST_LAYERS", MOST_LAYERS as f64),
    ("LOOKUP_LAYERS", LOOKUP_LAYERS as f64),
    ("SINGLE", Layers::Single.number()),
    ("CUBE", Layers::Omni(Omni::Cube).number()),
    ("TETRAHEDRON", Layers::Omni(Omni::Tetrahedral).number()),
    ("PARABOLOIDS", Layers::Omni(Omni::DualParaboloid).number()),
    ("SPLITS", Layers::Splits(1).number()),
    ("SIDES", Layers::Sides.number()),
    ("DITHER", Blend::Dither.number()),
    ("LERP", Blend::Lerp.number()),
];
