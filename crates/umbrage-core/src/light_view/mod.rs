//! Light-space fits: the views that a map technique renders.
//!
//! One perspective view for a spot, one orthographic view for a directional light, and several for
//! lights that shine to all sides, see [`Omni`]. With [`Focus::Visible`] each view is cropped to
//! what the camera can see of the receivers (Brabec, Annen and Seidel, "Practical Shadow Mapping";
//! SG "Extensions"), so that no texel is spent elsewhere; its near side always reaches back to
//! every caster.

mod cascades;
mod on_screen;
mod paraboloid;
mod parallel;
mod perspective;
mod ray;
mod rect;
mod warp;

use crate::{bounds::Bounds, frustum::Frustum, light::LightShape};
pub use cascades::{Cascades, Cover, fit_cascades};
use glam::{DMat3, DMat4, DVec2, DVec3};
pub use on_screen::{texel_across, texel_on_screen, view_at};
pub use paraboloid::Paraboloid;
pub use warp::{CUBE_SIDES, Warp, fit_warped};

/// One view of a light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightView {
    /// World to the light's clip space; reversed depth: perspective views store near / distance
    /// along the axis, orthographic ones fall linearly from 1 at the nearest caster to 0 at the
    /// farthest receiver; warped ones of parallel light (see [`Warp`]) do so along each ray. For a
    /// paraboloid the perspective view along its axis that [`LightView::paraboloid`] bends.
    pub clip_from_world: DMat4,
    /// Texels across and down.
    pub size: u32,
    /// The layer of the map: see [`Omni`], 0 for a single view.
    pub layer: u32,
    /// `None` where the matrix is all there is.
    pub paraboloid: Option<Paraboloid>,
    /// Of a part of what the camera sees that stands still: texels along the map's borders that are
    /// for filters alone. Inside of them it counts in place of the next part's map, wherever the
    /// parts end. `None` for all other views.
    pub steady_border: Option<f64>,
}

/// How views are fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// What they cover.
    pub focus: Focus,
    /// What lights that shine to all sides get.
    pub omni: Omni,
    /// Texels of the map across and down, at least 1.
    pub size: u32,
    /// Texels kept free at every border, so that filters find neighbours there.
    pub border_texels: f64,
    /// Metres kept free besides; what a spot shows gets none.
    pub border_m: f64,
}

/// What the views of a light cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// What the camera can see of the receivers.
    Visible,
    /// All that the light can reach: the scene, the spot's cone, all sides.
    Light,
}

/// The views of a light that shines to all sides, and which layer of the map each direction belongs
/// to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Omni {
    /// Six faces: +X, −X, +Y, −Y, +Z, −Z. A direction belongs to its largest component.
    #[default]
    Cube,
    /// Four faces of a tetrahedron that stands on its tip: straight down, and three that look up a
    /// little. A direction belongs to the axis it is nearest to. Half of each map is outside of the
    /// face's triangle.
    Tetrahedral,
    /// Two paraboloids, down and up (Brabec, Annen and Seidel, "Shadow Mapping for Hemispherical
    /// and Omnidirectional Light Sources", 2002). Floors and ceilings, the largest flat things, are
    /// whole in one of them.
    DualParaboloid,
}

impl Omni {
    /// Layers of the map.
    pub fn layers(self) -> u32 {
        match self {
            Self::Cube => 6,
            Self::Tetrahedral => 4,
            Self::DualParaboloid => 2,
        }
    }

    /// The layer that a direction from the light belongs to.
    pub fn layer_of(self, direction: DVec3) -> u32 {
        match self {
            Self::DualParaboloid => u32::from(direction.y > 0.0),
            Self::Cube | Self::Tetrahedral => {
                let along = perspective::faces(self).map(|(forward, _)| forward.dot(direction));
                let nearest = along.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
                nearest.map_or(0, |(layer, _)| layer as u32)
            }
        }
    }
}

/// The boxes that a fit goes by.
#[derive(Clone, Debug)]
pub struct FitScene {
    /// Around each caster.
    pub casters: Vec<Bounds>,
    /// Around each receiver.
    pub receivers: Vec<Bounds>,
    /// Around everything, also what is not seen: views that are to stand still go by it.
    pub around: Bounds,
}

impl Default for FitScene {
    fn default() -> Self {
        Self::new(Vec::new(), Vec::new())
    }
}

impl FitScene {
    /// Of all casters and receivers.
    pub fn new(casters: Vec<Bounds>, receivers: Vec<Bounds>) -> Self {
        let around = casters.iter().chain(&receivers).fold(Bounds::EMPTY, |b, c| b.union(*c));
        Self { casters, receivers, around }
    }
}

