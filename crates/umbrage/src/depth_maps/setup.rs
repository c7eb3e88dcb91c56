//! What techniques with maps are asked for: the settings that they share, and what one technique
//! hands to another.

use crate::{choices, settings};
use umbrage_core::light_view::{Cascades, Focus, Omni, Warp};

choices! {
    /// Which surface a map holds.
    pub enum Faces {
        /// The nearest one.
        Front = "front",
        /// The nearest that faces away from the light; for closed meshes only.
        Back = "back",
        /// The middle between the nearest two.
        Midpoint = "midpoint",
    }
}

choices! {
    /// What a map covers.
    pub enum Covers {
        /// What the camera sees of the receivers.
        Visible = "visible",
        /// All that the light reaches, steady under a moving camera.
        Light = "light",
    }
}

choices! {
    /// The maps of a light that shines to all sides.
    pub enum Layout {
        /// Six faces of a cube.
        Cube = "cube",
        /// Two paraboloids.
        DualParaboloid = "dual-paraboloid",
        /// Four faces of a tetrahedron.
        Tetrahedral = "tetrahedral",
    }
}

choices! {
    /// What maps seen from a point store.
    pub enum Depth {
        /// Near plane over distance, as the projection has it.
        Projective = "projective",
        /// A depth that falls linearly with the distance.
        Linear = "linear",
    }
}

choices! {
    /// What keeps a surface from shadowing itself.
    pub enum Offset {
        /// The receiver's own plane, and what is known of rounding.
        Auto = "auto",
        /// A constant and a multiple of the slope, to be tuned by hand.
        Classic = "classic",
    }
}

settings! {
    /// What every technique with maps has.
    pub struct Map {
        /// Width and height of each map. A light to all sides has several maps, see `omni`.
        size: u32 = 1024, in 1..=16384, unit "texels", live true,
        /// Which surface the map holds: the nearest one, the nearest one that faces away from the
        /// light (closed meshes only), or the middle between the two nearest.
        faces: Faces = Faces::Front,
        /// Keeps a map for as long as its view stays the same, and draws only what moves. With
        /// `focus = light` the view does not depend on the camera.
        cache: bool = true, live true,
        /// Multiplies the automatic depth bias. It is for experiments; 1 is right.
        bias: f64 = 1.0, in 0.0..=100.0, live true,
        /// What keeps a surface from shadowing itself: the receiver's own plane and what is known
        /// of rounding, or, as in the classic texts, a constant and a multiple of the slope, tuned
        /// by hand (ZA 2.3.2; SG "Shadow Mapping").
        offset: Offset = Offset::Auto,
        /// The classic offset's constant part, along the light.
        constant: f64 = 0.01, in 0.0..=1000.0, unit "m", live true,
        /// Its other part: the rise of the receiver over so many texels.
        slope: f64 = 1.0, in 0.0..=100.0, unit "texels", live true,
    }
}

settings! {
    /// What a light's maps cover, where they are neither split nor warped.
    pub struct Cover {
        /// The maps of a light that shines to all sides: six faces of a cube, two paraboloids (for
        /// finely tessellated casters only), or four faces of a tetrahedron.
        omni: Layout = Layout::Cube, live true,
        /// What the map covers: the receivers that the camera sees, or everything that the light
        /// reaches (which is steady under a moving camera).
        focus: Covers = Covers::Visible, live true,
    }
}

settings! {
    /// How depth is stored.
    pub struct Storage {
        /// What maps seen from a point store: near / distance, as the projection gives it, or a
        /// depth that falls linearly with the distance. Maps of parallel light are always linear.
        depth: Depth = Depth::Projective, live true,
    }
}

/// How the views of a light are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fitting {
    /// One view, or one for each side that the light shines to.
    One {
        /// What it covers.
        focus: Focus,
        /// The maps of a light to all sides.
        omni: Omni,
    },
    /// What the camera sees is split by distance.
    Splits(Splits),
    /// Texels are smaller near the camera.
    Warp(Warp),
}

