//! A renderer over `umbrage`: a G-buffer, each light added under its visibility, tone mapping. It is one consumer of the
//! library among others: whatever it uses of it, a host engine may use as well.
//!
//! ```no_run
//! # fn picture(gpu: &umbrage::Gpu, scene: &umbrage::core::Scene) -> Result<(), umbrage::Error> {
//! use umbrage_renderer::{LightPass, Renderer};
//! let info = umbrage::find("pcf")?;
//! let technique = info.make(gpu, &info.settings(&[])?)?;
//! let mut renderer = Renderer::new(gpu, scene, 640, 480, vec![LightPass { light: 0, technique }])?;
//! renderer.frame(&scene.camera)?;
//! let picture = renderer.color()?;
//! # Ok(()) }
//! ```

mod gbuffer;
mod overlay;
mod shading;
mod tonemap;

use gbuffer::GBuffer;
use overlay::Overlay;
use shading::Shading;
use std::time::{Duration, Instant};
use tonemap::ToneMap;
use umbrage::{
    Casters, DebugView, Error, Gpu, Owner, PassTime, Passes, Receivers, Recorder, Shader, Stats, Technique, View,
    VisibilityTarget, read,
};
use umbrage_core::{Camera, CameraView, Image, Light, LightShape, Scene, Texture};

/// Every shader of the renderer, for tests.
pub const SHADERS: &[Shader] = &[gbuffer::SHADER, overlay::SHADER, shading::SHADER, tonemap::SHADER];

/// One light and the technique that shadows it.
pub struct LightPass {
    /// Index into [`Scene::lights`].
    pub light: usize,
    /// Finds its visibility.
    pub technique: Box<dyn Technique>,
}

/// Renders a scene with any technique for each of its lights.
pub struct Renderer {
    gpu: Gpu,
    casters: Casters,
    gbuffer: GBuffer,
    receivers: Receivers,
    shading: Shading,
    tonemap: ToneMap,
    recorder: Recorder,
    lights: Vec<Lit>,
    /// All lights as the scene has them.
    scene_lights: Vec<Light>,
    /// Kept only where a light is textured.
    textures: Vec<Texture>,
    ambient: [f32; 3],
    prepare_ms: f64,
    overlay: Option<Overlay>,
}

/// A light, its technique and what came out.
struct Lit {
    number: usize,
    light: Light,
    technique: Box<dyn Technique>,
    visibility: VisibilityTarget,
    slot: shading::Slot,
}

/// What the views of all lights of a frame share.
struct Visible<'a> {
    camera: CameraView,
    receivers: &'a Receivers,
    casters: &'a Casters,
    textures: &'a [Texture],
}

impl<'a> Visible<'a> {
    fn view(&self, light: &'a Light) -> View<'a> {
        let Self { camera, receivers, casters, textures } = *self;
        View { camera, receivers, casters, light, textures }
    }
}

impl Renderer {
    /// Uploads `scene` and makes targets of `width` × `height`. Lights without a pass do not shine; the same light may
    /// come once only.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits, [`Error::Scene`] for a light that is not there.
    pub fn new(gpu: &Gpu, scene: &Scene, width: u32, height: u32, lights: Vec<LightPass>) -> Result<Self, Error> {
        gpu.check_size("the picture", width, height)?;
        let casters = Casters::new(gpu, scene)?;
        let gbuffer = GBuffer::new(gpu, width, height);
        let mut receivers = Receivers::new(gpu, &gbuffer.depth_view, Some(&gbuffer.normal_view), (width, height));
        if let Some(view) = &gbuffer.stencil_view {
            receivers = receivers.with_stencil(view);
        }
        let shading = Shading::new(gpu, &gbuffer);
        let tonemap = ToneMap::new(gpu, &gbuffer, width, height);
        let textured = scene.lights.iter().any(|l| matches!(l.shape, LightShape::Rect { texture: Some(_), .. }));
        for (i, pass) in lights.iter().enumerate() {
            if lights[..i].iter().any(|other| other.light == pass.light) {
                return Err(twice(pass.light));
            }
        }
        let lights = lights.into_iter().map(|pass| {
            let light = light_of(&scene.lights, pass.light)?;
            let visibility = VisibilityTarget::new(gpu, width, height)?;
            let slot = shading.slot(gpu, &visibility);
            Ok(Lit { number: pass.light, light, technique: pass.technique, visibility, slot })
        });
        Ok(Self {
            lights: lights.collect::<Result<_, Error>>()?,
            gpu: gpu.clone(),
            casters,
            gbuffer,
            receivers,
            shading,
            tonemap,
            recorder: Recorder::new(gpu),
            scene_lights: scene.lights.clone(),
            textures: if textured { scene.textures.clone() } else { Vec::new() },
            ambient: scene.ambient.to_array(),
            prepare_ms: 0.0,
            overlay: None,
        })
    }

