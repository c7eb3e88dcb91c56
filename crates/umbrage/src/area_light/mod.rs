//! What techniques that compute a light's covered share exactly have in common: the light's form in
//! a space of its own, and the choice of casters.

mod form;
mod select;
mod uniform;

use crate::shader::Shared;
pub(crate) use form::{Face, Form, LINE_WIDTH};
pub(crate) use select::{casters_in_view, is_on_a_caster, may_touch};
pub(crate) use uniform::{Anchor, AreaLight, Frame, scaled};

/// What the host has to agree on with `area_light.wgsl`.
pub(crate) const SHARED: Shared =
    Shared { module: "area_light", layouts: &[AreaLight::LAYOUT, Anchor::LAYOUT], constants: form::CONSTANTS };

/// The share of coordinates that a few roundings of single precision amount to.
pub(crate) const ROUNDING: f64 = 1e-6;