/// How what the camera sees is split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splits {
    /// Where the splits end and what their maps cover.
    pub cascades: Cascades,
    /// How one split passes into the next.
    pub blend: Blend,
    /// Splits are fitted to visible depths on the GPU.
    pub depth_fit: bool,
}

choices! {
    /// Which compares percentage-closer filtering averages.
    pub enum Kernel {
        /// The 2×2 texels that one hardware compare takes.
        Hardware = "2x2",
        /// 3×3 bilinear compares.
        Square3 = "3",
        /// 5×5 bilinear compares.
        Square5 = "5",
        /// 7×7 bilinear compares.
        Square7 = "7",
        /// 4×4 compares, weighted by a cubic B-spline.
        Bicubic = "bicubic",
        /// A Vogel disc.
        Disc = "disc",
    }
}

choices! {
    /// How one split passes into the next.
    pub enum Blend {
        /// Both are looked up and mixed.
        Lerp = "lerp",
        /// By a pattern of pixels.
        Dither = "dither",
        /// At once.
        Off = "off",
    }
}

/// How soft a filter of one width is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Softness {
    /// As the filter's own settings say.
    Own,
    /// In texels: what percentage-closer filters average; others keep their own.
    Texels(Kernel),
    /// A radius in metres, the same in all maps.
    Metres(f64),
}

/// What keeps a surface from shadowing itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bias {
    /// The automatic one, times a factor.
    Auto(f64),
    /// Offsets tuned by hand.
    Classic {
        /// Along the light, metres.
        constant: f64,
        /// The rise of the receiver over so many texels.
        slope: f64,
    },
}

impl Bias {
    /// Of the settings that every technique with maps has.
    fn of(map: &Map) -> Self {
        match map.offset {
            Offset::Auto => Self::Auto(map.bias),
            Offset::Classic => Self::Classic { constant: map.constant, slope: map.slope },
        }
    }

    /// What multiplies all that the look-up forgives.
    pub(super) fn factor(self) -> f64 {
        match self {
            Self::Auto(factor) => factor,
            Self::Classic { .. } => 1.0,
        }
    }

    /// Constant and slope of offsets tuned by hand.
    pub(super) fn offsets(self) -> Option<[f64; 2]> {
        match self {
            Self::Auto(_) => None,
            Self::Classic { constant, slope } => Some([constant, slope]),
        }
    }
}

/// Which casters maps hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Held {
    /// All.
    #[default]
    All,
    /// Those with an alpha mask: the others are another technique's.
    Masked,
}

/// What maps a technique renders: what `cascaded` and the warps hand to their filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSetup {
    /// Texels across and down.
    pub size: u32,
    /// Which surface a map holds.
    pub faces: Faces,
    /// How maps seen from a point store depth.
    pub depth: Depth,
    /// Maps are kept while they stay the same.
    pub cache: bool,
    /// What keeps a surface from shadowing itself.
    pub bias: Bias,
    /// How views are chosen.
    pub fitting: Fitting,
    /// How soft a filter of one width is.
    pub softness: Softness,
    /// Which casters they hold.
    pub held: Held,
}

impl Map {
    /// Maps whose views are chosen by `fitting`.
    pub fn fitted(&self, fitting: Fitting, softness: Softness) -> MapSetup {
        let Self { size, faces, cache, .. } = *self;
        let bias = Bias::of(self);
        MapSetup { size, faces, depth: Depth::Projective, cache, bias, fitting, softness, held: Held::All }
    }

    /// Maps of a light's own view or views.
    pub fn covering(&self, cover: &Cover, depth: Depth) -> MapSetup {
        MapSetup { depth, ..self.fitted(cover.fitting(), Softness::Own) }
    }
}

impl Cover {
    /// One view, or those of a light to all sides.
    pub fn fitting(&self) -> Fitting {
        let focus = match self.focus {
            Covers::Visible => Focus::Visible,
            Covers::Light => Focus::Light,
        };
        let omni = match self.omni {
            Layout::Cube => Omni::Cube,
            Layout::DualParaboloid => Omni::DualParaboloid,
            Layout::Tetrahedral => Omni::Tetrahedral,
        };
        Fitting::One { focus, omni }
    }
}
