//! Penumbra wedges: a convex body around every point from which an edge is seen in front of a
//! light.
//!
//! Those points are x + t (x − y), t ≥ 0, for x on the edge and y of the light. For a convex light
//! they are exactly the sum of the edge and of the cone of all directions x − y, and so convex: a
//! half space holds them if it holds both ends of the edge and all directions. Four half spaces
//! bound a wedge. Two hold the edge's line and touch the light on either side (where the line runs
//! through the light, they hold the nearer end alone); two stand across and close its ends. Nothing
//! is moved to make faces planar, so edges in line with the light are no special case (PX 4.1.2 and
//! SG "Practical wedge construction" move an end of the edge, which does not bound the penumbra
//! then).

use glam::{DVec3, DVec4};

/// A convex body around a light: all points within `radius` of what its corners span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightHull {
    /// Points, or for light from infinitely far away unit directions to it. A sphere has its centre
    /// four times.
    pub corners: [DVec3; 4],
    /// Metres, or for directions the sine of the angle.
    pub radius: f64,
    /// Corners are directions.
    pub is_parallel: bool,
}

/// A body of two corners, which may coincide, and four edges that run from them to infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wedge {
    /// The ends of the light-facing edge of the body.
    pub near: [DVec3; 2],
    /// For each of them the directions of two edges: in the front and in the back face.
    pub far: [[DVec3; 2]; 2],
    /// Inside is n · p ≥ w, as (n, w): front, back, and at either end.
    pub planes: [DVec4; 4],
}

impl LightHull {
    /// Directions from all corners to a point.
    fn away(&self, p: DVec3) -> [DVec3; 4] {
        self.corners.map(|y| if self.is_parallel { -y } else { p - y })
    }
}

impl Wedge {
    /// The wedge of the edge between `a` and `b`; `None` where no such body holds it: the edge runs
    /// through the light or next to it, or has no length or place.
    pub fn new(a: DVec3, b: DVec3, light: &LightHull) -> Option<Self> {
        let ends = [a, b];
        let away = ends.map(|p| light.away(p));
        let [from_a, from_b] = away.map(|d| d.iter().sum::<DVec3>().normalize_or_zero());
        let main = (from_a + from_b).try_normalize()?;
        let edge = (b - a).try_normalize()?;
        let across = edge.cross(main).try_normalize().unwrap_or_else(|| main.any_orthonormal_vector());
        let along = main.cross(across);
        let all = away.as_flattened();
        // Across the ends.
        let [low, high] = span(main, along, all, light.radius)?;
        let owner = [low, high].map(|n| if n.dot(a) <= n.dot(b) { 0 } else { 1 });
        // Along the edge.
        let sides = if owner[0] != owner[1] {
            let middle = (main - edge * main.dot(edge)).try_normalize()?;
            span(middle, across, &away[0], light.radius)?
        } else {
            span([from_a, from_b][owner[0]], across, all, light.radius)?
        };
        let normals = [sides[0], sides[1], low, high];
        let far = rays(normals)?;
        let planes = normals.map(|n| n.extend(n.dot(a).min(n.dot(b))));
        Some(Self { near: owner.map(|i| ends[i]), far, planes })
    }

    /// A body around the wedges of several edges, which lie close together where that is worth
    /// anything: four half spaces hold all ends and all directions away from the light. `None` for
    /// no edges, and where no such body holds them.
    pub fn around(edges: &[[DVec3; 2]], light: &LightHull) -> Option<Self> {
        let ends = edges.as_flattened();
        let middle = ends.iter().sum::<DVec3>() / ends.len() as f64;
        let main = light.away(middle).iter().sum::<DVec3>().try_normalize()?;
        let across = main.any_orthonormal_vector();
        let along = main.cross(across);
        let all: Vec<DVec3> = ends.iter().flat_map(|p| light.away(*p)).collect();
        let [[front, back], [low, high]] =
            [span(main, across, &all, light.radius)?, span(main, along, &all, light.radius)?];
        let plane = |n: DVec3| n.extend(ends.iter().map(|p| n.dot(*p - middle)).fold(0.0, f64::min));
        let mut planes = [front, back, low, high].map(plane);
        // Front and back meet in the body's near edge, or else both ends do.
        let near_low = meet([planes[0], planes[1], planes[2]]);
        if planes[3].truncate().dot(near_low) < planes[3].w {
            planes = [planes[2], planes[3], planes[1], planes[0]];
        }
        let near = [2, 3].map(|end| middle + meet([planes[0], planes[1], planes[end]]));
        let planes = planes.map(|p| p.truncate().extend(p.w + p.truncate().dot(middle)));
        Some(Self { near, far: rays(planes.map(DVec4::truncate))?, planes })
    }

