//! Warped views: one map whose texels are smaller near the camera.
//!
//! What a map shows of a light is fixed: a point of it is a ray of the light. Free is the plane the
//! picture is taken on, and with it where texels are dense (SG "Thesis of Hamilton Yu-Ik Chong").
//! In homogeneous coordinates a plane through the light, the *horizon*, says it all: texels are as
//! large as the distance from it. Perspective shadow maps (Stamminger and Drettakis 2002; Kozlov
//! 2004), light-space perspective shadow maps (Wimmer, Scherzer and Purgathofer 2004) and the
//! optimum for a plane are three choices of it.
//!
//! A ray of the light never meets the horizon, so every caster between a receiver and the light is
//! on the receiver's side: behind the eye too, where post-perspective space wraps around at
//! infinity (SG "Shadows From the Back").

mod cube;
mod flat;
mod horizon;
mod rays;
mod seen;
mod view;

use super::{Fit, FitScene, LightView, Omni, perspective};
use crate::{camera::CameraView, frustum::Frustum, light::LightShape};
use flat::FlatMap;
use glam::{DVec3, DVec4};
use horizon::Subject;
use rays::Rays;
use seen::surfaces;

/// Which horizon a map gets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warp {
    /// That of a map taken in post-perspective space, which looks from the transformed light to the
    /// middle of what is seen.
    PostPerspective {
        /// Moves the virtual camera back as far as makes texels smallest on the screen; to
        /// infinity, a uniform map, where warping does not help. Else it is the camera itself.
        shift: bool,
        /// The virtual camera's near plane is not nearer than this, metres along the view; 0 for
        /// the nearest receiver.
        near: f64,
        /// One view for every side of the post-perspective cube that the light's rays leave by.
        cube: bool,
    },
    /// Across the light and along the view, at the distance that makes errors near and far the
    /// same, divided by `strength`: 0 for a uniform map.
    LightSpace {
        /// See above; 1 is the optimum.
        strength: f64,
    },
    /// The one that makes texels uniform on the screen on a plane.
    Plane {
        /// Unit normal and offset of the plane; `None` for the one that most of the picture shows,
        /// or the ground, whichever is better.
        plane: Option<DVec4>,
        /// Moves the horizon away from there as far as makes texels smallest on all that is seen,
        /// to infinity where it does not help at all.
        gives_way: bool,
    },
}

/// Layers of the views of [`Warp::PostPerspective`] with `cube`.
pub const CUBE_SIDES: u32 = 6;

/// Fits warped views of `light` to what `camera` sees, replacing what is in `views`: one of
/// parallel light or of a spot, else one a face of [`Omni::Cube`], which is returned then. With
/// `cube` parallel light and spots get several, in layers 0 to [`CUBE_SIDES`], and a receiver
/// belongs to any that covers it.
pub fn fit_warped(
    light: &LightShape,
    camera: &CameraView,
    scene: &FitScene,
    warp: &Warp,
    fit: &Fit,
    views: &mut Vec<LightView>,
) -> Option<Omni> {
    views.clear();
    if scene.around.is_empty() {
        return None;
    }
    let seen = camera.frustum();
    let center = light.center();
    let surfaces = surfaces(camera, &seen, &scene.receivers);
    let task = Task { camera, scene, warp, fit, surfaces: &surfaces };
    if center.w == 0.0 {
        let points = visible(&seen, scene);
        let rays = Rays::parallel(-center.truncate(), &points);
        task.views(rays, &points, 0.0, 0, views);
        return None;
    }
    let position = center.truncate();
    let near = super::near(position, scene);
    if let LightShape::Spot { direction, .. } = *light {
        let points = visible(&seen, scene);
        let rays = Rays::from_point(position, direction, direction.any_orthonormal_vector());
        if points.iter().all(|p| rays.sees(*p, perspective::WIDEST)) {
            task.views(rays, &points, near, 0, views);
            return None;
        }
    }
    let omni = Omni::Cube;
    for (layer, (forward, up)) in perspective::faces(omni).enumerate() {
        let face = seen.clone().and(&perspective::face(position, forward, omni));
        let points = visible(&face, scene);
        // Each is one view, that of its side of the cube.
        let warp = match *warp {
            Warp::PostPerspective { shift, near, .. } => Warp::PostPerspective { shift, near, cube: false },
            other => other,
        };
        let task = Task { warp: &warp, ..task };
        task.views(Rays::from_point(position, forward, up), &points, near, layer as u32, views);
    }
    (!views.is_empty()).then_some(omni)
}

/// The corners of what is seen of the receivers.
fn visible(seen: &Frustum, scene: &FitScene) -> Vec<DVec3> {
    let mut points = Vec::new();
    scene.receivers.iter().for_each(|b| seen.clip_box(b, &mut points));
    points
}

/// What views are fitted to.
#[derive(Clone, Copy)]
struct Task<'a> {
    camera: &'a CameraView,
    scene: &'a FitScene,
    warp: &'a Warp,
    fit: &'a Fit,
    surfaces: &'a [seen::Surface],
}

impl Task<'_> {
    /// Appends the views of what `rays` show of `points`, all that is seen there; `near` is of a
    /// light that is somewhere.
    fn views(&self, rays: Rays, points: &[DVec3], near: f64, layer: u32, views: &mut Vec<LightView>) {
        let Some(subject) = Subject::new(rays, points, self.camera, self.surfaces) else { return };
        let mut add = |map: &FlatMap, layer| views.extend(view::of(map, &subject, self.scene, self.fit, near, layer));
        if let Warp::PostPerspective { shift, near: least, cube: true } = *self.warp
            && !self.camera.is_parallel()
            && let Some(camera) = subject.virtual_camera(shift, least, self.fit)
        {
            cube::sides(&subject, &camera, self.fit).iter().for_each(|(side, map)| add(map, *side));
            return;
        }
        if let Some(map) = self.map(&subject) {
            add(&map, layer);
        }
    }

    fn map(&self, subject: &Subject<'_>) -> Option<FlatMap> {
        let horizon = match *self.warp {
            // To parallel lines of sight near and far are the same.
            _ if self.camera.is_parallel() => DVec3::Z,
            Warp::PostPerspective { shift, near, .. } => {
                let camera = subject.virtual_camera(shift, near, self.fit);
                camera.map_or(DVec3::Z, |camera| subject.post_perspective(&camera))
            }
            Warp::LightSpace { strength } => subject.light_space(strength),
            Warp::Plane { plane, gives_way } => {
                let horizon = subject.plane_optimal(plane.unwrap_or_else(|| subject.best_plane(self.fit)));
                if gives_way { subject.given_way(horizon, self.fit) } else { horizon }
            }
        };
        subject.map(horizon, self.fit)
    }
}

#[cfg(test)]
mod tests;
