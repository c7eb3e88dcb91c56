//! The techniques that are built in: each is its folder and its line here, and nothing else.
//!
//! Thin things on a floor under a low sphere light, each technique at its defaults:
//!
#![doc = include_str!("gallery.txt")]

use crate::technique::TechniqueInfo;

/// Declares the modules of the techniques and lists them. A family that hosts may leave out of the
/// list is a feature of the crate: what is neither in it nor named is nowhere in their program.
macro_rules! techniques {
    ($($(#[cfg(feature = $feature:literal)])? $id:ident,)*) => {
        $(pub mod $id;)*
        /// All that are built in, in the order in which they are best explained.
        pub(crate) static BUILT_IN: &[&TechniqueInfo] = &[$($(#[cfg(feature = $feature)])? &$id::INFO,)*];
        /// Modules of those that are left out, and the features that bring them.
        pub(crate) static LEFT_OUT: &[(&str, &str)] =
            &[$($(#[cfg(not(feature = $feature))] (stringify!($id), $feature),)?)*];
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
    #[cfg(feature = "moment-maps")]
    vsm,
    #[cfg(feature = "moment-maps")]
    evsm,
    #[cfg(feature = "moment-maps")]
    msm,
    #[cfg(feature = "moment-maps")]
    esm,
    #[cfg(feature = "fitted-maps")]
    cascaded,
    #[cfg(feature = "fitted-maps")]
    psm,
    #[cfg(feature = "fitted-maps")]
    lispsm,
    #[cfg(feature = "fitted-maps")]
    plane_optimal,
    linear_light,
    smoothies,
    #[cfg(feature = "projected")]
    projective,
    #[cfg(feature = "projected")]
    projective_fake,
    #[cfg(feature = "volumes")]
    volume,
    #[cfg(feature = "area-lights")]
    wedges,
    #[cfg(feature = "area-lights")]
    light_mask,
];

pub mod prt;

/// Those that answer with radiance, in the same order.
pub(crate) static OF_RADIANCE: &[&TechniqueInfo] = &[&prt::INFO];

/// What looks up the maps of splits and warps where nothing is said.
pub(crate) const DEFAULT_FILTER: &TechniqueInfo = &pcf::INFO;

/// What looks up maps of casters with alpha masks beside hard techniques, and beside soft ones.
pub(crate) const HARD_FILTER: &TechniqueInfo = &shadow_map::INFO;
pub(crate) const SOFT_FILTER: &TechniqueInfo = &pcss::INFO;

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
