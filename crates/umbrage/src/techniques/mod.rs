//! The registry: a technique is its folder and its line here, and nothing else.

use crate::{error::Error, error::nearest, technique::TechniqueInfo};

/// Declares the modules of the techniques and lists them.
macro_rules! techniques {
    ($($id:ident,)*) => {
        $(pub mod $id;)*
        static TECHNIQUES: &[&TechniqueInfo] = &[$(&$id::INFO,)*];
    };
}

techniques![
    none,
    shadow_map,
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
    volume,
    wedges,
    light_mask,
];

/// All techniques, in the order in which they are best explained.
pub fn techniques() -> &'static [&'static TechniqueInfo] {
    TECHNIQUES
}

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

/// Old names of techniques, which those who read names from users go on to understand.
pub const RENAMED: &[Renamed] =
    &[Renamed { technique: "wedges", param: "combine", value: "bitmask", to: "light-mask" }];

/// The technique that users call `id`.
///
/// # Errors
/// [`Error::Unknown`] with the nearest id.
pub fn find(id: &str) -> Result<&'static TechniqueInfo, Error> {
    TECHNIQUES.iter().find(|t| t.id == id).copied().ok_or_else(|| Error::Unknown {
        what: "technique",
        name: id.into(),
        nearest: nearest(id, TECHNIQUES.iter().map(|t| t.id)),
    })
}
