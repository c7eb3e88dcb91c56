//! How large the texels of a map are on the screen.

use crate::score::percentile;
use umbrage_core::glam::{DVec2, Vec3};
use umbrage_core::light_view::{LightView, texel_on_screen};
use umbrage_core::{Camera, Image};

/// Texels of a map that a shadow edge may be off by without counting as acne or a leak.
const TEXELS: f32 = 2.0;

/// For each pixel the size of a texel of the map there as seen on the screen, pixels; 0 where
/// nothing is or no map covers the surface. `views` and `splits` are those of [`texel_on_screen`].
///
/// `depth` is along the view direction, metres, 0 where nothing is; `normal` is geometric.
pub fn texel_footprint(
    views: &[LightView],
    splits: &[f64],
    camera: &Camera,
    depth: &Image<f32>,
    normal: &Image<Vec3>,
) -> Image<f32> {
    let (width, height) = depth.size();
    let view = camera.view(width, height);
    Image::from_fn(width, height, |x, y| {
        let depth = f64::from(depth[(x, y)]);
        if depth <= 0.0 {
            return 0.0;
        }
        let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let point = camera.start(pixel, width, height) + camera.ray(pixel, width, height) * depth;
        let texel = texel_on_screen(views, splits, &view, (width, height), point, normal[(x, y)].as_dvec3());
        texel.unwrap_or(0.0) as f32
    })
}

/// For each pixel the reach within which a technique with these maps is judged by its resolution,
/// pixels: two texels as seen on the screen, see [`texel_footprint`]. To be given to
/// [`interior`](crate::interior()), which raises it to 3.
pub fn map_reach(
    views: &[LightView],
    splits: &[f64],
    camera: &Camera,
    depth: &Image<f32>,
    normal: &Image<Vec3>,
) -> Image<f32> {
    reach_of(&texel_footprint(views, splits, camera, depth, normal))
}

/// The same of a [`texel_footprint`] that is already known. A map with a texel without end does not
/// show the place at all, which is no question of its resolution: there it is judged as if there
/// were none.
pub fn reach_of(footprint: &Image<f32>) -> Image<f32> {
    footprint.map(|&texel| if texel.is_finite() { TEXELS * texel } else { 0.0 })
}

/// Sizes of texels on the screen, pixels: where they are large, shadow edges are jagged; under 1
/// they are wasted. Infinite where so many pixels show what a map has no room for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aliasing {
    /// Half of the pixels have no larger one.
    pub median: f64,
    /// 95 of 100 pixels have no larger one.
    pub p95: f64,
    /// 99 of 100 pixels have no larger one.
    pub p99: f64,
}

/// Of a [`texel_footprint`] over the pixels of a mask; `None` where no map covers any of them.
pub fn aliasing(footprint: &Image<f32>, mask: &Image<bool>) -> Option<Aliasing> {
    let counted = footprint.data.iter().zip(&mask.data).filter(|(texel, counts)| **texel > 0.0 && **counts);
    let mut sizes: Vec<f64> = counted.map(|(texel, _)| f64::from(*texel)).collect();
    sizes.sort_by(f64::total_cmp);
    let at = |share| percentile(&sizes, share);
    (!sizes.is_empty()).then(|| Aliasing { median: at(0.5), p95: at(0.95), p99: at(0.99) })
}

/// What has no texels in pictures of footprints.
const NONE: [u8; 3] = [18, 18, 26];
/// Sizes of texels, pixels, and the colours in between which others lie.
const COLORS: [(f64, [f64; 3]); 5] = [
    (0.25, [30.0, 60.0, 160.0]),
    (1.0, [70.0, 170.0, 200.0]),
    (2.0, [235.0, 235.0, 215.0]),
    (4.0, [240.0, 150.0, 50.0]),
    (16.0, [150.0, 10.0, 30.0]),
];