    /// Puts `new` in the place of pass number `pass` and gives back what was there. Geometry, targets and pipelines stay;
    /// the light is as the scene has it.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass or light, and for a light of another pass.
    pub fn exchange(&mut self, pass: usize, new: LightPass) -> Result<LightPass, Error> {
        if self.lights.iter().enumerate().any(|(i, other)| i != pass && other.number == new.light) {
            return Err(twice(new.light));
        }
        let light = light_of(&self.scene_lights, new.light)?;
        let lit = self.lights.get_mut(pass).ok_or_else(|| no_pass(pass))?;
        lit.light = light;
        let number = std::mem::replace(&mut lit.number, new.light);
        Ok(LightPass { light: number, technique: std::mem::replace(&mut lit.technique, new.technique) })
    }

    /// Records with `new` from the next frame on and gives back what was in use. Upload memory goes with it, and the GPU times that a
    /// technique sees of its last frame: where techniques take turns, each has a recorder of its own.
    pub fn exchange_recorder(&mut self, new: Recorder) -> Recorder {
        std::mem::replace(&mut self.recorder, new)
    }

    /// Draws and submits one frame without waiting for it.
    ///
    /// # Errors
    /// What the techniques give; [`Error::DeviceLost`] and [`Error::Driver`].
    pub fn frame(&mut self, camera: &Camera) -> Result<(), Error> {
        self.gpu.check()?;
        let (width, height) = self.receivers.size;
        let camera = camera.view(width, height);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = self.recorder.begin(&mut encoder);
        passes.owner(Owner::Host("poses"));
        self.casters.record_poses(&mut passes);
        passes.owner(Owner::Host("gbuffer"));
        self.gbuffer.record(&self.gpu, &mut passes, &self.casters, &camera, self.ambient);
        let scene = Visible { camera, receivers: &self.receivers, casters: &self.casters, textures: &self.textures };
        let shade = |passes: &mut Passes<'_>, lit: &Lit| {
            passes.owner(Owner::Host("shading"));
            self.shading.record(passes, &self.gbuffer, &scene.view(&lit.light), &lit.slot);
        };
        let mut preparing = Duration::ZERO;
        if let Some(overlay) = &self.overlay {
            let start = Instant::now();
            overlay.find(&self.gpu, &mut passes, &scene, &mut self.lights)?;
            preparing += start.elapsed();
            self.lights.iter().for_each(|lit| shade(&mut passes, lit));
            overlay.record(&mut passes, &self.gbuffer);
        } else {
            for lit in &mut self.lights {
                passes.owner(Owner::Light(lit.number));
                let view = scene.view(&lit.light);
                let start = Instant::now();
                lit.technique.prepare(&self.gpu, &view)?;
                preparing += start.elapsed();
                lit.technique.record(&mut passes, &view, &lit.visibility)?;
                shade(&mut passes, lit);
            }
        }
        self.prepare_ms = preparing.as_secs_f64() * 1e3;
        passes.owner(Owner::Host("shading"));
        self.tonemap.record(&mut passes);
        passes.finish();
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()
    }