    /// How deep inside a point is; negative outside.
    pub fn depth(&self, p: DVec3) -> f64 {
        self.planes.iter().map(|n| n.truncate().dot(p) - n.w).fold(f64::INFINITY, f64::min)
    }
}

/// Directions of a body's edges: at either end in the front and in the back face. Seen from next to
/// a wide light three half spaces may do, and edges of the body lie elsewhere: `None`.
fn rays(normals: [DVec3; 4]) -> Option<[[DVec3; 2]; 2]> {
    let sum: DVec3 = normals.iter().sum();
    let ray = |end: usize, side: usize| {
        let ray = normals[end].cross(normals[side]);
        (ray * ray.dot(sum).signum()).try_normalize()
    };
    let far = [[ray(2, 0)?, ray(2, 1)?], [ray(3, 0)?, ray(3, 1)?]];
    let is_on = |ray: &DVec3| normals.iter().all(|n| n.dot(*ray) > -1e-6);
    far.as_flattened().iter().all(is_on).then_some(far)
}

/// The point in three planes.
fn meet([a, b, c]: [DVec4; 3]) -> DVec3 {
    let [m, n, o] = [a, b, c].map(DVec4::truncate);
    (a.w * n.cross(o) + b.w * o.cross(m) + c.w * m.cross(n)) / m.dot(n.cross(o))
}

