//! Parameters of techniques whose texels are smaller near the camera.

use crate::params::{Param, ParamKind, Settings};
use umbrage_core::glam::DVec4;
use umbrage_core::light_view::Warp;

/// The technique that looks warped maps up.
pub(crate) const WARPED_FILTER: Param = Param {
    name: "filter",
    help: "The technique that looks the map up, with its own defaults but for the parameters that are set here.",
    unit: "",
    kind: ParamKind::Choice { values: &["pcf", "shadow-map", "pcf-jitter", "pcf-blur", "vsm", "evsm", "msm", "esm"] },
};

/// Of `pcf` as the filter of another technique.
pub(crate) const FILTER_KERNEL: Param = Param {
    name: "kernel",
    help: "Of `pcf`, see there.",
    unit: "",
    kind: ParamKind::Choice { values: &["2x2", "3", "5", "7", "disc"] },
};

/// Declared by `psm`.
pub(crate) const SHIFT: Param = Param {
    name: "shift",
    help: "How far the virtual camera stands behind the real one: as far as makes texels smallest on the screen, or not at all.",
    unit: "",
    kind: ParamKind::Choice { values: &["auto", "off"] },
};

/// Declared by `psm`.
pub(crate) const NEAR_PLANE: Param = Param {
    name: "near-plane",
    help: "Least distance of the virtual camera's near plane, which is at the nearest receiver if that is farther.",
    unit: "m",
    kind: ParamKind::Float { min: 0.0, max: 1e12, default: 0.0 },
};

/// Declared by `psm`.
pub(crate) const CUBE: Param = Param {
    name: "cube",
    help: "One map for every side of the post-perspective cube that the light's rays leave by, for spots and parallel light.",
    unit: "",
    kind: ParamKind::Switch { default: false },
};

/// Declared by `lispsm`.
pub(crate) const STRENGTH: Param = Param {
    name: "strength",
    help: "How strong the warp is: 1 gives errors of the projection the same size near and far, 0 a uniform map.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 100.0, default: 1.0 },
};

/// Declared by `plane-optimal`.
pub(crate) const PLANE: Param = Param {
    name: "plane",
    help: "The plane that the map is made for: the better one of that which most of the picture shows and the ground, or the level one at `height`.",
    unit: "",
    kind: ParamKind::Choice { values: &["auto", "level"] },
};

/// Declared by `plane-optimal`.
pub(crate) const HEIGHT: Param = Param {
    name: "height",
    help: "Of the level plane.",
    unit: "m",
    kind: ParamKind::Float { min: -1e12, max: 1e12, default: 0.0 },
};

/// Declared by `plane-optimal`.
pub(crate) const GIVE_WAY: Param = Param {
    name: "give-way",
    help: "Warps less than is best for the plane where that makes texels smaller in the whole picture.",
    unit: "",
    kind: ParamKind::Switch { default: true },
};

/// By the parameters that a technique declares.
pub(super) fn warp(settings: &Settings) -> Option<Warp> {
    if settings.has(SHIFT.name) {
        let shift = settings.choice(SHIFT.name) == "auto";
        return Some(Warp::PostPerspective {
            shift,
            near: settings.float(NEAR_PLANE.name),
            cube: settings.switch(CUBE.name),
        });
    }
    if settings.has(PLANE.name) {
        let level = DVec4::Y - DVec4::W * settings.float(HEIGHT.name);
        let plane = (settings.choice(PLANE.name) == "level").then_some(level);
        return Some(Warp::Plane { plane, gives_way: settings.switch(GIVE_WAY.name) });
    }
    settings.has(STRENGTH.name).then(|| Warp::LightSpace { strength: settings.float(STRENGTH.name) })
}
