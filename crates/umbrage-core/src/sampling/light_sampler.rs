//! The points of a light that one receiver sees it through.

use super::luminance::Luminance;
use super::points::square_to_disc;
use crate::light::LightShape;
use crate::material::Texture;
use glam::{DMat3, DVec2, DVec3, DVec4};
use std::sync::Arc;

/// One light, ready to give points for any receiver. Cheap to clone; sharable among threads.
#[derive(Clone, Debug)]
pub struct LightSampler {
    shape: LightShape,
    luminance: Option<Arc<Luminance>>,
}

/// A light as one receiver sees it; what does not change from sample to sample.
#[derive(Clone, Copy, Debug)]
pub struct LightFrom<'a> {
    /// The middle: a point (w = 1) or a direction (w = 0).
    center: DVec4,
    /// Half the extent along the light's two axes.
    axes: [DVec3; 2],
    domain: Domain<'a>,
}

/// What the unit square is taken to before `center + x · axes[0] + y · axes[1]`.
#[derive(Clone, Copy, Debug)]
enum Domain<'a> {
    /// The square [−1, 1]².
    Square,
    /// The same, as dense as a picture is bright.
    Picture(&'a Luminance),
    /// The unit disc.
    Disc,
    /// A cap of the unit sphere around `center` of this height, 1 − cos of half the cone's angle.
    Cap(f64),
}

impl LightSampler {
    /// For the light `shape`; `textures` are the scene's. A rectangle whose texture is black,
    /// absent or incomplete is sampled evenly.
    pub fn new(shape: &LightShape, textures: &[Texture]) -> Self {
        let luminance = match shape {
            LightShape::Rect { texture: Some(index), .. } => textures.get(*index).and_then(Luminance::of).map(Arc::new),
            _ => None,
        };
        Self { shape: shape.clone(), luminance }
    }

    /// The light as the receiver at `p` (world space, metres) sees it.
    ///
    /// A receiver at the centre of a sphere or an ellipsoid has no direction to it; any is taken.
    pub fn at(&self, p: DVec3) -> LightFrom<'_> {
        let (axes, domain) = match self.shape {
            LightShape::Point { .. } | LightShape::Spot { .. } => ([DVec3::ZERO; 2], Domain::Square),
            LightShape::Directional { direction, angle_deg } => {
                let quarter = (angle_deg.to_radians() * 0.25).sin();
                (perpendicular_to(direction).into(), Domain::Cap(2.0 * quarter * quarter))
            }
            LightShape::Sphere { position, radius } => {
                let axes = perpendicular_to(position - p);
                ([axes.0 * radius, axes.1 * radius], Domain::Disc)
            }
            LightShape::Ellipsoid { position, radii, rotation } => {
                (ellipse_facing(position - p, radii, &rotation), Domain::Disc)
            }
            LightShape::Disc { direction, radius, .. } => {
                let axes = perpendicular_to(direction);
                ([axes.0 * radius, axes.1 * radius], Domain::Disc)
            }
            LightShape::Rect { direction, up, size, .. } => {
                let domain = self.luminance.as_deref().map_or(Domain::Square, Domain::Picture);
                // To the right for somebody who looks at the emitting side; down, as the rows of a
                // picture go.
                ([up.cross(direction) * (size.x * 0.5), up * (size.y * -0.5)], domain)
            }
            LightShape::Line { from, to } => ([(to - from) * 0.5, DVec3::ZERO], Domain::Square),
            // The half of the sky around its middle, up.
            LightShape::Environment(_) => ([DVec3::Z, DVec3::X], Domain::Cap(1.0)),
        };
        LightFrom { center: self.shape.center(), axes, domain }
    }
}