/// Of all n = cos φ `axis` + sin φ `other` with n · d ≥ `radius` for every d, the first and the
/// last.
fn span(axis: DVec3, other: DVec3, ds: &[DVec3], radius: f64) -> Option<[DVec3; 2]> {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for d in ds {
        let (x, y) = (d.dot(axis), d.dot(other));
        let length = x.hypot(y);
        // False for what is not a number.
        let is_outside = length > radius;
        if !is_outside {
            return None;
        }
        let (middle, half) = (y.atan2(x), (radius / length).acos());
        low = low.max(middle - half);
        high = high.min(middle + half);
    }
    let normal = |angle: f64| axis * angle.cos() + other * angle.sin();
    (low < high).then(|| [normal(low), normal(high)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(size: f64) -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-size..size).prop_map(DVec3::from_array)
    }

    fn lights() -> impl Strategy<Value = LightHull> {
        let ball = (point(2.0), 0.001..1.5f64).prop_map(|(c, radius)| LightHull {
            corners: [c; 4],
            radius,
            is_parallel: false,
        });
        let rect = (point(2.0), point(1.0), point(1.0)).prop_map(|(c, u, v)| {
            let corners = [c + u + v, c + u - v, c - u - v, c - u + v];
            LightHull { corners, radius: 0.0, is_parallel: false }
        });
        let sun = (point(1.0), 0.0001..0.4f64).prop_filter_map("no direction", |(d, radius)| {
            Some(LightHull { corners: [d.try_normalize()?; 4], radius, is_parallel: true })
        });
        prop_oneof![ball, rect, sun]
    }

    /// A point of the light, or a direction.
    fn of_light(light: &LightHull, u: f64, v: f64, offset: DVec3) -> DVec3 {
        let [a, b, c, d] = light.corners;
        let flat = (a * u + b * (1.0 - u)) * v + (d * u + c * (1.0 - u)) * (1.0 - v);
        let offset = offset.normalize_or_zero();
        if light.is_parallel {
            // Within the cone of directions.
            let aside = (offset - flat * offset.dot(flat)).normalize_or_zero();
            flat * (1.0 - light.radius * light.radius).sqrt() + aside * light.radius
        } else {
            flat + offset * light.radius
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn points_that_see_the_edge_before_the_light_are_inside(
            light in lights(),
            (a, way, length) in (point(3.0), point(1.0), -4.0..1.0f64),
            samples in prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64, 0.0..=1.0f64, point(1.0), -3.0..3.0f64), 16),
        ) {
            let b = a + way * 10_f64.powf(length);
            let Some(wedge) = Wedge::new(a, b, &light) else { return Ok(()) };
            for (s, u, v, offset, t) in samples {
                let x = a.lerp(b, s);
                let y = of_light(&light, u, v, offset);
                let away = if light.is_parallel { -y } else { x - y };
                let p = x + away * 10_f64.powf(t);
                let depth = wedge.depth(p);
                prop_assert!(depth > -1e-9 * (1.0 + p.length()), "{p} is {depth} outside of {wedge:?}");
            }
        }

        #[test]
        fn corners_and_rays_lie_in_all_planes(light in lights(), a in point(3.0), b in point(3.0)) {
            let Some(wedge) = Wedge::new(a, b, &light) else { return Ok(()) };
            prop_assert!(wedge.planes.iter().all(|p| p.is_finite()));
            for (near, rays) in wedge.near.iter().zip(&wedge.far) {
                prop_assert!(wedge.depth(*near) > -1e-9);
                for ray in rays {
                    for plane in &wedge.planes {
                        prop_assert!(plane.truncate().dot(*ray) > -2e-6, "{ray} leaves {plane} of {wedge:?}");
                    }
                }
            }
        }

        #[test]
        fn a_body_around_edges_holds_their_wedges(
            light in lights(),
            (middle, size) in (point(3.0), -4.0..0.5f64),
            ends in prop::collection::vec((point(1.0), point(1.0)), 1..5),
            samples in prop::collection::vec((0..4usize, 0.0..=1.0f64, 0.0..=1.0f64, 0.0..=1.0f64, point(1.0), -3.0..3.0f64), 16),
        ) {
            let edges: Vec<_> = ends.iter().map(|(a, b)| [a, b].map(|p| middle + *p * 10_f64.powf(size))).collect();
            let Some(body) = Wedge::around(&edges, &light) else { return Ok(()) };
            for (edge, s, u, v, offset, t) in samples {
                let [a, b] = edges[edge % edges.len()];
                let x = a.lerp(b, s);
                let y = of_light(&light, u, v, offset);
                let away = if light.is_parallel { -y } else { x - y };
                let p = x + away * 10_f64.powf(t);
                let depth = body.depth(p);
                prop_assert!(depth > -1e-9 * (1.0 + p.length()), "{p} is {depth} outside of {body:?}");
            }
            // The near edge is where front and back meet, and lies between both ends.
            for (near, rays) in body.near.iter().zip(&body.far) {
                let least = body.depth(*near);
                prop_assert!(least > -1e-6 * (1.0 + near.length()), "{near} is {least} outside of {body:?}");
                for ray in rays {
                    prop_assert!(body.planes.iter().all(|p| p.truncate().dot(*ray) > -2e-6), "{ray} leaves {body:?}");
                }
            }
        }

        /// So would a body.
        #[test]
        fn a_body_around_far_edges_is_thin(a in point(0.1), b in point(0.1), c in point(0.1)) {
            let light = LightHull { corners: [DVec3::Y * 100.0; 4], radius: 0.1, is_parallel: false };
            let body = Wedge::around(&[[a, b], [b, c]], &light).expect("the light is far away");
            let shadow = (a + b + c) / 3.0 - DVec3::Y * 10.0;
            prop_assert!(body.depth(shadow) > 0.0);
            for aside in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
                prop_assert!(body.depth(shadow + aside * 0.4) < 0.0, "{aside}");
            }
            prop_assert!(body.depth(DVec3::Y * 60.0) < 0.0);
        }

        /// A wedge that holds everything would pass the other tests.
        #[test]
        fn a_far_edge_has_a_thin_wedge(a in point(1.0), way in point(1.0)) {
            let light = LightHull { corners: [DVec3::Y * 100.0; 4], radius: 0.1, is_parallel: false };
            let along = DVec3::new(way.x, 0.0, way.z).normalize_or(DVec3::X);
            let wedge = Wedge::new(a, a + along, &light).expect("the light is far away");
            let aside = along.cross(DVec3::Y);
            // Two metres further on the penumbra is some 2 m · 0.1 / 100 wide to either side.
            let shadow = a + along * 0.5 + (a + along * 0.5 - DVec3::Y * 100.0) * 0.02;
            prop_assert!(wedge.depth(shadow) > 0.0);
            for side in [0.005, -0.005] {
                prop_assert!(wedge.depth(shadow + aside * side) < 0.0);
            }
            prop_assert!(wedge.depth(shadow + along * 0.6) < 0.0);
            prop_assert!(wedge.depth(shadow - along * 0.6) < 0.0);
            prop_assert!(wedge.depth(a + DVec3::Y) < 0.0);
        }
    }

    #[test]
    fn an_edge_in_line_with_the_light_has_a_wedge() {
        let light = LightHull { corners: [DVec3::Y * 5.0; 4], radius: 0.5, is_parallel: false };
        let wedge = Wedge::new(DVec3::Y * 2.0, DVec3::Y, &light).expect("it is outside of the light");
        assert!(wedge.depth(DVec3::ZERO) > 0.0);
        assert!(wedge.depth(DVec3::X) < 0.0);
        assert!(Wedge::new(DVec3::Y * 4.8, DVec3::Y, &light).is_none(), "an end lies in the light");
        assert!(Wedge::new(DVec3::Y, DVec3::Y, &light).is_none(), "no length");
        assert!(Wedge::around(&[], &light).is_none(), "no edges");
        assert!(Wedge::around(&[[DVec3::Y * 4.8, DVec3::Y]], &light).is_none(), "an end lies in the light");
    }
}
