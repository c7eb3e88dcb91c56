//! Where the horizon of a map is put: the three methods.

use super::super::Fit;
use super::flat::{FlatMap, moved_off};
use super::rays::{Rays, hull};
use super::seen::Surface;
use crate::camera::CameraView;
use glam::{DMat2, DVec2, DVec3, DVec4};

/// What one map has to show.
#[derive(Clone, Debug)]
pub(super) struct Subject<'a> {
    pub rays: Rays,
    /// Around the rays of all that is seen.
    pub hull: Vec<DVec2>,
    /// Corners of what is seen.
    pub points: &'a [DVec3],
    /// Places of the picture that face the light.
    places: Vec<Place>,
    /// Right, up and ahead of the camera as functions of (p, 1), metres.
    view: [DVec4; 3],
    /// Least and largest distance along the view.
    range: [f64; 2],
}

/// A place of the picture.
#[derive(Clone, Copy, Debug)]
struct Place {
    surface: Surface,
    ray: DVec2,
    /// Cosine of the angle between its normal and the way to the light.
    facing: f64,
    /// Change of the place on the screen with the ray along the surface, in units of the picture's
    /// height.
    screen_from_ray: DMat2,
}

/// The virtual camera: the real one, moved back, whose post-perspective cube is around what is
/// seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct VirtualCamera {
    /// Right, up, depth and w of clip space; what is seen is from −1 to 1 in all three.
    pub clip_from_world: [DVec4; 4],
}

/// How many steps from a full warp to none are tried first.
const STEPS: u32 = 8;

/// Then the best one is closed in on: so often, by the golden section.
const ROUNDS: u32 = 8;

impl<'a> Subject<'a> {
    /// `None` where nothing is seen.
    pub fn new(rays: Rays, points: &'a [DVec3], camera: &CameraView, surfaces: &[Surface]) -> Option<Self> {
        let hull = hull(points.iter().map(|p| rays.of(*p)).collect());
        if hull.is_empty() {
            return None;
        }
        let rows = [0, 1, 2].map(|i| camera.view_from_world.matrix3.row(i));
        let axes = [rows[0], rows[1], -rows[2]];
        let view = axes.map(|axis| axis.extend(-axis.dot(camera.eye)));
        let depths = points.iter().map(|p| view[2].dot(p.extend(1.0)));
        let range = depths.fold([f64::INFINITY, 0.0], |[n, f], d: f64| [n.min(d.max(0.0)), f.max(d)]);
        let inside = |place: &Place| is_inside(&hull, place.ray);
        let places = surfaces.iter().filter_map(|s| Place::of(*s, &rays, &view)).filter(inside).collect();
        Some(Self { rays, hull, points, places, view, range })
    }

    /// The map with a horizon, as near to it as leaves all rays on one side.
    pub fn map(&self, horizon: DVec3, fit: &Fit) -> Option<FlatMap> {
        FlatMap::new(horizon, &self.hull, fit)
    }

    /// How far a texel reaches on the screen in the mean: the largest singular value of its
    /// footprint, in units of the picture's height. Places count by the light that they get.
    fn texel_on_screen(&self, horizon: DVec3, fit: &Fit) -> f64 {
        let Some(map) = self.map(horizon, fit) else { return f64::INFINITY };
        let sizes = self.places.iter().map(|place| {
            let screen_from_texels = place.screen_from_ray * map.texels_from_ray(place.ray, fit.size).inverse();
            place.facing * stretch(screen_from_texels)
        });
        sizes.sum()
    }

    /// The virtual camera of a perspective shadow map: back so far that the nearest receiver is
    /// `least_near` away, and with `shift` as much farther as makes texels smallest; `None` where
    /// no distance is as good as infinity.
    pub fn virtual_camera(&self, shift: bool, least_near: f64, fit: &Fit) -> Option<VirtualCamera> {
        let [nearest, farthest] = self.range;
        let least = (least_near.max(NEAREST * farthest) - nearest).max(0.0);
        let (near, far) = (nearest + least, farthest + least);
        if far <= near * (1.0 + 1e-9) {
            return None;
        }
        if !shift {
            return self.camera_at(least);
        }
        // Steps go by the ratio of distances: that of 1 is infinitely far back.
        let camera = |share: f64| {
            let ratio = (far / near).powf(1.0 - share);
            if share < 1.0 - 1e-6 { self.camera_at(least + (far - ratio * near) / (ratio - 1.0)) } else { None }
        };
        let score =
            |share: f64| self.texel_on_screen(camera(share).map_or(DVec3::Z, |c| self.post_perspective(&c)), fit);
        camera(share_of_least(&score)?)
    }

