//! What the window shows: a scene, a light, a camera that circles, and the technique of the hour.

use umbrage::Gpu;
use umbrage_core::glam::{DAffine3, DVec3};
use umbrage_core::{Camera, Light, LightShape, Material, Scene, primitive};
use umbrage_renderer::{LightPass, Renderer};

pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// What the keys 1 to 9 choose.
pub const TECHNIQUES: [&str; 9] = [
    "shadow-map",
    "pcf:kernel=7",
    "pcss",
    "evsm:softness=light",
    "silhouette-map",
    "smoothies",
    "volume",
    "wedges",
    "none",
];

/// The scene and its renderer.
pub struct Show {
    gpu: Gpu,
    pub renderer: Renderer,
    chosen: usize,
}

impl Show {
    pub fn new(gpu: &Gpu, (width, height): (u32, u32)) -> Result<Self> {
        let technique = umbrage::parse(TECHNIQUES[0])?.make(gpu)?;
        let lights = vec![LightPass { light: 0, technique }];
        Ok(Self { gpu: gpu.clone(), renderer: Renderer::new(gpu, &scene(), width, height, lights)?, chosen: 0 })
    }

    /// Shadows by number `i` of [`TECHNIQUES`] from now on; where the device can't, all stays.
    pub fn choose(&mut self, i: usize) -> Result<()> {
        let Some(text) = TECHNIQUES.get(i).filter(|_| i != self.chosen) else { return Ok(()) };
        self.renderer.set_technique(0, umbrage::parse(text)?.make(&self.gpu)?)?;
        self.chosen = i;
        Ok(())
    }

    /// Draws with the camera `seconds` on its way.
    pub fn frame(&mut self, seconds: f64) -> Result<()> {
        let angle = 0.3 * seconds;
        let eye = DVec3::new(7.0 * angle.sin(), 4.0, 7.0 * angle.cos());
        let camera = Camera { eye, target: DVec3::new(0.0, 0.5, 0.0), ..Camera::default() };
        Ok(self.renderer.frame(&camera)?)
    }
}

/// Boxes and a sphere on a floor, under a sphere light.
fn scene() -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let [plane, cube, ball] =
        [primitive::plane(), primitive::cube(), primitive::sphere(32, 16)].map(|mesh| scene.add_mesh(mesh));
    let at = |x, y, z| DAffine3::from_translation(DVec3::new(x, y, z));
    scene.place(plane, material, DAffine3::from_scale(DVec3::splat(6.0)));
    scene.place(cube, material, at(-1.5, 0.5, 0.3) * DAffine3::from_rotation_y(0.4));
    scene.place(cube, material, at(0.4, 1.0, -1.4) * DAffine3::from_scale(DVec3::new(0.6, 2.0, 0.6)));
    scene.place(ball, material, at(1.4, 0.7, 0.9) * DAffine3::from_scale(DVec3::splat(0.7)));
    scene.lights.push(Light::new(LightShape::Sphere { position: DVec3::new(2.0, 4.0, 1.0), radius: 0.4 }));
    scene
}

/// Draws frames of `size`, each with the next technique, and says how bright each is, 0 to 1.
pub fn without_window(count: u32, size: (u32, u32)) -> Result<Vec<(&'static str, f64)>> {
    let gpu = Gpu::request(None)?;
    let mut show = Show::new(&gpu, size)?;
    let mut drawn = Vec::new();
    for frame in 0..count {
        let i = frame as usize % TECHNIQUES.len();
        show.choose(i)?;
        show.frame(f64::from(frame) / 60.0)?;
        let picture = show.renderer.color()?.data;
        let sum: u64 = picture.iter().flat_map(|pixel| &pixel[..3]).map(|c| u64::from(*c)).sum();
        drawn.push((TECHNIQUES[i], sum as f64 / (765.0 * picture.len() as f64)));
    }
    Ok(drawn)
}
