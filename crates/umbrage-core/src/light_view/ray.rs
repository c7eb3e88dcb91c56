//! From places of a map back to the world.

use super::LightView;
use glam::{DMat3, DVec2, DVec3};

impl LightView {
    /// The ray of the light that belongs to a place of the map, texels from its left top corner:
    /// where it starts, at the light or where the nearest caster may be, and a direction of any
    /// length; of parallel light it ends at the farthest receiver.
    pub fn ray(&self, texel: DVec2) -> (DVec3, DVec3) {
        let half = 0.5 * f64::from(self.size);
        let ndc = DVec2::new(texel.x / half - 1.0, 1.0 - texel.y / half);
        if self.paraboloid.is_none() && !self.is_perspective() {
            let world_from_clip = self.clip_from_world.inverse();
            let [from, to] = [1.0, 0.0].map(|depth| world_from_clip.project_point3(ndc.extend(depth)));
            return (from, to - from);
        }
        let way = match &self.paraboloid {
            None => ndc.extend(1.0),
            Some(paraboloid) => {
                let plane = (ndc - paraboloid.axis) / paraboloid.scale;
                (plane * 2.0).extend(1.0 - plane.length_squared())
            }
        };
        let rows = [0, 1, 3].map(|i| self.clip_from_world.row(i).truncate());
        let axes = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        (self.eye(), axes.inverse() * way)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frustum::Frustum;
    use crate::light::LightShape;
    use crate::light_view::{Fit, FitScene, Focus, Omni, fit};
    use crate::{Bounds, Camera};

    #[test]
    fn points_of_the_ray_fall_on_the_texel_that_it_is_of() {
        let scene = Bounds { min: DVec3::new(-3.0, 0.0, -2.0), max: DVec3::new(3.0, 2.0, 4.0) };
        let scene = FitScene::new(vec![scene], vec![scene]);
        let seen: Frustum = Camera::default().view(4, 3).frustum();
        let (position, direction) = (DVec3::new(1.0, 5.0, 0.5), DVec3::new(0.3, -1.0, 0.2).normalize());
        let spot = LightShape::Spot { position, direction, inner_angle_deg: 20.0, outer_angle_deg: 30.0 };
        let parallel = LightShape::Directional { direction, angle_deg: 0.0 };
        let point = LightShape::Point { position: DVec3::new(0.2, 1.0, 0.3) };
        let mut count = 0;
        for light in [spot, parallel, point] {
            for omni in [Omni::Cube, Omni::Tetrahedral, Omni::DualParaboloid] {
                let mut views = Vec::new();
                let how = Fit { focus: Focus::Visible, omni, size: 64, border_texels: 2.0, border_m: 0.0 };
                fit(&light, &seen, &scene, &how, &mut views);
                for view in &views {
                    for texel in [DVec2::new(5.5, 40.0), DVec2::splat(32.0), DVec2::new(60.0, 3.0)] {
                        let (from, way) = view.ray(texel);
                        let ndc = view.project(from + way * 0.7).unwrap_or(DVec3::INFINITY);
                        let back = DVec2::new(ndc.x + 1.0, 1.0 - ndc.y) * 32.0;
                        assert!(back.distance(texel) < 1e-6, "{light:?}, {omni:?}: {back} instead of {texel}");
                        count += 1;
                    }
                }
            }
        }
        assert!(count > 20, "{count}");
    }
}
