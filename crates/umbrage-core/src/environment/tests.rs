use super::*;
use crate::sampling::lattice;

fn picture(width: u32, height: u32, f: impl Fn(u32, u32) -> [f32; 3]) -> Sky {
    Sky::Picture(SkyPicture::new(Image::from_fn(width, height, f)).expect("a picture"))
}

fn daylight() -> Sky {
    let sky = Daylight::new(DVec3::new(0.3, 0.6, -0.5), 3.0, Vec3::splat(0.2), 2.0);
    Sky::Daylight(sky.expect("a sky"))
}

/// Every kind of sky, one of them all but black with one bright pixel.
fn skies() -> Vec<Sky> {
    let gradient = Gradient { zenith: Vec3::new(0.2, 0.4, 1.0), horizon: Vec3::ONE, nadir: Vec3::splat(0.1) };
    vec![
        Sky::Constant(Vec3::new(0.5, 1.0, 2.0)),
        Sky::Gradient(gradient),
        picture(16, 8, |x, y| [x as f32, y as f32 * 0.5, if (x, y) == (11, 2) { 900.0 } else { 0.0 }]),
        picture(1, 1, |_, _| [1.0, 2.0, 3.0]),
        daylight(),
    ]
}

/// The integral over the sphere by a fine grid.
fn integral(sky: &Sky) -> DVec3 {
    let image = sky.picture(256, 128);
    let of_row = |y: u32| (0..256).map(move |x| (x, y));
    let light = |(x, y): (u32, u32)| Vec3::from(image[(x, y)]).as_dvec3() * solid_angle(256, 128, y);
    (0..128).flat_map(of_row).map(light).sum()
}

#[test]
fn pixels_are_seen_where_the_format_says() {
    // The middle is −Z, three quarters +X, the left side +Z, one quarter −X; row 0 is +Y.
    for (u, v, direction) in [
        (0.5, 0.5, DVec3::NEG_Z),
        (0.75, 0.5, DVec3::X),
        (0.25, 0.5, DVec3::NEG_X),
        (0.0, 0.5, DVec3::Z),
        (0.3, 0.0, DVec3::Y),
        (0.3, 1.0, DVec3::NEG_Y),
    ] {
        assert!((direction_of(DVec2::new(u, v)) - direction).length() < 1e-12, "{u} {v}");
        let back = place_of(direction);
        assert!((back.y - v).abs() < 1e-12 && (direction.y != 0.0 || (back.x - u).abs() % 1.0 < 1e-12), "{back}");
    }
    let sky = picture(8, 4, |x, y| [(x + 8 * y) as f32, 0.0, 0.0]);
    for (x, y) in (0..4).flat_map(|y| (0..8).map(move |x| (x, y))) {
        // At the poles all columns of a row meet; a little beside them each is apart.
        let mut place = place_of_pixel((8, 4), x, y);
        place.y = place.y.clamp(1e-7, 1.0 - 1e-7);
        let got = sky.radiance(direction_of(place)).x;
        assert!((got - (x + 8 * y) as f32).abs() < 1e-4, "pixel ({x}, {y}): {got}");
    }
}

#[test]
fn between_pixels_it_is_interpolated_and_around_the_seam_too() {
    let sky = picture(4, 2, |x, _| [x as f32, 0.0, 0.0]);
    let at = |u: f64| sky.radiance(direction_of(DVec2::new(u, 0.5))).x;
    assert!((at(0.25) - 0.5).abs() < 1e-6 && (at(0.6) - 1.9).abs() < 1e-6);
    // Between the last column, 3, and the first, 0.
    assert!((at(0.0) - 1.5).abs() < 1e-6 && (at(0.9375) - 2.25).abs() < 1e-6);
}

#[test]
fn a_turn_takes_what_is_seen_ahead_to_the_left() {
    // R(90°) takes −Z to −X.
    let sky = picture(64, 32, |x, _| [if (24..40).contains(&x) { 1.0 } else { 0.0 }, 0.0, 0.0]);
    let turned = Environment { rotate_deg: 90.0, intensity: 3.0, ..Environment::new(sky) };
    assert_eq!(turned.radiance(DVec3::NEG_X).x, 3.0);
    assert_eq!(turned.radiance(DVec3::NEG_Z).x, 0.0);
    assert!((turned.world_from_sky() * DVec3::Z - DVec3::X).length() < 1e-12);
}

#[test]
fn directions_are_drawn_as_densely_as_is_said() {
    for sky in skies() {
        let environment = Environment { rotate_deg: 33.0, ..Environment::new(sky) };
        let sampler = EnvironmentSampler::new(&environment);
        // Light over density gives the integral over the sphere, whatever the density.
        let (n, mut sum) = (20_000, DVec3::ZERO);
        for u in lattice(n) {
            let (direction, density) = sampler.sample(u);
            assert!((direction.length() - 1.0).abs() < 1e-9 && density > 0.0, "{direction} {density}");
            let again = sampler.density(direction);
            assert!((again / density - 1.0).abs() < 1e-6 || density > again, "{density} then {again}");
            sum += environment.radiance(direction).as_dvec3() / density / n as f64;
        }
        let want = integral(&environment.sky);
        assert!((sum / want - 1.0).abs().max_element() < 0.02, "{:?}: {sum} instead of {want}", environment.sky);
    }
}

#[test]
fn bright_directions_are_drawn_more_often() {
    let sky = picture(32, 16, |x, y| [if (x, y) == (20, 4) { 1e4 } else { 0.01 }; 3]);
    let sampler = EnvironmentSampler::new(&Environment::new(sky));
    let bright = direction_of(place_of_pixel((32, 16), 20, 4));
    let near = lattice(1000).into_iter().filter(|u| sampler.sample(*u).0.dot(bright) > 0.9).count();
    assert!(near > 980, "{near} of 1000");
}

