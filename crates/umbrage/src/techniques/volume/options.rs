//! The technique's parameters as types.

use crate::silhouettes::{Extrude, Part};
use crate::{Masked, choices, settings};

/// What users type.
pub(super) const ID: &str = "volume";

choices! {
    /// From where shadows are counted.
    pub enum Count {
        /// From the eye, starting with the shadows that the eye is in.
        ZPassEye = "z-pass-eye",
        /// From the eye for casters that can't shadow it, from infinity for others.
        Auto = "auto",
        /// From infinity.
        ZFail = "z-fail",
        /// From the eye, starting with 0.
        ZPass = "z-pass",
        /// From the eye, and only whether the number is odd.
        Xor = "xor",
    }
}

choices! {
    /// What counts.
    pub enum Counter {
        /// Stencil where the casters can't have 256 layers, floats elsewhere.
        Auto = "auto",
        /// Eight bits of stencil.
        Stencil = "stencil",
        /// Floats.
        Float = "float",
    }
}

choices! {
    /// Whether the stencil counts fronts and backs at once.
    pub enum Stencil {
        /// At once.
        TwoSided = "two-sided",
        /// One after the other.
        TwoPass = "two-pass",
    }
}

choices! {
    /// Where shadows end.
    pub enum Reach {
        /// Behind everything that is seen.
        Scene = "scene",
        /// Nowhere.
        Infinite = "infinite",
        /// Where the light does.
        Finite = "finite",
    }
}

choices! {
    /// What is left out because it changes nothing.
    pub enum Culls {
        /// Everything that can be.
        All = "all",
        /// Nothing.
        None = "none",
        /// Casters that the light does not reach.
        Light = "light",
        /// Casters that shadow nothing in view.
        View = "view",
        /// Caps out of view.
        Caps = "caps",
        /// Pixels beyond the light.
        Scissor = "scissor",
    }
}

choices! {
    /// Sides of parallel light.
    pub enum Parallel {
        /// Triangles that meet infinitely far away.
        Triangles = "triangles",
        /// Quads and dark caps, as for other lights.
        Quads = "quads",
    }
}

impl Count {
    /// All that may be drawn.
    pub(super) fn parts(self) -> &'static [Part] {
        match self {
            Self::ZPassEye | Self::Auto => &Part::ALL,
            Self::ZFail => &[Part::FailSides, Part::Caps],
            Self::ZPass | Self::Xor => &[Part::PassSides],
        }
    }
}

settings! {
    /// Settings of shadow volumes.
    pub struct Volume {
        #[flatten] masked: Masked,
        /// Where counting the shadows of a point starts: at the eye, with the number of shadows
        /// that the eye is in (`z-pass-eye`); at the eye where a caster cannot shadow it, otherwise
        /// at infinity (`auto`); at infinity (`z-fail`); at the eye, with 0 (`z-pass`, wrong where
        /// the eye is in shadow); or only whether the number is odd (`xor`, wrong where shadows
        /// overlap).
        count: Count = Count::ZPassEye,
        /// Where silhouettes are found: in compute shaders, in vertex shaders that visit every
        /// edge, or on the CPU.
        extrude: Extrude = Extrude::Compute,
        /// What counts: 8 bits of stencil, which take 256 shadows on one point for none; floats,
        /// which hold any number; or stencil where the casters cannot have 256 layers, and floats
        /// elsewhere.
        counter: Counter = Counter::Auto,
        /// Whether the stencil counts front and back faces in one pass or in two.
        stencil: Stencil = Stencil::TwoSided,
        /// Where shadows end: behind everything visible, nowhere, or where the light does (the
        /// picture is the same, visibility beyond the light's range is not).
        reach: Reach = Reach::Scene,
        /// What is left out because it changes nothing: everything that can be, nothing, or one
        /// kind: casters that the light does not reach, casters that shadow nothing in view, caps
        /// out of view, or pixels beyond the light (the light's range matters with `reach =
        /// finite`).
        cull: Culls = Culls::All,
        /// Counts nothing at points beyond the light's range, at the cost of one more pass over the
        /// depth (`reach = finite`).
        depth_bounds: bool = false,
        /// Sides of parallel light: triangles that meet at infinity, or quads and dark caps as for
        /// other lights.
        parallel: Parallel = Parallel::Triangles,
        /// At most this many casters have shadows, the most important ones by size on the screen; 0
        /// means all.
        budget: u32 = 0, in 0..=1_000_000, unit "casters",
        /// For hosts that cull faces or hide casters from the camera: counts all casters from
        /// infinity, with both sides of meshes.
        unseen: bool = false,
    }
}

/// What counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CounterKind {
    Stencil,
    Float,
}

/// What is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cull {
    pub light: bool,
    pub view: bool,
    pub caps: bool,
    pub scissor: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Options {
    pub count: Count,
    pub extrude: Extrude,
    /// `None`: what is safe.
    pub counter: Option<CounterKind>,
    pub two_pass: bool,
    pub reach: Reach,
    pub cull: Cull,
    pub depth_bounds: bool,
    pub quads: bool,
    /// 0: no limit.
    pub budget: usize,
    pub unseen: bool,
    /// Casters with alpha masks are looked up in maps.
    pub leaves_masked: bool,
}

impl Options {
    /// Shadows end where the light does.
    pub fn is_finite(&self) -> bool {
        self.reach == Reach::Finite
    }

    pub fn of(settings: &Volume) -> Self {
        let two_pass = settings.stencil == Stencil::TwoPass;
        let culls = |what| settings.cull == Culls::All || settings.cull == what;
        Self {
            count: settings.count,
            extrude: settings.extrude,
            counter: match settings.counter {
                Counter::Float => Some(CounterKind::Float),
                Counter::Auto if !two_pass => None,
                Counter::Auto | Counter::Stencil => Some(CounterKind::Stencil),
            },
            two_pass,
            reach: settings.reach,
            cull: Cull {
                light: culls(Culls::Light),
                view: culls(Culls::View),
                caps: culls(Culls::Caps),
                scissor: culls(Culls::Scissor),
            },
            depth_bounds: settings.depth_bounds,
            quads: settings.parallel == Parallel::Quads,
            budget: settings.budget as usize,
            unseen: settings.unseen,
            leaves_masked: settings.masked.leaves_out(),
        }
    }
}
