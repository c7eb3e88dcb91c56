//! What techniques that compute a light's covered share exactly have in common: the light's form in a space of its own, and the
//! choice of casters.

mod form;
mod select;
mod uniform;

pub(crate) use form::{Face, Form};
pub(crate) use select::{casters_in_view, is_on_a_caster, may_touch};
pub(crate) use uniform::{Anchor, AreaLight, Frame, scaled};

/// `light.wgsl`: the light as shaders know it.
pub(crate) const AREA_LIGHT: &str = include_str!("light.wgsl");

/// The share of coordinates that a few roundings of single precision come to.
pub(crate) const ROUNDING: f64 = 1e-6;