/// A [`texel_footprint`] in sRGB: blue where texels are smaller than pixels, white at 2 pixels, red
/// where they are large; almost black where there are none.
pub fn footprint_colors(footprint: &Image<f32>) -> Image<[u8; 3]> {
    footprint.map(|&texel| if texel > 0.0 { color(texel.into()) } else { NONE })
}

fn color(texel: f64) -> [u8; 3] {
    let mut found = COLORS[0].1;
    for pair in COLORS.windows(2) {
        let [(low, from), (high, to)] = [pair[0], pair[1]];
        let share = ((texel / low).ln() / (high / low).ln()).clamp(0.0, 1.0);
        if texel > low {
            found = [0, 1, 2].map(|i| from[i] + (to[i] - from[i]) * share);
        }
    }
    found.map(|c| c.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::DVec3;
    use umbrage_core::light_view::{Fit, FitScene, Focus, Omni, fit};
    use umbrage_core::{Bounds, LightShape};

    #[test]
    fn a_texel_without_end_excuses_nothing() {
        let footprint = Image { width: 3, height: 1, data: vec![0.5, f32::INFINITY, 0.0] };
        assert_eq!(reach_of(&footprint).data, [1.0, 0.0, 0.0]);
    }

    #[test]
    fn a_map_of_half_the_texels_reaches_twice_as_far() {
        let floor = Bounds { min: DVec3::new(-5.0, 0.0, -5.0), max: DVec3::new(5.0, 0.0, 5.0) };
        let scene = FitScene::new(vec![floor], vec![floor]);
        let camera = Camera { eye: DVec3::new(0.0, 9.0, 0.1), ..Camera::default() };
        let light = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
        let depth = Image::filled(64, 64, 9.0);
        let normal = Image::filled(64, 64, Vec3::Y);
        let reach = |size, splits: &[f64]| {
            let mut views = Vec::new();
            let to_fit = Fit { focus: Focus::Light, omni: Omni::Cube, size, border_texels: 0.0, border_m: 0.0 };
            fit(&light, &camera.view(64, 64).frustum(), &scene, &to_fit, &mut views);
            map_reach(&views, splits, &camera, &depth, &normal)[(32, 32)]
        };
        assert!(reach(64, &[]) > 1.0 && (reach(64, &[]) / reach(128, &[]) - 2.0).abs() < 1e-3);
        assert_eq!(reach(64, &[20.0]), reach(64, &[]), "the first of two views covers what is near");
        assert_eq!(reach(64, &[5.0]), 0.0, "there is no second view for what is far");
        assert_eq!(map_reach(&[], &[], &camera, &depth, &normal)[(32, 32)], 0.0);
    }

    #[test]
    fn percentiles_are_of_what_is_counted_and_covered() {
        let footprint = Image::from_fn(200, 2, |x, y| if y == 0 { x as f32 } else { 1e6 });
        let mask = Image::from_fn(200, 2, |x, y| y == 0 && x <= 101);
        // 1 to 101; 0 is not covered.
        let found = aliasing(&footprint, &mask);
        assert_eq!(found, Some(Aliasing { median: 51.0, p95: 96.0, p99: 100.0 }));
        assert_eq!(aliasing(&footprint, &Image::filled(200, 2, false)), None);
        assert_eq!(aliasing(&Image::filled(3, 3, 0.0), &Image::filled(3, 3, true)), None);
    }

    #[test]
    fn colours_run_from_blue_to_red() {
        let of = |texel: f32| footprint_colors(&Image::filled(1, 1, texel)).data[0];
        assert_eq!((of(0.0), of(2.0)), (NONE, [235, 235, 215]));
        assert!(of(0.01) == [30, 60, 160] && of(f32::INFINITY) == [150, 10, 30]);
        assert!(of(0.5)[2] > of(0.5)[0] && of(8.0)[0] > of(8.0)[2], "{:?} {:?}", of(0.5), of(8.0));
    }
}
