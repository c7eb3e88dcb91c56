//! What choosing casters goes by: camera, light and what is seen, the same for all of them.

use super::options::Options;
use crate::casters::{MeshEdges, Placed, largest_stretch};
use crate::view::{View, off_ties};
use umbrage_core::glam::{DVec3, DVec4};
use umbrage_core::shadow_hull::{self, Convex};
use umbrage_core::{Bounds, Frustum};

/// See the module.
pub(super) struct Situation<'a> {
    pub view: &'a View<'a>,
    pub options: &'a Options,
    /// The light's centre, moved by rounding's width.
    pub light: DVec4,
    /// How far rounding moves things, metres.
    pub rounding: f64,
    pub frustum: Frustum,
    /// A box around the eye and what is in front of the near plane.
    pub around_eye: Bounds,
    /// What surely holds every point that shadows the viewport, where depth is clipped at the near
    /// plane.
    pyramid: Option<Convex>,
    pub is_parallel_view: bool,
    /// Shadows end where the light does.
    pub range: Option<f64>,
    /// A box around everything that rays from the eye can end at, and the eye.
    seen: Bounds,
    /// How far from the light that box reaches; not for parallel light.
    pub farthest: Option<f64>,
}

impl<'a> Situation<'a> {
    /// Without `clamps`, volumes are clipped at the near plane.
    pub fn new(view: &'a View<'a>, options: &'a Options, clamps: bool) -> Self {
        let camera = &view.camera;
        let rounding = view.rounding();
        let light = off_ties(view.light.shape.center(), rounding);
        let around_eye = view.around_eye().grown(rounding);
        let seen = view.seen().union(around_eye).grown(4.0 * rounding);
        let distance = |corner: DVec3| corner.distance(light.truncate());
        Self {
            view,
            options,
            light,
            rounding,
            frustum: Frustum::of(&camera.clip_from_world()),
            around_eye,
            pyramid: (!clamps).then(|| shadow_hull::occlusion_pyramid(camera, light)),
            is_parallel_view: camera.is_parallel(),
            range: view.light.range.filter(|_| options.is_finite() && light.w != 0.0),
            seen,
            farthest: (light.w != 0.0).then(|| seen.corners().map(distance).into_iter().fold(0.0, f64::max)),
        }
    }

    /// True where depth is clipped, so that counts would have to start at the near plane, pixel by
    /// pixel.
    pub fn is_clipped(&self) -> bool {
        self.pyramid.is_some()
    }

    /// False where the box surely shadows neither the eye nor, where that matters, a point of the
    /// near plane.
    pub fn may_shadow_eye(&self, bounds: &Bounds) -> bool {
        match &self.pyramid {
            Some(pyramid) => pyramid.may_touch(bounds),
            None => shadow_hull::segment_touches(self.view.camera.eye, self.light, bounds, self.rounding),
        }
    }

    /// The side of the box around all that is seen where the caster's shadow may end, see
    /// [`shadow_hull::shadow_end`].
    pub fn end_of(&self, bounds: &Bounds) -> DVec4 {
        shadow_hull::shadow_end(&self.seen, bounds, self.light)
    }

    /// A box around the shadow of a caster's box on a plane that [`Situation::end_of`] gave.
    pub fn shadow_on(&self, bounds: &Bounds, end: DVec4) -> Bounds {
        let normal = end.truncate();
        let dark = bounds.corners().map(|p| {
            let away = p * self.light.w - self.light.truncate();
            p + away * ((end.w - normal.dot(p)) / normal.dot(away)).max(0.0)
        });
        Bounds::of(dark).grown(self.rounding)
    }

    /// How far away from the light corners of the shadow have to lie so that no triangle between
    /// them cuts into the light's range (the gaps of PX figure 3.7); 0, infinitely far, where the
    /// caster is so near that this is very far.
    pub fn finite_reach(&self, range: f64, placed: &Placed, mesh: &MeshEdges) -> f64 {
        let light = self.light.truncate();
        let near = light.clamp(placed.bounds.min, placed.bounds.max).distance(light);
        let longest_edge = if placed.posed {
            placed.bounds.size().length()
        } else {
            mesh.adjacency.longest_edge * largest_stretch(&placed.world_from_mesh.matrix3)
        };
        let half_edge = 0.5 * longest_edge;
        // A triangle whose edges are seen under an angle fits into a cone that is 2 / √3 times as
        // wide.
        let half_angle = (half_edge / near).asin() * 2.0 / 3.0_f64.sqrt();
        if half_angle < 1.3 { range / half_angle.cos() * 1.001 } else { 0.0 }
    }
}

pub(super) fn common(a: &Bounds, b: &Bounds) -> Bounds {
    Bounds { min: a.min.max(b.min), max: a.max.min(b.max) }
}
