//! Change from frame to frame at fixed points of the scene, while the camera moves.

use crate::discontinuity::discontinuities;
use crate::score::difference;
use umbrage_core::glam::{DVec2, DVec3, Vec3};
use umbrage_core::{Camera, Image};

/// A point counts where it is this near to a pixel's centre in the second frame, pixels. So nothing
/// is interpolated, and what the picture's own grid adds is an eighth of a pixel at most.
const NEAR_PIXELS: f64 = 0.125;

/// Share of the distance that the surface of the second frame may be off that of the first.
const SAME_DEPTH: f64 = 1e-3;

/// Least cosine between the normals of the two frames.
const SAME_NORMAL: f32 = 0.9;

/// What a frame shows.
#[derive(Clone, Debug)]
pub struct Frame {
    camera: Camera,
    depth: Image<f32>,
    normal: Image<Vec3>,
    edges: Image<bool>,
}

/// Two pixels, at first and then, that show the same point of a surface at their centres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedPoint {
    /// The pixel of the first frame.
    pub before: (u32, u32),
    /// The pixel of the second.
    pub after: (u32, u32),
}

impl Frame {
    /// `depth` is along the view direction, metres, 0 where nothing is; `normal` is geometric.
    pub fn new(camera: Camera, depth: Image<f32>, normal: Image<Vec3>) -> Self {
        let edges = discontinuities(&depth, &depth.map(|_| 0));
        Self { camera, depth, normal, edges }
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        self.depth.size()
    }

    /// Distance along the view of what pixel (`x`, `y`) shows, metres; `None` where it shows
    /// nothing, beside discontinuities of depth and outside of the picture.
    pub fn depth(&self, (x, y): (u32, u32)) -> Option<f64> {
        let at = (i64::from(x), i64::from(y));
        let depth = *self.depth.get(at.0, at.1).filter(|depth| **depth > 0.0)?;
        (self.edges.get(at.0, at.1) == Some(&false)).then_some(f64::from(depth))
    }

    /// The start of the ray through a pixel's centre and its direction; 1 along the view.
    fn ray(&self, (x, y): (u32, u32)) -> (DVec3, DVec3) {
        let (width, height) = self.depth.size();
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        (self.camera.start(pixel, width, height), self.camera.ray(pixel, width, height))
    }
}

/// The points that two frames of one size both show at the centre of a pixel.
pub fn fixed_points(before: &Frame, after: &Frame) -> Vec<FixedPoint> {
    let (width, height) = before.depth.size();
    let clip_from_world = after.camera.view(width, height).clip_from_world();
    let size = DVec2::new(width.into(), height.into());
    let mut points = Vec::new();
    for pixel in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let Some(depth) = before.depth(pixel) else { continue };
        let (start, ray) = before.ray(pixel);
        let point = start + ray * depth;
        let clip = clip_from_world * point.extend(1.0);
        if clip.w <= 0.0 {
            continue;
        }
        let place = (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size;
        let corner = place.floor();
        let is_near = (place - corner - 0.5).length() <= NEAR_PIXELS;
        if is_near && corner.min_element() >= 0.0 {
            let found = FixedPoint { before: pixel, after: (corner.x as u32, corner.y as u32) };
            points.extend(is_same_surface(before, after, &found, point).then_some(found));
        }
    }
    points
}

/// True where the second pixel shows the plane that `point` of the first lies on.
fn is_same_surface(before: &Frame, after: &Frame, found: &FixedPoint, point: DVec3) -> bool {
    let Some(depth) = after.depth(found.after) else { return false };
    let (normal, next) = (before.normal[found.before], after.normal[found.after]);
    let plane = normal.as_dvec3();
    let (start, ray) = after.ray(found.after);
    let expected = (point - start).dot(plane) / ray.dot(plane);
    (depth - expected).abs() <= SAME_DEPTH * depth && normal.dot(next) >= SAME_NORMAL
}

