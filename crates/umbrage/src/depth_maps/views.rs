//! Which views of a light a technique renders.

use super::{Blend, DepthMaps, Fitting, MOST_LAYERS, MapSetup, Softness, Splits};
use crate::{shader::HostConstant, view::View};
use umbrage_core::light_view::{
    CUBE_SIDES, Cascades, Cover, Fit, Focus, LightView, Omni, Warp, fit, fit_cascades, fit_warped,
};

/// How views are chosen.
pub(super) struct Views {
    focus: Focus,
    omni: Omni,
    /// For techniques that split what the camera sees.
    cascades: Option<Cascades>,
    /// For techniques whose texels are smaller near the camera.
    warp: Option<Warp>,
    blend: Blend,
    /// Radius of filters, metres; 0 where it is in texels.
    softness_m: f64,
    depth_fit: bool,
}

impl Blend {
    /// `BLEND` in `lookup/map_layers.wgsl`.
    pub(super) const fn number(self) -> f64 {
        match self {
            Self::Off => 0.0,
            Self::Dither => 1.0,
            Self::Lerp => 2.0,
        }
    }
}

/// Borders of steady views are whole multiples of so many texels: soft ones would change in every frame.
const STEADY_BORDER: f64 = 8.0;

impl Views {
    pub(super) fn of(setup: &MapSetup) -> Self {
        let none = Self {
            focus: Focus::Visible,
            omni: Omni::Cube,
            cascades: None,
            warp: None,
            blend: Blend::Off,
            softness_m: if let Softness::Metres(radius) = setup.softness { radius } else { 0.0 },
            depth_fit: false,
        };
        match setup.fitting {
            Fitting::One { focus, omni } => Self { focus, omni, ..none },
            Fitting::Splits(Splits { cascades, blend, depth_fit }) => {
                Self { cascades: Some(cascades), blend, depth_fit, ..none }
            }
            Fitting::Warp(warp) => Self { warp: Some(warp), ..none },
        }
    }

    /// What the light's maps cover.
    pub(super) fn focus(&self) -> Focus {
        self.focus
    }

    /// Texels of parallel light need not be all of one size.
    pub(super) fn is_warped(&self) -> bool {
        self.warp.is_some()
    }

    /// How one split gives way to the next.
    pub(super) fn blend(&self) -> Blend {
        self.blend
    }

    /// How what the camera sees is split.
    pub(super) fn cascades(&self) -> Option<&Cascades> {
        self.cascades.as_ref()
    }

    /// Splits are fitted to visible depths on the GPU, where they need not stand still.
    pub(super) fn is_fitted_to_depth(&self) -> bool {
        self.depth_fit && self.cascades.is_some_and(|c| !matches!(c.cover, Cover::Steady { .. }))
    }

    /// Radius of filters, metres; 0 where it is in texels.
    pub(super) fn softness_m(&self) -> f64 {
        self.softness_m
    }

    /// Share of a split over which it gives way to the next one.
    pub(super) fn overlap(&self) -> f64 {
        self.cascades.map_or(0.0, |c| c.overlap)
    }
}

impl DepthMaps {
    /// Fits the views of this frame.
    pub(super) fn fit(&mut self, view: &View<'_>, border_texels: f64) {
        let (focus, omni) = (self.choice.focus, self.choice.omni);
        let mut to_fit = Fit { focus, omni, size: self.size, border_texels, border_m: self.choice.softness_m };
        let (light, camera, views) = (&view.light.shape, &view.camera, &mut self.views);
        if let Some(warp) = &self.choice.warp {
            let omni = fit_warped(light, camera, &self.scene, warp, &to_fit, views);
            let has_sides = omni.is_none() && matches!(warp, Warp::PostPerspective { cube: true, .. });
            self.layout = if has_sides { Layers::Sides } else { omni.into() };
            return;
        }
        let Some(cascades) = &self.choice.cascades else {
            self.layout = fit(light, &camera.frustum(), &self.scene, &to_fit, views).into();
            return;
        };
        if let Cover::Steady { .. } = cascades.cover {
            to_fit.border_texels = (border_texels / STEADY_BORDER).ceil() * STEADY_BORDER;
        }
        if self.choice.is_fitted_to_depth() {
            // One view of all that is seen, to be cropped to each part on the GPU.
            let whole = Cascades { count: 1, overlap: 0.0, ..*cascades };
            let omni = fit_cascades(light, camera, &self.scene, &whole, &to_fit, views, &mut self.borders);
            self.layout = omni.into();
            if let (false, Some(whole)) = (self.borders.is_empty(), views.pop()) {
                let count = cascades.count as u32;
                views.extend((0..count).map(|layer| LightView { layer, ..whole.clone() }));
                self.layout = Layers::Splits(count);
            }
            self.borders.clear();
            return;
        }
        let omni = fit_cascades(light, camera, &self.scene, cascades, &to_fit, views, &mut self.borders);
        self.layout = if self.borders.is_empty() { omni.into() } else { Layers::Splits(self.borders.len() as u32 - 1) };
    }
}

/// What `lookup/map_layers.wgsl` calls the limit and the kinds of layers and blends.
pub(super) const LAYER_CONSTANTS: &[HostConstant] = &[
    ("MOST_LAYERS", MOST_LAYERS as f64),
    ("SINGLE", Layers::Single.number()),
    ("CUBE", Layers::Omni(Omni::Cube).number()),
    ("TETRAHEDRON", Layers::Omni(Omni::Tetrahedral).number()),
    ("PARABOLOIDS", Layers::Omni(Omni::DualParaboloid).number()),
    ("SPLITS", Layers::Splits(1).number()),
    ("SIDES", Layers::Sides.number()),
    ("DITHER", Blend::Dither.number()),
    ("LERP", Blend::Lerp.number()),
];

/// What the layers of a map are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layers {
    /// One view.
    Single,
    /// Directions from the light.
    Omni(Omni),
    /// So many parts of what the camera sees.
    Splits(u32),
    /// Sides of a post-perspective cube: a receiver is in any layer that covers it.
    Sides,
}

impl From<Option<Omni>> for Layers {
    fn from(omni: Option<Omni>) -> Self {
        omni.map_or(Self::Single, Self::Omni)
    }
}

impl Layers {
    /// Layers of the map.
    pub(crate) fn count(self) -> u32 {
        match self {
            Self::Single => 1,
            Self::Omni(omni) => omni.layers(),
            Self::Splits(count) => count,
            Self::Sides => CUBE_SIDES,
        }
    }

    /// `LAYOUT` in `lookup/map_layers.wgsl`.
    pub(super) const fn number(self) -> f64 {
        match self {
            Self::Single => 0.0,
            Self::Omni(Omni::Cube) => 1.0,
            Self::Omni(Omni::Tetrahedral) => 2.0,
            Self::Omni(Omni::DualParaboloid) => 3.0,
            Self::Splits(_) => 4.0,
            Self::Sides => 5.0,
        }
    }
}
