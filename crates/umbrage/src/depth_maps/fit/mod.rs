//! From a light to the views that its maps are drawn from.

mod border;
mod views;

use super::frame::MapFrame;
use crate::view::View;
use border::light_border;
use umbrage_core::light_view::{FitScene, Focus};
use umbrage_core::{glam::DVec3, scene_tree::Sphere};
pub(super) use views::Views;

/// Fits views to what there is in each frame.
pub(super) struct Fitter {
    pub choice: Views,
    /// Keeps room for the light's extent.
    pub soft: bool,
    /// Whose boxes those of the casters are, and when: the buffer of their instances and
    /// [`crate::casters::Moves::now`].
    scene_of: Option<(wgpu::Buffer, u64)>,
}

/// Most boxes that stand for all casters in a fit, and for all receivers that are seen.
const MOST_BOXES: usize = 256;

const EVERYWHERE: Sphere = Sphere { center: DVec3::ZERO, radius: f64::INFINITY };

impl Fitter {
    pub fn new(choice: Views) -> Self {
        Self { choice, soft: false, scene_of: None }
    }

    /// Chooses the views of this frame; none where there is no light or nothing to cast a shadow.
    pub fn prepare(&mut self, view: &View<'_>, is_linear: bool, frame: &mut MapFrame) {
        self.gather(view, &mut frame.scene);
        frame.views.clear();
        frame.borders.clear();
        if !view.light.casts || frame.scene.casters.is_empty() {
            return;
        }
        self.choice.fit(view, frame.border_texels, frame);
        frame.soft_texels = 0.0;
        if self.soft && !frame.views.is_empty() {
            frame.soft_texels = light_border(&frame.views, &frame.scene.casters, &view.light.shape);
            self.choice.fit(view, frame.border_texels + frame.soft_texels, frame);
        }
        frame.overlap = self.choice.overlap();
        frame.softness_m = self.choice.softness_m();
        frame.is_warped = self.choice.is_warped() && !frame.is_from_a_point();
        frame.is_linear = is_linear && frame.is_from_a_point();
    }

    /// The boxes that views are fitted to.
    fn gather(&mut self, view: &View<'_>, scene: &mut FitScene) {
        let FitScene { casters, receivers, around } = scene;
        *around = view.casters.all_bounds();
        let now = view.casters.moves().now();
        if self.scene_of.as_ref().is_none_or(|(of, then)| (of, *then) != (&view.casters.instances, now)) {
            casters.clear();
            view.casters.casting().cut(&EVERYWHERE, MOST_BOXES, casters);
            self.scene_of = Some((view.casters.instances.clone(), now));
        }
        receivers.clear();
        let receiving = view.casters.receiving();
        match self.choice.focus() {
            Focus::Light => receiving.cut(&EVERYWHERE, MOST_BOXES, receivers),
            Focus::Visible => receiving.cut(&view.camera.frustum(), MOST_BOXES, receivers),
        }
    }
}