/// Mean change of a picture at fixed points, over several pairs of frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flicker {
    sum: f64,
    off: f64,
    points: usize,
}

impl Flicker {
    /// Adds the changes between two frames, each with the picture that it shows; what is not finite
    /// changes by 1.
    pub fn add(&mut self, points: &[FixedPoint], before: &Image<f32>, after: &Image<f32>) {
        let value =
            |picture: &Image<f32>, (x, y): (u32, u32)| picture.get(x.into(), y.into()).copied().unwrap_or(f32::NAN);
        for point in points {
            let (before, after) = (value(before, point.before), value(after, point.after));
            self.sum += if before.is_finite() { difference(after, before).abs() } else { 1.0 };
        }
        self.points += points.len();
    }

    /// The same, and how far the changes are off those of the truth, `true_before` and
    /// `true_after`, at the same points; what is not finite is off by 1.
    pub fn add_beside(
        &mut self,
        points: &[FixedPoint],
        [before, after]: [&Image<f32>; 2],
        [true_before, true_after]: [&Image<f32>; 2],
    ) {
        self.add(points, before, after);
        let value = |picture: &Image<f32>, (x, y): (u32, u32)| {
            picture.get(x.into(), y.into()).map_or(f64::NAN, |v| f64::from(*v))
        };
        for FixedPoint { before: first, after: then } in points {
            let change = value(after, *then) - value(before, *first);
            let off = (change - (value(true_after, *then) - value(true_before, *first))).abs();
            self.off += if off.is_finite() { off } else { 1.0 };
        }
    }

    /// Mean of |change − the truth's change|, of what was added beside the truth; `None` where
    /// there was no point.
    pub fn mean_off(&self) -> Option<f64> {
        (self.points > 0).then(|| self.off / self.points as f64)
    }

    /// Mean of |after − before|; `None` where there was no point.
    pub fn mean(&self) -> Option<f64> {
        (self.points > 0).then(|| self.sum / self.points as f64)
    }

