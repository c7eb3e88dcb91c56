//! The technique's parameters as types.

use crate::params::Settings;
use crate::silhouettes::{Extrude, Part};

/// From where shadows are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Count {
    /// From the eye, starting with the shadows that the eye is in.
    ZPassEye,
    /// From the eye for casters that can't shadow it, from infinity for others.
    Auto,
    /// From infinity.
    ZFail,
    /// From the eye, starting with 0.
    ZPass,
    /// From the eye, and only whether the number is odd.
    Xor,
}

impl Count {
    /// All that may be drawn.
    pub fn parts(self) -> &'static [Part] {
        match self {
            Self::ZPassEye | Self::Auto => &Part::ALL,
            Self::ZFail => &[Part::FailSides, Part::Caps],
            Self::ZPass | Self::Xor => &[Part::PassSides],
        }
    }
}

/// Where shadows end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// Behind everything that is seen.
    Scene,
    /// Nowhere.
    Infinite,
    /// Where the light does.
    Finite,
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
}

impl Options {
    /// Shadows end where the light does.
    pub fn is_finite(&self) -> bool {
        self.reach == Reach::Finite
    }

    pub fn of(settings: &Settings) -> Self {
        let two_pass = settings.choice("stencil") == "two-pass";
        let cull = settings.choice("cull");
        let culls = |name| cull == "all" || cull == name;
        Self {
            count: match settings.choice("count") {
                "auto" => Count::Auto,
                "z-fail" => Count::ZFail,
                "z-pass" => Count::ZPass,
                "xor" => Count::Xor,
                _ => Count::ZPassEye,
            },
            extrude: match settings.choice("extrude") {
                "vertex" => Extrude::Vertex,
                "cpu" => Extrude::Cpu,
                _ => Extrude::Compute,
            },
            counter: match settings.choice("counter") {
                "float" => Some(CounterKind::Float),
                "auto" if !two_pass => None,
                _ => Some(CounterKind::Stencil),
            },
            two_pass,
            reach: match settings.choice("reach") {
                "infinite" => Reach::Infinite,
                "finite" => Reach::Finite,
                _ => Reach::Scene,
            },
            cull: Cull { light: culls("light"), view: culls("view"), caps: culls("caps"), scissor: culls("scissor") },
            depth_bounds: settings.switch("depth-bounds"),
            quads: settings.choice("parallel") == "quads",
            budget: settings.int("budget").max(0) as usize,
            unseen: settings.switch("unseen"),
        }
    }
}
