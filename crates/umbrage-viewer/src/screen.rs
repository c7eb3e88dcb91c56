//! Where things of the scene are on the screen.

use eframe::egui::{Pos2, Rect, Vec2};
use umbrage_core::Camera;
use umbrage_core::glam::{DMat4, DVec2, DVec3};

/// A picture on the screen and the camera that it is taken with.
pub(crate) struct Screen {
    camera: Camera,
    clip_from_world: DMat4,
    /// Where it lies, points.
    cell: Rect,
    /// Its pixels.
    pub size: (u32, u32),
}

impl Screen {
    pub fn new(camera: &Camera, cell: Rect, size: (u32, u32)) -> Self {
        let clip_from_world = camera.view(size.0, size.1).clip_from_world();
        Self { camera: camera.clone(), clip_from_world, cell, size }
    }

    /// Where normalised device coordinates are.
    pub fn of_ndc(&self, ndc: DVec2) -> Pos2 {
        let share = ndc * DVec2::new(0.5, -0.5) + 0.5;
        self.cell.min + Vec2::new(share.x as f32, share.y as f32) * self.cell.size()
    }

    /// Distance along the view.
    fn depth(&self, point: DVec3) -> f64 {
        (point - self.camera.eye).dot(self.camera.axes()[2])
    }

    /// Where a point is seen; `None` before the near plane.
    pub fn point(&self, point: DVec3) -> Option<Pos2> {
        let clip = self.clip_from_world * point.extend(1.0);
        let at = self.of_ndc(clip.truncate().truncate() / clip.w);
        (self.depth(point) >= self.camera.near && at.is_finite()).then_some(at)
    }

    /// The direction on the screen, from its middle, in which a point lies.
    pub fn way(&self, point: DVec3) -> Option<Vec2> {
        let [right, up, _] = self.camera.axes();
        let by = point - self.camera.eye;
        let way = Vec2::new(by.dot(right) as f32, -by.dot(up) as f32).normalized();
        (way.is_finite() && way != Vec2::ZERO).then_some(way)
    }

    /// The part of a line behind the near plane.
    pub fn segment(&self, from: DVec3, to: DVec3) -> Option<[Pos2; 2]> {
        let near = self.camera.near * (1.0 + 1e-9);
        let depths = [self.depth(from), self.depth(to)];
        let cut = |point: DVec3, depth: f64| {
            if depth >= near {
                return point;
            }
            from.lerp(to, (near - depths[0]) / (depths[1] - depths[0]))
        };
        if depths.iter().all(|depth| *depth < near) {
            return None;
        }
        Some([self.point(cut(from, depths[0]))?, self.point(cut(to, depths[1]))?])
    }

    /// How long so many points are in the scene, where `place` is seen.
    pub fn metres(&self, place: DVec3, points: f32) -> f64 {
        let height = match self.camera.parallel {
            Some(parallel) => parallel.height,
            None => 2.0 * (self.camera.fov_y_deg.to_radians() * 0.5).tan() * self.depth(place),
        };
        height * f64::from(points / self.cell.height().max(1.0))
    }

    /// Start and direction of the line of sight through a place of the screen.
    fn ray(&self, at: Pos2) -> [DVec3; 2] {
        let share = (at - self.cell.min) / self.cell.size();
        let (width, height) = self.size;
        let pixel = DVec2::new(f64::from(share.x) * f64::from(width), f64::from(share.y) * f64::from(height));
        [self.camera.start(pixel, width, height), self.camera.ray(pixel, width, height)]
    }

    /// The point under the place where `point` is seen and `by` beside it, as far along the view.
    pub fn beside(&self, point: DVec3, by: Vec2) -> Option<DVec3> {
        let [start, ray] = self.ray(self.point(point)? + by);
        // The share of a ray along the view is 1.
        Some(start + ray * self.depth(point))
    }

    /// The point of the line from `from` through `at` that is nearest to the line of sight `by`
    /// beside `at`; `None` where the line is seen from its end.
    pub fn along(&self, from: DVec3, at: DVec3, by: Vec2) -> Option<DVec3> {
        let place = self.point(at)?;
        let along = (at - from).try_normalize()?;
        let is_beside = |ray: DVec3| ray.cross(along).length_squared() > 1e-3 * ray.length_squared();
        let [start, ray] = self.ray(place + by);
        if !is_beside(ray) || !is_beside(self.ray(place)[1]) {
            return None;
        }
        let ray = ray.normalize();
        let (cos, arm) = (along.dot(ray), start - at);
        Some(at + along * ((arm.dot(along) - cos * arm.dot(ray)) / (1.0 - cos * cos)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::Parallel;

    fn screens() -> [Screen; 2] {
        let cell = Rect::from_min_size(Pos2::new(100.0, 50.0), Vec2::new(400.0, 300.0));
        let camera = Camera { eye: DVec3::new(1.0, 2.0, 6.0), ..Camera::default() };
        let parallel = Camera { parallel: Some(Parallel { height: 5.0, far: 50.0 }), ..camera.clone() };
        [camera, parallel].map(|camera| Screen::new(&camera, cell, (80, 60)))
    }

    #[test]
    fn what_is_dragged_is_seen_where_it_was_dragged_to() {
        for screen in screens() {
            let point = DVec3::new(0.4, 0.3, -0.2);
            let by = Vec2::new(31.0, -17.0);
            let at = screen.point(point).unwrap();
            let there = screen.point(screen.beside(point, by).unwrap()).unwrap();
            assert!((there - at - by).length() < 0.01, "{there:?}");
            let from = point - DVec3::X;
            let along = screen.along(from, point, Vec2::new(25.0, 0.0)).unwrap();
            assert!((along - from).cross(DVec3::X).length() < 1e-9);
            assert!((screen.point(along).unwrap().x - at.x - 25.0).abs() < 2.0);
            let end_on = screen.ray(at)[1];
            assert_eq!(screen.along(point - end_on, point, by), None);
        }
    }

    #[test]
    fn lines_end_at_the_near_plane() {
        for screen in screens() {
            let [_, _, forward] = screen.camera.axes();
            let (before, behind) = (screen.camera.eye + forward * 3.0, screen.camera.eye - forward * 3.0);
            assert!(screen.point(behind).is_none() && screen.segment(behind, behind - forward).is_none());
            let side = before + DVec3::X;
            let ends = screen.segment(behind, side).unwrap();
            assert!(ends[0].is_finite() && (ends[1] - screen.point(side).unwrap()).length() < 1e-3);
            assert_eq!(screen.segment(side, behind).unwrap(), [ends[1], ends[0]]);
        }
    }

    #[test]
    fn a_length_is_seen_as_so_many_points() {
        for screen in screens() {
            let [right, ..] = screen.camera.axes();
            let metres = screen.metres(DVec3::ZERO, 70.0);
            let [a, b] = screen.segment(DVec3::ZERO, right * metres).unwrap();
            assert!(((b - a).length() - 70.0).abs() < 0.01);
        }
    }
}
