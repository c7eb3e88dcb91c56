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
];

/// All techniques, in the order in which they are best explained.
pub fn techniques() -> &'static [&'static TechniqueInfo] {
    TECHNIQUES
}

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