/// Near plane of perspective views over the distance of the farthest point. Reversed float depth
/// loses nothing by a small one.
const NEAR: f64 = 1e-5;

/// Stored depth of perspective views somewhat beyond the farthest point of the scene: where a depth
/// that falls linearly with distance reaches 0.
pub const FARTHEST: f64 = NEAR / 1.01;

impl LightView {
    /// A view that is all matrix.
    pub fn of(clip_from_world: DMat4, size: u32, layer: u32) -> Self {
        Self { clip_from_world, size, layer, paraboloid: None, steady_border: None }
    }

    /// True for views from a point.
    pub fn is_perspective(&self) -> bool {
        self.clip_from_world.row(3).truncate() != DVec3::ZERO && !self.is_warped()
    }

    /// True for views of parallel light whose texels are not all of one size: w changes from ray to
    /// ray, depth along each of them.
    pub fn is_warped(&self) -> bool {
        [2, 3].iter().all(|row| self.clip_from_world.row(*row).truncate() != DVec3::ZERO)
    }

    /// Where a perspective view is from.
    pub fn eye(&self) -> DVec3 {
        let rows = [0, 1, 3].map(|i| self.clip_from_world.row(i));
        let axes = DMat3::from_cols(rows[0].truncate(), rows[1].truncate(), rows[2].truncate()).transpose();
        axes.inverse() * -DVec3::new(rows[0].w, rows[1].w, rows[2].w)
    }

    /// The same view with `factor` times as much around its middle.
    pub fn widened(&self, factor: f64) -> Self {
        let mut view = self.clone();
        match &mut view.paraboloid {
            Some(paraboloid) => {
                paraboloid.scale /= factor;
                paraboloid.axis /= factor;
            }
            None => {
                let less = DVec3::new(1.0 / factor, 1.0 / factor, 1.0);
                view.clip_from_world = DMat4::from_scale(less) * view.clip_from_world;
            }
        }
        view
    }

    /// Normalised device coordinates and stored depth of a point; `None` behind the view.
    pub fn project(&self, point: DVec3) -> Option<DVec3> {
        let clip = self.clip_from_world * point.extend(1.0);
        match &self.paraboloid {
            Some(paraboloid) => paraboloid.project(clip),
            None => (clip.w > 0.0).then(|| clip.truncate() / clip.w),
        }
    }

    /// The matrix whose x, y and w agree with the view at `point` and around it, to first order.
    pub fn tangent_at(&self, point: DVec3) -> DMat4 {
        match &self.paraboloid {
            Some(paraboloid) => paraboloid.tangent_at(&self.clip_from_world, point),
            None => self.clip_from_world,
        }
    }

    /// A convex volume around all that the view shows.
    pub fn frustum(&self) -> Frustum {
        match &self.paraboloid {
            Some(paraboloid) => paraboloid.frustum(&self.clip_from_world),
            None => Frustum::of(&self.clip_from_world),
        }
    }
}

/// Fits the views of `light` to what is seen in `seen`, the camera's volume, replacing what is in
/// `views`. None are left where nothing that is seen can be in shadow. Returns [`Fit::omni`] where
/// there are views and their layers are those of it, `None` for a single view.
pub fn fit(
    light: &LightShape,
    seen: &Frustum,
    scene: &FitScene,
    fit: &Fit,
    views: &mut Vec<LightView>,
) -> Option<Omni> {
    views.clear();
    let center = light.center();
    if center.w == 0.0 {
        views.extend(parallel::view(-center.truncate(), seen, scene, fit));
        return None;
    }
    let position = center.truncate();
    if scene.around.is_empty() {
        return None;
    }
    let near = near(position, scene);
    if let LightShape::Spot { direction, outer_angle_deg, .. } = *light
        && let Some(view) = perspective::spot(position, direction, outer_angle_deg, near, seen, scene, fit)
    {
        views.push(view);
        return None;
    }
    match fit.omni {
        Omni::DualParaboloid => paraboloid::views(position, near, seen, scene, fit, views),
        Omni::Cube | Omni::Tetrahedral => perspective::views(position, near, seen, scene, fit, views),
    }
    (!views.is_empty()).then_some(fit.omni)
}

/// The near plane of perspective views from `position`.
fn near(position: DVec3, scene: &FitScene) -> f64 {
    let reach = scene.around.corners().iter().map(|c| c.distance(position)).fold(0.0, f64::max);
    (NEAR * reach).max(f64::MIN_POSITIVE)
}

/// The place in the plane at distance 1 ahead of what `clip`, a perspective view without crop,
/// shows there.
fn divided(clip: glam::DVec4) -> DVec2 {
    clip.truncate().truncate() / clip.w
}

#[cfg(test)]
mod tests;
