//! Which views of a light a technique renders.

use crate::depth_maps::frame::MapFrame;
use crate::depth_maps::layers::Layers;
use crate::depth_maps::setup::{Blend, Fitting, MapSetup, Softness, Splits};
use crate::view::View;
use umbrage_core::Frustum;
use umbrage_core::light_view::{Cascades, Cover, Fit, Focus, LightView, Omni, Warp, fit, fit_cascades, fit_warped};

/// How views are chosen.
pub(in crate::depth_maps) struct Views {
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
    /// How far beyond what the camera sees receivers are covered besides, metres.
    pub margin_m: f64,
}

/// Borders of steady views are whole multiples of so many texels: soft ones would change in every
/// frame.
const STEADY_BORDER: f64 = 8.0;

impl Views {
    pub fn of(setup: &MapSetup) -> Self {
        let none = Self {
            focus: Focus::Visible,
            omni: Omni::Cube,
            cascades: None,
            warp: None,
            blend: Blend::Off,
            softness_m: if let Softness::Metres(radius) = setup.softness { radius } else { 0.0 },
            depth_fit: false,
            margin_m: 0.0,
        };
        match setup.fitting {
            Fitting::One { focus, omni } => Self { focus, omni, ..none },
            Fitting::Splits(Splits { cascades, blend, depth_fit }) => {
                Self { cascades: Some(cascades), blend, depth_fit, ..none }
            }
            Fitting::Warp(warp) => Self { warp: Some(warp), ..none },
        }
    }

    /// The volume that has to be covered with [`Focus::Visible`].
    pub fn seen(&self, view: &View<'_>) -> Frustum {
        let frustum = view.camera.frustum();
        if self.margin_m > 0.0 { frustum.grown(self.margin_m) } else { frustum }
    }

    /// What the light's maps cover.
    pub fn focus(&self) -> Focus {
        self.focus
    }

    /// Texels of parallel light need not be all of one size.
    pub fn is_warped(&self) -> bool {
        self.warp.is_some()
    }

    /// How one split is blended with the next.
    pub fn blend(&self) -> Blend {
        self.blend
    }

    /// How what the camera sees is split.
    pub fn cascades(&self) -> Option<&Cascades> {
        self.cascades.as_ref()
    }

    /// Splits are fitted to visible depths on the GPU, where they need not stand still.
    pub fn is_fitted_to_depth(&self) -> bool {
        self.depth_fit && self.cascades.is_some_and(|c| !matches!(c.cover, Cover::Steady { .. }))
    }

    /// Radius of filters, metres; 0 where it is in texels.
    pub fn softness_m(&self) -> f64 {
        self.softness_m
    }

    /// Share of a split over which it is blended with the next one.
    pub fn overlap(&self) -> f64 {
        self.cascades.map_or(0.0, |c| c.overlap)
    }
}

impl Views {
    /// Fits the views of this frame.
    pub fn fit(&self, view: &View<'_>, border_texels: f64, frame: &mut MapFrame) {
        let (focus, omni) = (self.focus, self.omni);
        let mut to_fit = Fit { focus, omni, size: frame.size, border_texels, border_m: self.softness_m };
        let (light, camera, views) = (&view.light.shape, &view.camera, &mut frame.views);
        if let Some(warp) = &self.warp {
            let omni = fit_warped(light, camera, &frame.scene, warp, &to_fit, views);
            let has_sides = omni.is_none() && matches!(warp, Warp::PostPerspective { cube: true, .. });
            frame.layers = if has_sides { Layers::Sides } else { omni.into() };
            return;
        }
        let Some(cascades) = &self.cascades else {
            frame.layers = fit(light, &self.seen(view), &frame.scene, &to_fit, views).into();
            return;
        };
        if let Cover::Steady { .. } = cascades.cover {
            to_fit.border_texels = (border_texels / STEADY_BORDER).ceil() * STEADY_BORDER;
        }
        if self.is_fitted_to_depth() {
            // One view of all that is seen, to be cropped to each part on the GPU.
            let whole = Cascades { count: 1, overlap: 0.0, ..*cascades };
            let omni = fit_cascades(light, camera, &frame.scene, &whole, &to_fit, views, &mut frame.borders);
            frame.layers = omni.into();
            // Without borders these are the faces of a light to all sides.
            if !frame.borders.is_empty()
                && let Some(whole) = views.pop()
            {
                let count = cascades.count as u32;
                views.extend((0..count).map(|layer| LightView { layer, ..whole.clone() }));
                frame.layers = Layers::Splits(count);
            }
            frame.borders.clear();
            return;
        }
        let omni = fit_cascades(light, camera, &frame.scene, cascades, &to_fit, views, &mut frame.borders);
        frame.layers =
            if frame.borders.is_empty() { omni.into() } else { Layers::Splits(frame.borders.len() as u32 - 1) };
    }
}
