//! From a light to the views that its maps are drawn from.

mod border;
mod views;

use super::frame::MapFrame;
use crate::view::View;
use border::light_border;
use umbrage_core::light_view::{FitScene, Focus};
use umbrage_core::{Bounds, glam::DVec3, scene_tree::Sphere};
pub(super) use views::Views;

/// Fits views to what there is in each frame.
pub(super) struct Fitter {
    pub choice: Views,
    /// Keeps room for the light's extent.
    pub soft: bool,
    /// How far apart the points of the light are whose shadows end on each other's maps, metres;
    /// 0 where there is one.
    pub apart_m: f64,
    /// Whose boxes those of the casters are, and when: [`crate::Casters::version`] and
    /// [`crate::casters::Moves::now`].
    scene_of: Option<(u64, u64)>,
}

/// Most boxes that stand for all casters in a fit, and for all receivers that are seen.
const MOST_BOXES: usize = 256;

const EVERYWHERE: Sphere = Sphere { center: DVec3::ZERO, radius: f64::INFINITY };

impl Fitter {
    pub fn new(choice: Views) -> Self {
        Self { choice, soft: false, apart_m: 0.0, scene_of: None }
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
        let now = (view.casters.version(), view.casters.moves().now());
        if self.scene_of != Some(now) {
            casters.clear();
            view.casters.casting().cut(&EVERYWHERE, MOST_BOXES, casters);
            casters.extend(view.casters.host_bounds());
            sort(casters);
            self.scene_of = Some(now);
        }
        self.choice.margin_m = margin(view, casters, self.apart_m);
        receivers.clear();
        let receiving = view.casters.receiving();
        match self.choice.focus() {
            Focus::Light => receiving.cut(&EVERYWHERE, MOST_BOXES, receivers),
            Focus::Visible => receiving.cut(&self.choice.seen(view), MOST_BOXES, receivers),
        }
        receivers.extend(view.casters.receiving_in());
        sort(receivers);
    }
}

/// Boxes in an order of their own, whatever order casters came in.
fn sort(boxes: &mut [Bounds]) {
    let key = |b: &Bounds| [b.min.to_array(), b.max.to_array()];
    boxes.sort_unstable_by(|a, b| {
        let pairs = key(a).into_iter().flatten().zip(key(b).into_iter().flatten());
        pairs.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
}

/// How far the shadow of a blocker may move on a receiver while the light moves by `apart_m`: as
/// much farther as the receiver is behind the nearest caster, and no farther than the scene is
/// wide.
fn margin(view: &View<'_>, casters: &[Bounds], apart_m: f64) -> f64 {
    let light = view.light.shape.center();
    if apart_m == 0.0 || light.w == 0.0 {
        return 0.0;
    }
    let seen = view.seen();
    if seen.is_empty() {
        return 0.0;
    }
    let light = light.truncate();
    let nearest = casters.iter().map(|b| light.distance(light.clamp(b.min, b.max))).fold(f64::INFINITY, f64::min);
    let farthest = seen.corners().iter().map(|c| light.distance(*c)).fold(0.0, f64::max);
    (apart_m * (farthest / nearest - 1.0).max(0.0)).min(view.casters.all_bounds().size().length())
}
