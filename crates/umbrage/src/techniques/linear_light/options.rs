//! Settings.

use crate::depth_maps::{Bias, Cover, Covers, Depth, Faces, Held, Layout, MapSetup, Softness};
use crate::{choices, settings};

choices! {
    /// What shadow borders are taken from.
    pub enum Edges {
        /// The edges of casters, found by compute.
        Silhouettes = "silhouettes",
        /// Steps of depth in the maps.
        Map = "map",
    }
}

choices! {
    /// How a share of the light is found between a blocker and the border of its shadow.
    pub enum Shares {
        /// By where the way past the blocker meets the light.
        Exact = "exact",
        /// Linear between both, as the text has it.
        Linear = "linear",
    }
}

settings! {
    /// See the module.
    pub struct LinearLight {
        /// Width and height of each map. Each point of the light has a map for every side that it
        /// shines to.
        size: u32 = 1024, in 1..=16384, unit "texels",
        /// Points of the light that have maps, its ends among them. More cut the light in pieces:
        /// a gap that shows the middle of a piece but neither of its ends counts as dark.
        samples: u32 = 2, in 2..=64,
        /// What penumbras begin at: the edges of casters that bound shadows, or steps of depth in
        /// the maps. Alpha masks have steps and no edges.
        edges: Edges = Edges::Silhouettes,
        /// How the share of the light is found in a penumbra with `edges = map`: by where the way
        /// from the receiver past the blocker meets the light, or linear from the blocker to the
        /// border of its shadow, which is the same where blocker, light, receiver and map are
        /// parallel.
        shares: Shares = Shares::Exact,
        /// How far a blocker is in front of the receiver at least, as a share of its distance from
        /// the light, and how far off both planes: less belongs to one surface.
        threshold: f64 = 0.005, in 0.0001..=1.0,
        /// What the maps cover: the receivers that the camera sees and those that penumbras reach
        /// them from, or everything that the light reaches (which is steady under a moving camera).
        focus: Covers = Covers::Visible,
        /// Keeps maps and penumbras for as long as their views stay the same and nothing moves that
        /// they show.
        cache: bool = true,
        /// Multiplies the automatic depth bias. It is for experiments; 1 is right.
        bias: f64 = 1.0, in 0.0..=100.0,
    }
}

impl LinearLight {
    /// The maps of each point of the light.
    pub(super) fn setup(&self) -> MapSetup {
        MapSetup {
            size: self.size,
            faces: Faces::Front,
            depth: Depth::Projective,
            cache: self.cache,
            bias: Bias::Auto(self.bias),
            fitting: Cover { omni: Layout::Cube, focus: self.focus }.fitting(),
            softness: Softness::Own,
            held: Held::All,
        }
    }
}