impl LightFrom<'_> {
    /// The same light with its samples turned about the middle by `angle` radians, where it is
    /// round: a disc, a sphere, a sun. With an angle of its own for every receiver, errors along
    /// straight shadow edges do not form bands.
    pub fn turned(self, angle: f64) -> Self {
        let [x, y] = self.axes;
        let (sin, cos) = angle.sin_cos();
        match self.domain {
            Domain::Disc | Domain::Cap(_) => Self { axes: [x * cos + y * sin, y * cos - x * sin], ..self },
            Domain::Square | Domain::Picture(_) => self,
        }
    }

    /// The point of the light that belongs to `u` in [0, 1]²: a point of world space with w = 1, or
    /// for a directional light the unit direction **to** it with w = 0. Equal areas of the square
    /// go to equal shares of the light; the middle of the square to the centre (a textured
    /// rectangle apart).
    pub fn sample(&self, u: DVec2) -> DVec4 {
        self.place(match self.domain {
            Domain::Square => u * 2.0 - 1.0,
            Domain::Picture(luminance) => luminance.sample(u) * 2.0 - 1.0,
            Domain::Disc | Domain::Cap(_) => square_to_disc(u),
        })
    }

    /// Half the extent along the light's two axes, metres, or for a directional light unit vectors
    /// across it; zero where there is no extent.
    pub fn axes(&self) -> [DVec3; 2] {
        self.axes
    }

    /// The point `d.x` and `d.y` half extents from the light's middle, as [`LightFrom::sample`]
    /// gives points. Of a sun they are as far from the middle as makes equal areas of the disc
    /// equal shares of it.
    pub fn place(&self, d: DVec2) -> DVec4 {
        let [x, y] = self.axes;
        let on_axes = |d: DVec2| (x * d.x + y * d.y).extend(0.0);
        match self.domain {
            Domain::Square | Domain::Picture(_) | Domain::Disc => self.center + on_axes(d),
            Domain::Cap(height) => {
                // Archimedes: the area of a cap goes by its height, so the height below the pole is
                // `height` · r².
                let below = height * d.length_squared();
                self.center * (1.0 - below) + on_axes(d * (height * (2.0 - below)).max(0.0).sqrt())
            }
        }
    }

    /// How bright the light is around [`LightFrom::place`] of `d`, up to `reach` half extents to
    /// either side: over the whole light 1 in the mean, outside of it 0.
    pub fn brightness(&self, d: DVec2, reach: f64) -> f64 {
        let is_inside = match self.domain {
            Domain::Square | Domain::Picture(_) => d.abs().max_element() <= 1.0,
            Domain::Disc | Domain::Cap(_) => d.length_squared() <= 1.0,
        };
        match self.domain {
            Domain::Picture(luminance) if is_inside => {
                let [low, high] = [-reach, reach].map(|by| ((d + by + 1.0) * 0.5).clamp(DVec2::ZERO, DVec2::ONE));
                let area = (high - low).element_product();
                if area > 0.0 { luminance.within(low, high) / area } else { 0.0 }
            }
            _ => f64::from(u8::from(is_inside)),
        }
    }
}

/// Two unit vectors that are perpendicular to `v` and to each other, whatever the length of `v`.
fn perpendicular_to(v: DVec3) -> (DVec3, DVec3) {
    v.normalize_or(DVec3::Y).any_orthonormal_pair()
}