    /// How many changes there were.
    pub fn points(&self) -> usize {
        self.points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (64, 48);
    const DISTANCE: f64 = 10.0;

    /// A wall that the camera looks at straight, moved to the right by `pixels`.
    fn frame(pixels: f64) -> Frame {
        let straight = Camera { eye: DVec3::new(0.0, 0.0, DISTANCE), target: DVec3::ZERO, ..Camera::default() };
        let pixel = 2.0 * (straight.fov_y_deg.to_radians() * 0.5).tan() * DISTANCE / f64::from(SIZE.1);
        let by = DVec3::X * (pixel * pixels);
        let camera = Camera { eye: straight.eye + by, target: straight.target + by, ..straight };
        Frame::new(camera, Image::filled(SIZE.0, SIZE.1, DISTANCE as f32), Image::filled(SIZE.0, SIZE.1, Vec3::Z))
    }

    /// Stripes on the wall, `every` pixels wide, that have moved to the right by `pixels`, as a
    /// camera at `at` sees them.
    fn stripes(every: f64, at: f64, pixels: f64) -> Image<f32> {
        Image::from_fn(SIZE.0, SIZE.1, |x, _| {
            ((f64::from(x) + 0.5 + at - pixels) / every).rem_euclid(2.0).floor() as f32
        })
    }

    fn flicker(step: f64, crawl: f64) -> (Option<f64>, usize) {
        let (every, mut flicker) = (8.0, Flicker::default());
        for k in 0..200 {
            let (from, to) = (f64::from(k) * step, f64::from(k + 1) * step);
            let points = fixed_points(&frame(from), &frame(to));
            let picture = |at: f64, n: i32| stripes(every, at, 0.3 + f64::from(n) * crawl);
            flicker.add(&points, &picture(from, k), &picture(to, k + 1));
        }
        (flicker.mean(), flicker.points())
    }

    #[test]
    fn what_is_fixed_does_not_flicker_and_what_crawls_does_by_as_much() {
        // Whole pixels: the points are exact. Of stripes 8 pixels wide that crawl by c pixels a
        // share of c / 8 changes.
        assert_eq!(flicker(1.0, 0.0), (Some(0.0), 200 * 63 * 48));
        for crawl in [0.25, 0.75] {
            let found = flicker(1.0, crawl).0.expect("points");
            assert!((found - crawl / 8.0).abs() < 0.003, "{found} for {crawl}");
        }
    }

    #[test]
    fn the_grid_of_the_picture_adds_no_more_than_an_eighth_of_a_pixel() {
        let (found, points) = flicker(1.1, 0.0);
        // A tenth of a pixel beside the centre: a share of 0.1 / 8 of the points seems to change.
        assert!(points > 0 && found.is_some_and(|found| (found - 0.1 / 8.0).abs() < 0.002), "{found:?}");
        assert_eq!(flicker(1.3, 0.0), (None, 0), "no point is near to a centre again");
    }

    #[test]
    fn only_the_same_surface_counts() {
        let (before, after) = (frame(0.0), frame(2.0));
        let count = |after: &Frame| fixed_points(&before, after).len();
        assert_eq!(count(&after), 62 * 48);
        let hidden = Image::from_fn(SIZE.0, SIZE.1, |x, _| if x < 30 { DISTANCE as f32 } else { 8.0 });
        // The step takes a column on either side with it.
        assert_eq!(count(&Frame::new(after.camera.clone(), hidden, after.normal.clone())), 29 * 48);
        let turned = Image::from_fn(SIZE.0, SIZE.1, |_, y| if y < 40 { Vec3::Z } else { Vec3::X });
        assert_eq!(count(&Frame::new(after.camera.clone(), after.depth.clone(), turned)), 62 * 40);
        let behind = Camera { eye: -after.camera.eye, ..after.camera.clone() };
        assert_eq!(count(&Frame::new(behind, after.depth.clone(), after.normal.map(|n| -*n))), 0);
    }

    #[test]
    fn what_is_not_finite_changes_by_one() {
        let points = [FixedPoint { before: (0, 0), after: (1, 0) }, FixedPoint { before: (1, 0), after: (0, 0) }];
        let picture = |a: f32, b: f32| Image { width: 2, height: 1, data: vec![a, b] };
        let mut flicker = Flicker::default();
        assert_eq!(flicker.mean(), None);
        flicker.add(&points, &picture(f32::NAN, 0.5), &picture(f32::INFINITY, 0.5));
        assert_eq!((flicker.mean(), flicker.points()), (Some(1.0), 2));
        flicker.add(&points, &picture(0.25, 0.5), &picture(0.5, 0.5));
        assert_eq!(flicker.mean(), Some((1.0 + 1.0 + 0.25) / 4.0));
    }

    #[test]
    fn a_change_that_the_truth_makes_too_is_not_off() {
        let points = fixed_points(&frame(0.0), &frame(0.0));
        let [at_first, then, late] = [0.0, 1.0, 0.5].map(|crawl| stripes(8.0, 0.0, crawl));
        let mut flicker = Flicker::default();
        flicker.add_beside(&points, [&at_first, &then], [&at_first, &then]);
        assert_eq!(flicker.mean_off(), Some(0.0));
        assert!(flicker.mean().is_some_and(|mean| (mean - 0.125).abs() < 0.01));
        // A shadow that stands while the true one moves by a pixel of eight.
        let mut lazy = Flicker::default();
        lazy.add_beside(&points, [&late, &late], [&at_first, &then]);
        assert_eq!((lazy.mean(), lazy.mean_off()), (Some(0.0), flicker.mean()));
        let mut broken = Flicker::default();
        broken.add_beside(&points, [&late.map(|_| f32::NAN), &late], [&at_first, &then]);
        assert_eq!(broken.mean_off(), Some(1.0));
    }
}
