//! The shaders of the one draw and of its pictures.

use super::records::{self, Cut};
use crate::shader::{HostConstant, Module, Shader};

/// What the shaders of this folder need of each other.
const MODULES: &[Module] = &[
    Module { name: "coverage", source: include_str!("coverage.wgsl") },
    Module { name: "record", source: include_str!("record.wgsl") },
    Module { name: "body", source: include_str!("body.wgsl") },
    Module { name: "cell", source: include_str!("cell.wgsl") },
    Module { name: "draw", source: include_str!("draw.wgsl") },
    Module { name: "cuts", source: include_str!("cuts.wgsl") },
    Module { name: "resolve", source: include_str!("resolve.wgsl") },
    Module { name: "term_analytic", source: include_str!("term_analytic.wgsl") },
    Module { name: "term_table", source: include_str!("term_table.wgsl") },
    Module { name: "term_picture", source: include_str!("term_picture.wgsl") },
];

const GROUP: HostConstant = ("GROUP", records::GROUP as f64);

/// One that needs modules of this folder.
pub(super) const fn shader(name: &'static str, source: &'static str) -> Shader {
    Shader::new(name, source).with_modules(MODULES)
}

pub(super) const MAKE: Shader =
    shader("make wedges", include_str!("make.wgsl")).with_constants(&[("Wedge", records::RECORD as f64), GROUP]);

pub(super) const BUNDLE: Shader = shader("bundle wedges", include_str!("bundle.wgsl")).with_constants(&[
    ("Bundle", records::BUNDLE_RECORD as f64),
    ("BUNDLE", records::BUNDLE as f64),
    GROUP,
    ("WINDOW", records::WINDOW as f64),
]);

pub(super) const CAPS: Shader =
    shader("make caps", include_str!("caps.wgsl")).with_constants(&[("Cap", records::CAP_RECORD as f64)]);

/// Adds up what is covered; shares come from a formula, a table for discs, or a table for one
/// picture.
pub(super) const DRAWS: [Shader; 3] = [
    shader("wedges", "// needs: draw, term_analytic").with_constants(&[GROUP]),
    shader("wedges by table", "// needs: draw, term_table"),
    shader("wedges of a picture", "// needs: draw, term_picture"),
];

/// Makes up for what wedges lack of casters that the light touches.
pub(super) const CUTS: [Shader; 3] = [
    shader("cut casters", "// needs: cuts, term_analytic").with_layouts(&[Cut::LAYOUT]),
    shader("cut casters by table", "// needs: cuts, term_table"),
    shader("cut casters of a picture", "// needs: cuts, term_picture"),
];

/// From shares to visibility.
pub(super) const RESOLVE: Shader = shader("wedge visibility", include_str!("horizon_analytic.wgsl"));

/// The same of a picture, whose share below the horizon comes from its table.
pub(super) const RESOLVE_PICTURE: Shader =
    shader("wedge visibility of a picture", include_str!("horizon_picture.wgsl"));

/// The receivers' depth at the scale of the buffer of shares.
pub(super) const DEPTH: Shader = shader("depth of wedges", include_str!("depth.wgsl"));

/// Colours of every pixel's numbers; an entry for each view.
pub(super) const VIEWS: Shader = shader("views of wedges", include_str!("views.wgsl"));

/// Bodies of wedges as numbers. What an edge crosses goes by the formula whatever is asked for,
/// since it is the same.
pub(super) const VIEW_BODIES: Shader = shader("bodies of wedges", include_str!("view_bodies.wgsl"));
