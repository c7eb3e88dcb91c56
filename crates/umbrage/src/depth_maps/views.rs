//! Which views of a light a technique renders.

use super::{DepthMaps, MOST_LAYERS};
use crate::{params::Settings, shader::HostConstant, view::View};
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

/// What happens where one split gives way to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Blend {
    Off,
    Dither,
    Lerp,
}

impl Blend {
    /// `BLEND` in `lookup/map_layers.wgsl`.
    pub(super) const fn number(self) -> f64 {
        self as u8 as f64
    }
}

/// Share of a split over which it gives way to the next one.
const OVERLAP: f64 = 0.1;

/// Borders of steady views are whole multiples of so many texels: soft ones would change in every frame.
const STEADY_BORDER: f64 = 8.0;

impl Views {
    pub(super) fn of(settings: &Settings) -> Self {
        let blend = match settings.choice("blend") {
            "dither" => Blend::Dither,
            "lerp" => Blend::Lerp,
            _ => Blend::Off,
        };
        let cover = match (settings.switch("stabilize"), settings.choice("fit")) {
            (true, _) => {
                Cover::Steady { step_texels: (settings.float("margin") * settings.int("size") as f64).max(1.0) }
            }
            (false, "frustum") => Cover::Part,
            (false, _) => Cover::Receivers,
        };
        let cascades = Cascades {
            count: usize::try_from(settings.int("splits")).unwrap_or(0),
            lambda: settings.float("lambda"),
            overlap: if blend == Blend::Off { 0.0 } else { OVERLAP },
            distance: settings.float("distance"),
            cover,
        };
        Self {
            focus: if settings.choice("focus") == "light" { Focus::Light } else { Focus::Visible },
            omni: super::params::omni(settings),
            cascades: (cascades.count > 0).then_some(cascades),
            warp: super::warped::warp(settings),
            blend,
            softness_m: settings.float("radius-m"),
            depth_fit: settings.switch("depth-fit"),
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
