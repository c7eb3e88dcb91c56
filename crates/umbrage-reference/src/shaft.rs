//! All the ways from a point to a light, as a volume.

use glam::DVec3;

/// A volume that holds every ray from a point to a sphere, or to a cone of directions: a pyramid
/// around their cone and, for a sphere, the plane behind it.
pub(crate) struct Shaft {
    apex: DVec3,
    /// Outward normals of planes through the apex.
    sides: [DVec3; 8],
    /// Unit direction to the middle.
    axis: DVec3,
    /// How far along the axis the volume goes.
    length: f64,
    /// Room for rounding, metres.
    slack: f64,
}

impl Shaft {
    /// The rays from `apex` to the sphere around `center`. `None` where the apex is in the sphere,
    /// or so near that the cone is wider than 60 degrees to either side. `scale` is the largest
    /// coordinate that occurs.
    pub fn to_ball(apex: DVec3, center: DVec3, radius: f64, scale: f64) -> Option<Self> {
        let distance = apex.distance(center);
        let shaft = Self::to_cone(apex, center - apex, radius / distance, scale)?;
        Some(Self { length: distance + radius, ..shaft })
    }

    /// The rays from `apex` along directions whose angle to `axis` has at most the sine `sine`; as
    /// [`Shaft::to_ball`].
    pub fn to_cone(apex: DVec3, axis: DVec3, sine: f64, scale: f64) -> Option<Self> {
        let axis = axis.normalize_or_zero();
        // Written so that NaN is refused too.
        if !(axis != DVec3::ZERO && sine < 0.866) {
            return None;
        }
        let cosine = (1.0 - sine * sine).sqrt();
        let (x, y) = axis.any_orthonormal_pair();
        let sides = std::array::from_fn(|k| {
            let around = glam::DVec2::from_angle(k as f64 * std::f64::consts::FRAC_PI_4);
            (x * around.x + y * around.y) * cosine - axis * sine
        });
        Some(Self { apex, sides, axis, length: f64::INFINITY, slack: 1e-9 * scale })
    }

    /// False only where the box is surely outside.
    pub fn may_touch_box(&self, min: DVec3, max: DVec3) -> bool {
        let (center, half) = ((min + max) * 0.5 - self.apex, (max - min) * 0.5);
        let nearest = |normal: DVec3| center.dot(normal) - half.dot(normal.abs());
        let farthest = center.dot(self.axis) + half.dot(self.axis.abs());
        farthest >= -self.slack
            && nearest(self.axis) <= self.length + self.slack
            && self.sides.iter().all(|&side| nearest(side) <= self.slack)
    }

    /// False only where the triangle is surely outside.
    pub fn may_touch_triangle(&self, corners: &[DVec3; 3]) -> bool {
        let p = corners.map(|c| c - self.apex);
        let nearest = |normal: DVec3| p[0].dot(normal).min(p[1].dot(normal)).min(p[2].dot(normal));
        -nearest(-self.axis) >= -self.slack
            && nearest(self.axis) <= self.length + self.slack
            && self.sides.iter().all(|&side| nearest(side) <= self.slack)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(range: f64) -> impl Strategy<Value = DVec3> {
        (-range..range, -range..range, -range..range).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        /// Anything that holds a point on a ray to the sphere touches the shaft.
        #[test]
        fn points_on_rays_to_the_ball_are_inside(
            apex in point(5.0), center in point(5.0), radius in 0.0..3.0, u in point(1.0), t in 0.0..1.0,
            a in point(1.0), b in point(1.0),
        ) {
            let Some(shaft) = Shaft::to_ball(apex, center, radius, 8.0) else { return Ok(()) };
            let inside = apex.lerp(center + u.clamp_length_max(1.0) * radius, t);
            prop_assert!(shaft.may_touch_box(inside, inside));
            prop_assert!(shaft.may_touch_box(inside - a.abs(), inside + b.abs()));
            // A triangle with the point as its mean.
            prop_assert!(shaft.may_touch_triangle(&[inside + a, inside + b, inside - a - b]));
        }
    }

    #[test]
    fn what_is_beside_or_behind_is_outside() {
        let Some(shaft) = Shaft::to_ball(DVec3::ZERO, DVec3::X * 10.0, 1.0, 10.0) else { panic!("a narrow shaft") };
        for outside in [DVec3::X * -1.0, DVec3::X * 11.5, DVec3::new(5.0, 0.7, 0.0), DVec3::new(5.0, 0.0, -0.7)] {
            assert!(!shaft.may_touch_box(outside - 0.01, outside + 0.01), "{outside}");
            assert!(!shaft.may_touch_triangle(&[outside, outside + DVec3::X * 0.01, outside]), "{outside}");
        }
        assert!(Shaft::to_ball(DVec3::ZERO, DVec3::X, 1.0, 1.0).is_none());
        assert!(Shaft::to_ball(DVec3::ZERO, DVec3::ZERO, 1.0, 1.0).is_none());
        assert!(Shaft::to_ball(DVec3::ZERO, DVec3::NAN, 1.0, 1.0).is_none());
    }
}