    /// The camera moved back by `shift`.
    fn camera_at(&self, shift: f64) -> Option<VirtualCamera> {
        let [right, up, ahead] = self.view;
        let w = ahead + DVec4::W * shift;
        let [near, far] = self.range.map(|d| d + shift);
        let within = |row: DVec4| {
            let places = self.points.iter().map(|p| row.dot(p.extend(1.0)) / w.dot(p.extend(1.0)).max(near));
            let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
            // A little more, so that nothing is outside by rounding.
            let half = (0.5 * (high - low)).max(1e-6) * 1.001;
            (row - w * (0.5 * (low + high))) / half
        };
        let (near, far) = (near * 0.999, far * 1.001);
        let depth = (w * (far + near) - DVec4::W * (2.0 * far * near)) / (far - near);
        let clip_from_world = [within(right), within(up), depth, w];
        clip_from_world.iter().all(|row| row.is_finite()).then_some(VirtualCamera { clip_from_world })
    }

    /// The horizon of a perspective shadow map: in post-perspective space, the plane through the
    /// light across the way to the middle of the cube. The light may be a point there, at infinity,
    /// or inverted: a point that rays go to.
    pub fn post_perspective(&self, camera: &VirtualCamera) -> DVec3 {
        let rows = camera.clip_from_world;
        let [x, y, z, w] = rows.map(|row| row.dot(self.rays.light));
        let towards = rows[0] * x + rows[1] * y + rows[2] * z;
        self.rays.coordinates(rows[3] * (x * x + y * y + z * z) - towards * w)
    }

    /// The horizon of a light-space perspective shadow map. From its near to its far end, errors of
    /// the projection along the view grow by the root of the ratio of distances (Wimmer et al.
    /// 2004, n_opt); less where light and view are not perpendicular.
    pub fn light_space(&self, strength: f64) -> DVec3 {
        let forward = self.view[2].truncate();
        let middle = self.points.iter().sum::<DVec3>() / self.points.len().max(1) as f64;
        let [near, far] = self.range;
        let near = near.max(NEAREST * far);
        let change = self.rays.change(middle, forward);
        let cos = forward.dot(self.rays.toward_light(middle));
        let growth = strength * (1.0 - cos * cos).max(0.0) * ((far / near).sqrt() - 1.0);
        let length = change.length() * (far - near);
        // The distance of the horizon before the near end.
        let distance = length / growth;
        if !(growth > 1e-9 && length > 0.0 && distance.is_finite()) {
            return DVec3::Z;
        }
        let along = change.normalize();
        let first = self.hull.iter().map(|ray| along.dot(*ray)).fold(f64::INFINITY, f64::min);
        (along / distance).extend(1.0 - first / distance)
    }

    /// The horizon that leaves no perspective between a plane's place on the screen and in the map:
    /// it goes through the line in which the plane meets that of the camera (SG "Thesis of Hamilton
    /// Yu-Ik Chong").
    pub fn plane_optimal(&self, plane: DVec4) -> DVec3 {
        let (ahead, light) = (self.view[2], self.rays.light);
        let above = plane.dot(light);
        let horizon = self.rays.coordinates(ahead * above - plane * ahead.dot(light));
        if above < 0.0 { -horizon } else { horizon }
    }

    /// The plane whose optimum makes texels smallest on all that is seen: that of the receivers'
    /// boxes which most of the picture shows, of those that face the light, or the level one under
    /// everything.
    pub fn best_plane(&self, fit: &Fit) -> DVec4 {
        let lowest = self.points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let level = DVec4::new(0.0, 1.0, 0.0, -lowest);
        let size = |plane: DVec4| self.texel_on_screen(self.plane_optimal(plane), fit);
        self.dominant_plane().filter(|plane| size(*plane) < size(level)).unwrap_or(level)
    }

    /// Between `horizon` and infinity, where texels are smallest on all that is seen.
    pub fn given_way(&self, horizon: DVec3, fit: &Fit) -> DVec3 {
        let start = moved_off(horizon, &self.hull);
        // Steps go by how much texels differ.
        let heights = self.hull.iter().map(|ray| start.dot(ray.extend(1.0)));
        let ratio = 1.0 / heights.fold(1.0, f64::min);
        let at = |share: f64| {
            let less = ratio.powf(1.0 - share);
            start + DVec3::Z * ((ratio - less) / (ratio * (less - 1.0)).max(f64::MIN_POSITIVE))
        };
        let at = |share: f64| if share < 1.0 - 1e-6 { at(share) } else { DVec3::Z };
        share_of_least(&|share| self.texel_on_screen(at(share), fit)).map_or(horizon, at)
    }

