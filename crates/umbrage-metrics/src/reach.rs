//! How large the texels of a map are on the screen.

use umbrage_core::glam::{DVec2, Vec3};
use umbrage_core::light_view::{LightView, texel_on_screen};
use umbrage_core::{Camera, Image};

/// Texels of a map that a shadow edge may be off by without counting as acne or a leak.
const TEXELS: f64 = 2.0;

/// For each pixel the reach within which a technique with these maps is judged by its resolution, pixels: two texels as
/// seen on the screen, 0 where nothing is or no map covers the surface. To be given to
/// [`interior`](crate::interior()), which raises it to 3.
///
/// `depth` is along the view direction, metres, 0 where nothing is; `normal` is geometric.
pub fn map_reach(views: &[LightView], camera: &Camera, depth: &Image<f32>, normal: &Image<Vec3>) -> Image<f32> {
    let (width, height) = depth.size();
    let view = camera.view(width, height);
    Image::from_fn(width, height, |x, y| {
        let depth = f64::from(depth[(x, y)]);
        if depth <= 0.0 {
            return 0.0;
        }
        let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let point = camera.eye + camera.ray(pixel, width, height) * depth;
        let texel = texel_on_screen(views, &view, (width, height), point, normal[(x, y)].as_dvec3());
        texel.map_or(0.0, |t| (TEXELS * t) as f32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::DVec3;
    use umbrage_core::light_view::{Fit, FitScene, Focus, Omni, fit};
    use umbrage_core::{Bounds, LightShape};

    #[test]
    fn a_map_of_half_the_texels_reaches_twice_as_far() {
        let floor = Bounds { min: DVec3::new(-5.0, 0.0, -5.0), max: DVec3::new(5.0, 0.0, 5.0) };
        let scene = FitScene { casters: vec![floor], receivers: vec![floor] };
        let camera = Camera { eye: DVec3::new(0.0, 9.0, 0.1), ..Camera::default() };
        let light = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
        let depth = Image::filled(64, 64, 9.0);
        let normal = Image::filled(64, 64, Vec3::Y);
        let reach = |size| {
            let mut views = Vec::new();
            let to_fit = Fit { focus: Focus::Light, omni: Omni::Cube, size, border_texels: 0.0 };
            fit(&light, &camera.view(64, 64), &scene, &to_fit, &mut views);
            map_reach(&views, &camera, &depth, &normal)[(32, 32)]
        };
        assert!(reach(64) > 1.0 && (reach(64) / reach(128) - 2.0).abs() < 1e-3);
        assert_eq!(map_reach(&[], &camera, &depth, &normal)[(32, 32)], 0.0);
    }
}