/// Half axes of the disc that faces `to_center` in the space where the ellipsoid is a unit sphere,
/// in world space.
fn ellipse_facing(to_center: DVec3, radii: DVec3, rotation: &DMat3) -> [DVec3; 2] {
    // A flat ellipsoid is the limit of thin ones.
    let thin = radii.max(DVec3::splat(radii.max_element() * 1e-9)).max(DVec3::splat(f64::MIN_POSITIVE));
    // Divided by the largest half axis and the largest share first, so that nothing overflows.
    let toward = (rotation.transpose() * to_center).normalize_or(DVec3::Y) * thin.max_element() / thin;
    let (x, y) = perpendicular_to(toward);
    [*rotation * (radii * x), *rotation * (radii * y)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::lattice;

    const N: usize = 4181;

    fn samples(shape: &LightShape, p: DVec3) -> Vec<DVec4> {
        let sampler = LightSampler::new(shape, &[]);
        let from = sampler.at(p);
        lattice(N).into_iter().map(|u| from.sample((u + DVec2::splat(0.5 / N as f64)).min(DVec2::ONE))).collect()
    }

    /// Mean, and the mean of the squared distance from `center` along `axis`.
    fn moments(points: &[DVec4], center: DVec3, axis: DVec3) -> (DVec3, f64) {
        let n = points.len() as f64;
        let mean = points.iter().map(|p| p.truncate()).sum::<DVec3>() / n;
        let second = points.iter().map(|p| (p.truncate() - center).dot(axis).powi(2)).sum::<f64>() / n;
        (mean, second)
    }

    fn assert_moments(what: &str, points: &[DVec4], center: DVec3, seconds: &[(DVec3, f64)]) {
        for &(axis, want) in seconds {
            let (mean, second) = moments(points, center, axis);
            assert!(mean.distance(center) < 2e-3, "{what}: mean {mean} instead of {center}");
            assert!((second - want).abs() < 2e-3 * (1.0 + want), "{what} along {axis}: {second} instead of {want}");
        }
    }

    const CENTER: DVec3 = DVec3::new(1.0, 2.0, -3.0);

    #[test]
    fn a_sphere_is_the_disc_that_faces_the_receiver() {
        let sphere = LightShape::Sphere { position: CENTER, radius: 2.0 };
        let p = DVec3::new(4.0, -2.0, 1.0);
        let n = (CENTER - p).normalize();
        let (a, b) = n.any_orthonormal_pair();
        let points = samples(&sphere, p);
        assert_moments("sphere", &points, CENTER, &[(n, 0.0), (a, 1.0), (b, 1.0), ((a + b).normalize(), 1.0)]);
        // Half-plane shares against the area of a circular segment.
        for d in [-1.5f64, -0.3, 0.0, 0.8] {
            let h = d / 2.0;
            let want = (h.acos() - h * (1.0 - h * h).sqrt()) / std::f64::consts::PI;
            let beyond = points.iter().filter(|q| (q.truncate() - CENTER).dot(a) > d).count();
            assert!((beyond as f64 / N as f64 - want).abs() < 2e-3, "beyond {d}: {beyond} of {N}, not {want}");
        }
    }

    #[test]
    fn turning_moves_the_samples_of_round_lights_within_the_light() {
        let p = DVec3::new(4.0, -2.0, 1.0);
        let radii = DVec3::new(0.5, 1.0, 3.0);
        let ellipsoid = LightShape::Ellipsoid { position: CENTER, radii, rotation: DMat3::IDENTITY };
        let sampler = LightSampler::new(&ellipsoid, &[]);
        let (from, turned) = (sampler.at(p), sampler.at(p).turned(1.0));
        let unit = |q: DVec4| (q.truncate() - CENTER) / radii;
        for u in lattice(89) {
            let (a, b) = (unit(from.sample(u)), unit(turned.sample(u)));
            let want = a.length_squared() * 1.0f64.cos();
            assert!((a.dot(b) - want).abs() < 1e-12 && (a.length() - b.length()).abs() < 1e-12, "{u}: {a} {b}");
        }
        let line = LightSampler::new(&LightShape::Line { from: DVec3::ZERO, to: CENTER }, &[]);
        assert_eq!(line.at(p).turned(1.0).sample(DVec2::X), CENTER.extend(1.0));
    }

    #[test]
    fn an_ellipsoid_is_a_sphere_in_its_own_space() {
        let radii = DVec3::new(0.5, 1.0, 3.0);
        let rotation = DMat3::from_rotation_y(0.6) * DMat3::from_rotation_x(-1.1);
        let p = DVec3::new(-6.0, 5.0, 9.0);
        let to_unit = |q: DVec3| rotation.transpose() * (q - CENTER) / radii;
        let points = samples(&LightShape::Ellipsoid { position: CENTER, radii, rotation }, p);
        let unit: Vec<_> = points.iter().map(|q| to_unit(q.truncate()).extend(1.0)).collect();
        let n = to_unit(p).normalize();
        let (a, b) = n.any_orthonormal_pair();
        assert_moments("ellipsoid", &unit, DVec3::ZERO, &[(n, 0.0), (a, 0.25), (b, 0.25)]);
    }

    #[test]
    fn an_ellipsoid_of_equal_axes_is_a_sphere() {
        let p = DVec3::new(3.0, 3.0, 3.0);
        let rotation = DMat3::from_rotation_z(1.0);
        let ball = LightShape::Ellipsoid { position: CENTER, radii: DVec3::splat(1.5), rotation };
        let n = (CENTER - p).normalize();
        let (a, _) = n.any_orthonormal_pair();
        assert_moments("ball", &samples(&ball, p), CENTER, &[(n, 0.0), (a, 1.5 * 1.5 / 4.0)]);
    }

    #[test]
    fn discs_and_rectangles_are_uniform_by_area_from_anywhere() {
        let direction = DVec3::new(1.0, -2.0, 0.5).normalize();
        let (up, side) = direction.any_orthonormal_pair();
        let disc = LightShape::Disc { position: CENTER, direction, radius: 2.0 };
        let rect = LightShape::Rect { position: CENTER, direction, up, size: DVec2::new(4.0, 1.0), texture: None };
        for p in [DVec3::ZERO, DVec3::new(9.0, 9.0, -9.0), CENTER] {
            assert_moments("disc", &samples(&disc, p), CENTER, &[(direction, 0.0), (up, 1.0), (side, 1.0)]);
            let seconds = [(direction, 0.0), (side, 16.0 / 12.0), (up, 1.0 / 12.0)];
            assert_moments("rect", &samples(&rect, p), CENTER, &seconds);
        }
    }

    #[test]
    fn places_are_those_that_samples_are_at_and_bright_inside_of_the_light() {
        let direction = DVec3::new(0.3, -1.0, 0.2).normalize();
        let up = direction.any_orthonormal_vector();
        let shapes = [
            LightShape::Disc { position: CENTER, direction, radius: 2.0 },
            LightShape::Rect { position: CENTER, direction, up, size: DVec2::new(4.0, 1.0), texture: None },
            LightShape::Directional { direction, angle_deg: 30.0 },
        ];
        for shape in &shapes {
            let sampler = LightSampler::new(shape, &[]);
            let from = sampler.at(DVec3::ZERO);
            assert_eq!(from.place(DVec2::ZERO), shape.center(), "{shape:?}");
            assert_eq!([0.0, 0.99, 1.01].map(|x| from.brightness(DVec2::X * x, 0.0)), [1.0, 1.0, 0.0], "{shape:?}");
            let edge = from.place(DVec2::X).truncate();
            let way = if shape.center().w == 0.0 { edge.angle_between(-direction) } else { edge.distance(CENTER) };
            let want = if shape.center().w == 0.0 { 15f64.to_radians() } else { 2.0 };
            assert!((way - want).abs() < 1e-9, "{shape:?}: {way}");
        }
    }

    #[test]
    fn a_line_is_uniform_by_length() {
        let along = DVec3::new(0.0, 3.0, 4.0);
        let line = LightShape::Line { from: CENTER - along, to: CENTER + along };
        let points = samples(&line, DVec3::ZERO);
        assert_moments("line", &points, CENTER, &[(along / 5.0, 100.0 / 12.0), (DVec3::X, 0.0)]);
    }

    #[test]
    fn a_sun_is_uniform_by_solid_angle() {
        let direction = DVec3::new(0.3, -1.0, 0.2).normalize();
        for angle_deg in [0.53, 20.0, 180.0, 360.0f64] {
            let points = samples(&LightShape::Directional { direction, angle_deg }, CENTER);
            let edge = (angle_deg.to_radians() * 0.5).cos();
            let cos: Vec<f64> = points.iter().map(|d| -d.truncate().dot(direction)).collect();
            assert!(points.iter().all(|d| d.w == 0.0 && (d.length() - 1.0).abs() < 1e-12), "{angle_deg}: not unit");
            assert!(cos.iter().all(|c| *c >= edge - 1e-12), "{angle_deg}: outside the cone");
            // The cosine is uniform over [edge, 1]: mean in the middle, variance width² / 12.
            let mean = cos.iter().sum::<f64>() / N as f64;
            let variance = cos.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / N as f64;
            assert!((mean - (1.0 + edge) / 2.0).abs() < 2e-3 * (1.0 - edge), "{angle_deg}: mean cosine {mean}");
            let want = (1.0 - edge).powi(2) / 12.0;
            assert!((variance / want - 1.0).abs() < 0.01, "{angle_deg}: variance {variance} instead of {want}");
        }
    }

    #[test]
    fn hard_lights_are_their_centre() {
        let direction = DVec3::new(0.6, -0.8, 0.0);
        let spot = LightShape::Spot { position: CENTER, direction, inner_angle_deg: 10.0, outer_angle_deg: 20.0 };
        let directional = LightShape::Directional { direction, angle_deg: 0.0 };
        for shape in [LightShape::Point { position: CENTER }, spot, directional] {
            assert!(samples(&shape, DVec3::ZERO).iter().all(|q| *q == shape.center()), "{shape:?}");
        }
    }

    #[test]
    fn a_textured_rectangle_shines_where_its_picture_is_bright() {
        // White in the top left corner for somebody who looks at the emitting side, black
        // elsewhere.
        let mut rgba = vec![[0, 0, 0, 255]; 4];
        rgba[0] = [255; 4];
        let texture = Texture { name: "corner".into(), width: 2, height: 2, rgba, sampling: Default::default() };
        let rect = LightShape::Rect {
            position: DVec3::ZERO,
            direction: DVec3::Z,
            up: DVec3::Y,
            size: DVec2::new(4.0, 2.0),
            texture: Some(0),
        };
        let sampler = LightSampler::new(&rect, std::slice::from_ref(&texture));
        let from = sampler.at(DVec3::new(0.0, 0.0, 5.0));
        // The viewer in front of +Z sees −X on the left.
        for u in lattice(200) {
            let q = from.sample(u);
            assert!(q.x <= 1e-12 && q.x >= -2.0 && q.y >= -1e-12 && q.y <= 1.0 && q.z == 0.0, "{q}");
        }
        // A texture that is not there is as good as none.
        let uniform = LightSampler::new(&rect, &[]);
        assert_eq!(uniform.at(DVec3::ZERO).sample(DVec2::ZERO), DVec4::new(-2.0, 1.0, 0.0, 1.0));
    }

    #[test]
    fn degenerate_lights_and_receivers_give_finite_points() {
        let flat = |radii| LightShape::Ellipsoid { position: CENTER, radii, rotation: DMat3::IDENTITY };
        let shapes = [
            LightShape::Sphere { position: CENTER, radius: 0.0 },
            LightShape::Sphere { position: CENTER, radius: 1.0 },
            LightShape::Disc { position: CENTER, direction: DVec3::ZERO, radius: 1.0 },
            flat(DVec3::ZERO),
            flat(DVec3::new(1.0, 0.0, 2.0)),
            flat(DVec3::new(0.0, 0.0, 2.0)),
            flat(DVec3::new(1e-200, 1e200, 1.0)),
            LightShape::Line { from: CENTER, to: CENTER },
            LightShape::Rect { position: CENTER, direction: DVec3::Z, up: DVec3::Y, size: DVec2::ZERO, texture: None },
            LightShape::Directional { direction: DVec3::ZERO, angle_deg: 1.0 },
        ];
        for shape in &shapes {
            for p in [CENTER, DVec3::ZERO, CENTER + 1e-300, DVec3::splat(1e12)] {
                assert!(samples(shape, p).iter().all(|q| q.is_finite()), "{shape:?} from {p}");
            }
        }
    }

    #[test]
    fn a_flat_ellipsoid_is_seen_as_its_ellipse() {
        let flat = LightShape::Ellipsoid {
            position: DVec3::ZERO,
            radii: DVec3::new(2.0, 0.0, 1.0),
            rotation: DMat3::IDENTITY,
        };
        let points = samples(&flat, DVec3::new(3.0, 4.0, 1.0));
        assert_moments("flat", &points, DVec3::ZERO, &[(DVec3::X, 1.0), (DVec3::Y, 0.0), (DVec3::Z, 0.25)]);
    }
}