    /// The plane that most of what is seen lies in and that the light meets at more than a grazing
    /// angle, its normal of unit length.
    pub fn ground(&self) -> Option<DVec4> {
        self.dominant_plane().filter(|plane| plane.dot(self.rays.light) > GRAZING)
    }

    /// The plane that most of the places share.
    fn dominant_plane(&self) -> Option<DVec4> {
        let plane = |s: &Surface| s.normal.extend(-s.normal.dot(s.point));
        let tolerance = 1e-6 * (self.range[1] + self.points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max));
        let count = |s: &Surface| {
            let same = |o: &&Place| {
                o.surface.normal == s.normal && (o.surface.point - s.point).dot(s.normal).abs() <= tolerance
            };
            self.places.iter().filter(same).count()
        };
        self.places.iter().map(|p| (count(&p.surface), plane(&p.surface))).max_by_key(|(n, _)| *n).map(|(_, p)| p)
    }
}

/// Sine of the least angle between the ground and the light.
const GRAZING: f64 = 0.1;

/// Nearest distance along the view over the farthest one, at least.
const NEAREST: f64 = 1e-4;

impl Place {
    /// `None` where the surface faces away, or the light or the camera sees it edge-on.
    fn of(surface: Surface, rays: &Rays, [right, up, ahead]: &[DVec4; 3]) -> Option<Self> {
        let (s, t) = surface.normal.any_orthonormal_pair();
        let point = surface.point.extend(1.0);
        let distance = ahead.dot(point);
        let at = DVec2::new(right.dot(point), up.dot(point)) / distance;
        let screen = |way: DVec3| {
            let way = way.extend(0.0);
            (DVec2::new(right.dot(way), up.dot(way)) - at * ahead.dot(way)) / distance
        };
        let ray_from_surface = DMat2::from_cols(rays.change(surface.point, s), rays.change(surface.point, t));
        let screen_from_ray = DMat2::from_cols(screen(s), screen(t)) * ray_from_surface.inverse();
        let facing = surface.normal.dot(rays.toward_light(surface.point));
        let place = Self { surface, ray: rays.of(surface.point), facing, screen_from_ray };
        (facing > 0.0 && distance > 0.0 && place.ray.is_finite() && screen_from_ray.is_finite()).then_some(place)
    }
}

fn is_inside(hull: &[DVec2], ray: DVec2) -> bool {
    let size = hull.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    hull.len() < 3
        || (0..hull.len()).all(|i| {
            let (a, b) = (hull[i], hull[(i + 1) % hull.len()]);
            (b - a).perp_dot(ray - a) >= -1e-9 * size * (b - a).length()
        })
}

/// The largest singular value.
fn stretch(m: DMat2) -> f64 {
    let sum = m.x_axis.length_squared() + m.y_axis.length_squared();
    let product = m.determinant();
    (0.5 * (sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt())).sqrt()
}

/// Least gain in the size of texels that a warp is worth: its texels are longer than wide, and it
/// is chosen by boxes around receivers.
const WORTH: f64 = 0.7;

/// Where from 0 to 1 a function is least, as far as steps and what is around the best of them tell;
/// 1, no warp, where that is not worth it.
fn share_of_least(score: &dyn Fn(f64) -> f64) -> Option<f64> {
    let step = 1.0 / f64::from(STEPS);
    let at = |share: f64| (share, score(share));
    let less = |a: &(f64, f64), b: &(f64, f64)| a.1.total_cmp(&b.1);
    let (middle, least) = (0..=STEPS).map(|i| at(step * f64::from(i))).min_by(less)?;
    let closer = golden((middle - step).max(0.0), (middle + step).min(1.0), &at);
    let best = [closer, (middle, least)].into_iter().min_by(less)?;
    Some(if best.1 <= WORTH * score(1.0) { best.0 } else { 1.0 })
}

/// The least value of a function with one minimum between two places, and where it is: by the
/// golden section.
fn golden(mut low: f64, mut high: f64, at: &dyn Fn(f64) -> (f64, f64)) -> (f64, f64) {
    const SHARE: f64 = 0.618_033_988_749_894_9;
    let mut inner = [at(high - SHARE * (high - low)), at(low + SHARE * (high - low))];
    for _ in 0..ROUNDS {
        if inner[0].1 <= inner[1].1 {
            high = inner[1].0;
            inner = [at(high - SHARE * (high - low)), inner[0]];
        } else {
            low = inner[0].0;
            inner = [inner[1], at(low + SHARE * (high - low))];
        }
    }
    if inner[0].1 <= inner[1].1 { inner[0] } else { inner[1] }
}