#[test]
fn pictures_of_a_sky_lose_no_light() {
    let gradient = Gradient { zenith: Vec3::ONE, horizon: Vec3::ZERO, nadir: Vec3::ZERO };
    let up = Sky::Gradient(gradient).picture(32, 16);
    let irradiance: f64 =
        (0..16).map(|y| (0..32).map(|x| f64::from(up[(x, y)][0]) * solid_angle(32, 16, y)).sum::<f64>()).sum();
    // The integral of the sine of the elevation over the upper half is π.
    assert!((irradiance / PI - 1.0).abs() < 2e-3, "{irradiance}");
    let coarse = daylight().picture(16, 8);
    let light = |image: &Image<[f32; 3]>| -> f64 {
        let (w, h) = image.size();
        (0..h).map(|y| (0..w).map(|x| f64::from(image[(x, y)][1]) * solid_angle(w, h, y)).sum::<f64>()).sum()
    };
    assert!((light(&coarse) / light(&daylight().picture(256, 128)) - 1.0).abs() < 0.02);
    let bright = picture(64, 32, |x, y| [0.0, if (x, y) == (40, 9) { 1e4 } else { 0.1 }, 0.0]);
    assert!((light(&bright.picture(16, 8)) / light(&bright.picture(256, 128)) - 1.0).abs() < 0.02);
}

#[test]
fn a_clear_sky_is_blue_and_as_bright_as_measured() {
    let Sky::Daylight(sky) = daylight() else { return };
    // The paper's figures: some thousand candela a square metre, bluer away from the sun.
    let zenith = sky.sky_radiance(DVec3::Y);
    assert!(zenith.z > zenith.x && (1.0..20.0).contains(&zenith.y), "{zenith}");
    let sun = sky.sun().radiance.as_dvec3() * sky.sun().solid_angle();
    assert!((60.0..110.0).contains(&sun.y) && sun.x > sun.z, "thousands of lux: {sun}");
    // Near the sun the sky is brighter than opposite to it.
    let opposite = DVec3::new(-0.3, 0.6, 0.5).normalize();
    assert!(sky.sky_radiance(sky.sun().direction).y > 3.0 * sky.sky_radiance(opposite).y);
    assert!(sky.radiance(sky.sun().direction).y > 1e3 * sky.radiance(opposite).y);
    for y in -20..=20 {
        let direction = DVec3::new(0.2, f64::from(y) * 0.05, 1.0).normalize();
        assert!(sky.radiance(direction).is_finite() && sky.radiance(direction).min_element() >= 0.0);
    }
}

#[test]
fn what_cannot_shine_is_refused() {
    let new =
        |pixel: [f32; 3]| SkyPicture::new(Image::from_fn(3, 2, |x, y| if (x, y) == (2, 1) { pixel } else { [1.0; 3] }));
    for wrong in [[f32::NAN, 0.0, 0.0], [0.0, -0.1, 0.0], [0.0, 0.0, f32::INFINITY]] {
        let error = new(wrong).expect_err("no radiance");
        assert!(error.contains("pixel (2, 1)"), "{error}");
    }
    assert!(SkyPicture::new(Image { width: 0, height: 3, data: vec![] }).is_err());
    assert!(SkyPicture::new(Image { width: 2, height: 3, data: vec![[0.0; 3]] }).is_err());
    let daylight = |sun, turbidity, ground| Daylight::new(sun, turbidity, Vec3::splat(ground), 0.5);
    for (made, says) in [
        (daylight(DVec3::NEG_Y, 3.0, 0.2), "above the horizon"),
        (daylight(DVec3::ZERO, 3.0, 0.2), "above the horizon"),
        (daylight(DVec3::NAN, 3.0, 0.2), "above the horizon"),
        (daylight(DVec3::Y, 1.0, 0.2), "turbidity 1"),
        (daylight(DVec3::Y, f64::NAN, 0.2), "turbidity NaN"),
        (daylight(DVec3::Y, 3.0, 1.2), "ground"),
    ] {
        let error = made.expect_err(says);
        assert!(error.contains(says), "{error}");
    }
    let wrong = [
        Environment { intensity: -1.0, ..Environment::new(Sky::Constant(Vec3::ONE)) },
        Environment { rotate_deg: f64::INFINITY, ..Environment::new(Sky::Constant(Vec3::ONE)) },
        Environment::new(Sky::Constant(Vec3::new(0.0, f32::NAN, 0.0))),
    ];
    assert!(wrong.iter().all(|environment| environment.check().is_err()));
    assert!(skies().into_iter().all(|sky| Environment::new(sky).check().is_ok()));
}

#[test]
fn black_skies_can_be_sampled() {
    for sky in [Sky::Constant(Vec3::ZERO), picture(4, 2, |_, _| [0.0; 3])] {
        let sampler = EnvironmentSampler::new(&Environment::new(sky));
        assert!(sampler.is_even());
        for u in lattice(50) {
            let (direction, density) = sampler.sample(u);
            assert!((direction.length() - 1.0).abs() < 1e-9 && density > 0.0, "{direction} {density}");
        }
    }
}

#[test]
fn text_about_a_picture_is_short_and_tells_it_from_others() {
    let text = |value: f32| format!("{:?}", picture(64, 32, |x, _| [x as f32, value, 0.0]));
    assert!(text(1.0).len() < 80 && text(1.0) != text(2.0) && text(1.0) == text(1.0));
}
