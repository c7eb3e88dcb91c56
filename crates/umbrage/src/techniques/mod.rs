//! The techniques that are built in: each is its folder and its line here, and nothing else.
//!
//! Thin things on a floor under a low sphere light, each technique at its defaults:
//!
#![doc = include_str!("gallery.txt")]

use crate::technique::TechniqueInfo;

/// Declares the modules of the techniques and lists them.
macro_rules! techniques {
    ($($id:ident,)*) => {
        $(pub mod $id;)*
        /// All that are built in, in the order in which they are best explained.
        pub(crate) static BUILT_IN: &[&TechniqueInfo] = &[$(&$id::INFO,)*];
    };
}

techniques![
    none,
    shadow_map,
    silhouette_map,
    pcf,
    pcf_jitter,
    pcf_blur,
    pcss,
    pcss_jitter,
    vsm,
    evsm,
    msm,
    esm,
    cascaded,
    psm,
    lispsm,
    plane_optimal,
    linear_light,
    smoothies,
    projective,
    projective_fake,
    volume,
    wedges,
    light_mask,
];

/// What looks up the maps of splits and warps where nothing is said.
pub(crate) const DEFAULT_FILTER: &TechniqueInfo = &pcf::INFO;

/// A value of a parameter that has become a technique of its own.
#[derive(Clone, Copy, Debug)]
pub struct Renamed {
    /// Id of the technique that had it.
    pub technique: &'static str,
    /// The parameter.
    pub param: &'static str,
    /// The value, which the parameter no longer takes.
    pub value: &'static str,
    /// Id of the technique that it is now.
    pub to: &'static str,
}

/// Old names of techniques, which are still understood where users write names.
pub const RENAMED: &[Renamed] =
    &[Renamed { technique: "wedges", param: "combine", value: "bitmask", to: "light-mask" }];