    /// From the next frame on shades by the single-pass algorithm (PX 3.4): every light shines everywhere, and whatever is in
    /// the shadow of any of them loses this share of its light; wrong, and kept to be compared with. The first light's technique
    /// does all lights. `None` returns to the right one.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn set_overlay(&mut self, darkness: Option<f32>) -> Result<(), Error> {
        self.overlay = darkness.map(|d| Overlay::new(&self.gpu, self.receivers.size, d)).transpose()?;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = self.recorder.begin(&mut encoder);
        for lit in &self.lights {
            passes.render("lit", &[lit.visibility.overwrite()], None);
        }
        passes.finish();
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Waits until submitted frames are done.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] and [`Error::Driver`].
    pub fn wait(&self) -> Result<(), Error> {
        self.gpu.wait()
    }

    /// GPU times of the newest frame that is done; see [`Recorder::times`].
    pub fn times(&mut self) -> Vec<PassTime> {
        self.recorder.times()
    }

    /// CPU time that [`Technique::prepare`] took in the last frame, all lights together, milliseconds. Recording does not count, but in
    /// an overlay, which is prepared and recorded in one.
    pub fn prepare_ms(&self) -> f64 {
        self.prepare_ms
    }

    /// What the technique of pass number `pass` drew and holds.
    pub fn stats(&self, pass: usize) -> Stats {
        self.lights.get(pass).map(|l| l.technique.stats()).unwrap_or_default()
    }

    /// What else the last frame of pass number `pass` came to; see [`Technique::counts`].
    pub fn counts(&self, pass: usize) -> Vec<(&'static str, u64)> {
        self.lights.get(pass).map(|l| l.technique.counts()).unwrap_or_default()
    }

    /// The technique of pass number `pass`.
    pub fn technique(&self, pass: usize) -> Option<&dyn Technique> {
        self.lights.get(pass).map(|l| &*l.technique)
    }

    /// Has every technique drop what it keeps from frame to frame, see [`Technique::forget`].
    pub fn forget(&mut self) {
        self.lights.iter_mut().for_each(|light| light.technique.forget());
    }

    /// The scene's geometry on the GPU, to move instances.
    pub fn casters_mut(&mut self) -> &mut Casters {
        &mut self.casters
    }

    /// The light of pass number `pass`, to move it.
    pub fn light_mut(&mut self, pass: usize) -> Option<&mut Light> {
        self.lights.get_mut(pass).map(|l| &mut l.light)
    }

    /// The tone-mapped picture, sRGB and opaque.
    ///
    /// # Errors
    /// As [`Renderer::wait`]; so do all that read back.
    pub fn color(&self) -> Result<Image<[u8; 4]>, Error> {
        read::rgba8(&self.gpu, &self.tonemap.texture)
    }

    /// The visibility that pass number `pass` left, 0…1. What non-receiving surfaces hold means nothing.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass.
    pub fn visibility(&self, pass: usize) -> Result<Image<f32>, Error> {
        let lit = self.lights.get(pass).ok_or_else(|| no_pass(pass))?;
        lit.visibility.read(&self.gpu)
    }

    /// Depth along the view direction in metres, 0 where nothing is.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn depth(&self, camera: &Camera) -> Result<Image<f32>, Error> {
        let stored = read::one_channel(&self.gpu, &self.gbuffer.depth, 0)?;
        Ok(stored.map(|d| if *d > 0.0 { camera.near as f32 / d } else { 0.0 }))
    }

    /// Geometric normals turned to the camera; zero where nothing is.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn normal(&self) -> Result<Image<[f32; 3]>, Error> {
        let (packed, depth) = (
            read::packed_normals(&self.gpu, &self.gbuffer.normal)?,
            read::one_channel(&self.gpu, &self.gbuffer.depth, 0)?,
        );
        Ok(Image::from_fn(
            packed.width,
            packed.height,
            |x, y| if depth[(x, y)] > 0.0 { packed[(x, y)] } else { [0.0; 3] },
        ))
    }

    /// A picture of the inside of a technique that is in colour.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn read_debug_color(&self, view: &DebugView<'_>) -> Result<Image<[u8; 4]>, Error> {
        read::rgba8(&self.gpu, view.texture)
    }

    /// A picture of the inside of a technique, as it is stored: depths or numbers.
    ///
    /// # Errors
    /// As [`Renderer::color`].
    pub fn read_debug_view(&self, view: &DebugView<'_>) -> Result<Image<f32>, Error> {
        read::one_channel(&self.gpu, view.texture, view.layer)
    }
}

fn light_of(lights: &[Light], number: usize) -> Result<Light, Error> {
    let count = lights.len();
    let none = || Error::Scene(format!("no light {number} in the scene; it has {count}, counted from 0"));
    lights.get(number).cloned().ok_or_else(none)
}

fn twice(light: usize) -> Error {
    Error::Scene(format!("light {light} comes in two passes; it would shine twice"))
}

fn no_pass(pass: usize) -> Error {
    Error::Scene(format!("there is no light pass {pass}"))
}
