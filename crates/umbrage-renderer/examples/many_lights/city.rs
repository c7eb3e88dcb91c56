//! The city, its lamps, and what they cost.

use umbrage::core::glam::{DAffine3, DQuat, DVec3, Vec3, Vec4};
use umbrage::core::{Camera, Image, Light, LightShape, Material, Scene, primitive, scenes};
use umbrage::{Error, Gpu};
use umbrage_renderer::{LightPass, Renderer};
use web_time::Instant;

/// Bytes for the maps of all lamps.
pub const BUDGET: u64 = 32 << 20;

/// Across, up and along, metres.
const SIZE_OF_CAR: DVec3 = DVec3::new(1.8, 1.4, 4.2);

/// What some lamps cost.
pub struct Measured {
    /// The picture.
    pub picture: Image<[u8; 4]>,
    /// The first frame: all that is made once.
    pub first_ms: f64,
    /// A frame in which nothing moves.
    pub still_ms: f64,
    /// A frame that draws every map.
    pub drawn_ms: f64,
    /// A still frame where every lamp is shaded over the whole picture.
    pub whole_ms: f64,
    /// Of all maps.
    pub bytes: u64,
    /// The sizes of the maps by light, those that have some.
    pub sizes: Vec<u32>,
}

/// The city of so much detail (1 is all of it), at night, with the lamps nearest to the camera.
pub fn city(detail: f32, lamps: usize) -> Option<Scene> {
    let mut scene = (scenes::find("city")?.build)(detail);
    scene.ambient = Vec3::new(0.02, 0.025, 0.045);
    scene.camera.eye.y = 5.5;
    scene.camera.target.y = 1.5;
    // Along three streets, on both sides of each. Streets are 50 m apart, one every block.
    let Camera { eye, target, .. } = scene.camera;
    park_cars(&mut scene, target.x, eye.z);
    let side = |i: u32| if i.is_multiple_of(2) { -4.2 } else { 4.2 };
    let along = |i: u32| eye.z + 20.0 - 12.0 * f64::from(i / 2);
    let across = |i: u32| eye.x + 48.0 - 13.0 * f64::from(i / 2);
    let main = (0..32).map(|i| DVec3::new(target.x + side(i), 4.6, along(i)));
    let crossings = (0..32).map(|i| DVec3::new(across(i % 16), 4.6, target.z + side(i) - 50.0 * f64::from(i / 16)));
    let mut places: Vec<DVec3> = main.chain(crossings).collect();
    places.sort_by(|a, b| a.distance(eye).total_cmp(&b.distance(eye)));
    scene.lights = places.into_iter().zip(0..).take(lamps).map(|(place, i)| lamp(place, i)).collect();
    Some(scene)
}

/// Boxes along both sides of the street at `x`, from `z` on.
fn park_cars(scene: &mut Scene, x: f64, z: f64) {
    let cube = scene.add_mesh(primitive::cube());
    let paint = scene.add_material(Material { base_color: Vec4::new(0.5, 0.5, 0.55, 1.0), ..Material::default() });
    for i in 0..40 {
        let side = if i % 2 == 0 { -2.6 } else { 2.6 };
        let at = DVec3::new(x + side, 0.75, z - 3.4 * f64::from(i) - 0.6 * f64::from(i % 3));
        scene.place(cube, paint, DAffine3::from_scale_rotation_translation(SIZE_OF_CAR, DQuat::IDENTITY, at));
    }
}

fn lamp(position: DVec3, number: usize) -> Light {
    let colors = [[1.0, 0.62, 0.3], [1.0, 0.75, 0.5], [0.75, 0.85, 1.0]];
    Light {
        color: Vec3::from(colors[number % colors.len()]),
        intensity: 3.0,
        attenuation: Vec3::new(1.0, 0.0, 0.35),
        range: Some(15.0),
        ..Light::new(LightShape::Point { position })
    }
}

/// Draws frames of such a city with the maps of all lamps in one budget; times are those of the
/// fastest of so many frames.
pub fn measure(gpu: &Gpu, scene: &Scene, (width, height): (u32, u32), frames: u32) -> Result<Measured, Error> {
    let settings = umbrage::parse("pcf:size=1024")?;
    let pass = |light| Ok(LightPass { light, technique: settings.make(gpu)? });
    let start = Instant::now();
    let lights = (0..scene.lights.len()).map(pass).collect::<Result<Vec<_>, Error>>()?;
    let count = lights.len();
    let mut renderer = Renderer::new(gpu, scene, width, height, lights)?;
    renderer.pool_maps(BUDGET, vec![settings; count])?;
    renderer.set_one_target(true)?;
    let frames_ms = |renderer: &mut Renderer, count: u32, forgets: bool| {
        let mut fastest = f64::INFINITY;
        for _ in 0..count {
            if forgets {
                renderer.forget();
            }
            let start = Instant::now();
            renderer.frame(&scene.camera)?;
            renderer.wait()?;
            fastest = fastest.min(start.elapsed().as_secs_f64() * 1e3);
        }
        Ok::<_, Error>(fastest)
    };
    frames_ms(&mut renderer, 1, false)?;
    let first_ms = start.elapsed().as_secs_f64() * 1e3;
    frames_ms(&mut renderer, 2, false)?;
    let still_ms = frames_ms(&mut renderer, frames, false)?;
    let drawn_ms = frames_ms(&mut renderer, frames, true)?;
    renderer.set_clipping(false);
    frames_ms(&mut renderer, 1, false)?;
    let whole_ms = frames_ms(&mut renderer, frames, false)?;
    renderer.set_clipping(true);
    frames_ms(&mut renderer, 1, false)?;
    let bytes = (0..count).map(|light| renderer.stats(light).bytes).sum();
    let sizes = (0..count).filter_map(|light| renderer.pool()?.size(light)).collect();
    Ok(Measured { picture: renderer.color()?, first_ms, still_ms, drawn_ms, whole_ms, bytes, sizes })
}
