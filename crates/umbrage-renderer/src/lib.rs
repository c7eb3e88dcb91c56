//! A renderer over `umbrage`: a G-buffer, the sky behind it, each light added under its visibility
//! (or its radiance as it is), tone mapping. It is one consumer of the library among others:
//! whatever it uses of it, a host engine may use as well.
//!
//! ```no_run
//! # fn picture(gpu: &umbrage::Gpu, scene: &umbrage::core::Scene) -> Result<(), umbrage::Error> {
//! use umbrage_renderer::{LightPass, Renderer};
//! let technique = umbrage::parse("pcf:kernel=7")?.make(gpu)?;
//! let lights = vec![LightPass { light: 0, technique }];
//! let mut renderer = Renderer::new(gpu, scene, 640, 480, lights)?;
//! renderer.frame(&scene.camera)?;
//! let picture = renderer.color()?;
//! # Ok(()) }
//! ```

mod backdrop;
mod change;
mod gbuffer;
mod lit;
mod many;
mod overlay;
mod radiance;
#[cfg(all(feature = "native", not(target_family = "wasm")))]
mod read_back;
mod read_later;
mod shading;
mod targets;
mod tonemap;
mod turns;

use backdrop::Backdrop;
use gbuffer::GBufferPass;
use lit::{Lit, Target, Visible};
use many::Pooled;
use overlay::Overlay;
use shading::{MOST_LIGHTS, Shading, Together};
use std::borrow::Cow;
use targets::{PICTURE, Targets};
use tonemap::ToneMap;
pub use turns::Lights;
use umbrage::{Casters, Error, Gpu, Owner, PassTime, Passes, Recorder, Shader, Stats, Technique, VisibilityTarget};
use umbrage_core::{Camera, Light, LightShape, LitPart, Scene, Texture};
use web_time::{Duration, Instant};

/// Every shader of the renderer, for tests.
pub const SHADERS: &[Shader] =
    &[backdrop::SHADER, gbuffer::SHADER, overlay::SHADER, radiance::SHADER, shading::SHADER, tonemap::SHADER];

/// One light and the technique that shadows it.
pub struct LightPass {
    /// Number of the light, see [`Scene::numbered_lights`].
    pub light: usize,
    /// Finds its visibility, or its radiance.
    pub technique: Box<dyn Technique>,
}

/// Renders a scene with any technique for each of its lights.
pub struct Renderer {
    gpu: Gpu,
    casters: Casters,
    gbuffer: GBufferPass,
    shading: Shading,
    tonemap: ToneMap,
    targets: Targets,
    recorder: Recorder,
    lights: Vec<Lit>,
    /// Of the lights that the last picture was shaded under in one pass.
    together: Option<Together>,
    /// All lights as the scene has them.
    scene_lights: Vec<Light>,
    /// Kept only where a light is textured.
    textures: Vec<Texture>,
    ambient: [f32; 3],
    prepare_ms: f64,
    record_casters_ms: f64,
    overlay: Option<Overlay>,
    /// Made when a sky first shines.
    backdrop: Option<Backdrop>,
    clips_lights: bool,
    pool: Option<Pooled>,
    /// Of all lights, where they share one.
    one_target: Option<VisibilityTarget>,
}

impl Renderer {
    /// Uploads `scene` and makes targets of `width` × `height`. Lights without a pass do not shine;
    /// the same light may come once only.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits, [`Error::Scene`] for a light that is not there.
    pub fn new(gpu: &Gpu, scene: &Scene, width: u32, height: u32, lights: Vec<LightPass>) -> Result<Self, Error> {
        gpu.check_size("the picture", width, height)?;
        let casters = Casters::new(gpu, scene)?;
        let (shading, tonemap) = (Shading::new(gpu, scene.ambient.to_array()), ToneMap::new(gpu));
        let scene_lights: Vec<Light> = scene.numbered_lights().map(Cow::into_owned).collect();
        let lights = checked_lights(gpu, &shading, &scene_lights, (width, height), lights)?;
        let textured = scene.lights.iter().any(|l| matches!(l.shape, LightShape::Rect { texture: Some(_), .. }));
        Ok(Self {
            lights,
            together: None,
            gpu: gpu.clone(),
            casters,
            gbuffer: GBufferPass::new(gpu),
            targets: Targets::new(gpu, &shading, &tonemap, (width, height))?,
            shading,
            tonemap,
            recorder: Recorder::new(gpu),
            scene_lights,
            backdrop: None,
            textures: if textured { scene.textures.clone() } else { Vec::new() },
            ambient: scene.ambient.to_array(),
            prepare_ms: 0.0,
            record_casters_ms: 0.0,
            overlay: None,
            clips_lights: true,
            pool: None,
            one_target: None,
        })
    }

    /// Draws and submits one frame to [`Renderer::picture`], without waiting for it. Lights that
    /// light nothing the camera sees are left out: their techniques do nothing, and their counts
    /// stay those of their last frame.
    ///
    /// # Errors
    /// What the techniques give; [`Error::DeviceLost`] and [`Error::Driver`].
    pub fn frame(&mut self, camera: &Camera) -> Result<(), Error> {
        let picture = self.targets.picture_view.clone();
        self.draw(camera, &picture, PICTURE)
    }

    /// The same to a host's `target`, in place of [`Renderer::picture`]: a texture view of all of a
    /// texture that is as large as this renderer's pictures, seen as `format`. Where `format` is
    /// neither sRGB nor of floats, the values are encoded as sRGB.
    ///
    /// # Errors
    /// As [`Renderer::frame`]; [`Error::Scene`] for a target of another size, or a format that is
    /// not one of colours.
    pub fn frame_into(
        &mut self,
        camera: &Camera,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<(), Error> {
        let (texture, (width, height)) = (target.texture(), self.targets.size());
        let (x, y) = (texture.width(), texture.height());
        if (x, y) != (width, height) {
            return Err(Error::Scene(format!(
                "the target is {x}×{y} but the renderer's pictures are {width}×{height}; resize it first"
            )));
        }
        self.tonemap.prepare(&self.gpu, format)?;
        self.shading.prepare(&self.gpu, format);
        self.draw(camera, target, format)
    }

    fn draw(&mut self, camera: &Camera, target: &wgpu::TextureView, format: wgpu::TextureFormat) -> Result<(), Error> {
        self.gpu.check()?;
        self.lights.iter_mut().try_for_each(Lit::make_usable)?;
        let Targets { gbuffer, receivers, .. } = &self.targets;
        let camera = camera.view(receivers.size.0, receivers.size.1);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = self.recorder.begin(&mut encoder);
        passes.owner(Owner::Host("casters"));
        let start = Instant::now();
        self.casters.record(&mut passes)?;
        self.record_casters_ms = start.elapsed().as_secs_f64() * 1e3;
        passes.owner(Owner::Host("gbuffer"));
        self.gbuffer.record(&self.gpu, &mut passes, gbuffer, &self.casters, &camera);
        let scene = Visible { camera, receivers, casters: &self.casters, textures: &self.textures };
        let size = receivers.size;
        let shade = |passes: &mut Passes<'_>, lit: &Lit, part: LitPart| {
            passes.owner(Owner::Host("shading"));
            self.shading.record(passes, &self.targets, &scene.view(&lit.light), part.pixels(size), &lit.target);
        };
        let mut preparing = Duration::ZERO;
        let is_at_once = self.overlay.is_none() && self.one_target.is_none() && can_shade_at_once(&self.lights);
        let sky = self.lights.iter().find_map(|lit| match &lit.light.shape {
            LightShape::Environment(environment) => Some((lit, environment)),
            _ => None,
        });
        if !is_at_once {
            passes.owner(Owner::Host("shading"));
            self.shading.record_start(&mut passes, &self.targets, sky.is_some());
        }
        if let Some((lit, environment)) = sky {
            passes.owner(Owner::Host("sky"));
            let backdrop = self.backdrop.get_or_insert_with(|| Backdrop::new(&self.gpu));
            backdrop.record(&self.gpu, &mut passes, &scene.view(&lit.light), environment, &gbuffer.radiance_view);
        }
        if let Some(overlay) = &self.overlay {
            let start = Instant::now();
            overlay.find(&self.gpu, &mut passes, &scene, &mut self.lights)?;
            preparing += start.elapsed();
            self.lights.iter().for_each(|lit| shade(&mut passes, lit, LitPart::ALL));
            overlay.record(&mut passes, &gbuffer.radiance_view);
        } else {
            let start = Instant::now();
            if let Some(pool) = &mut self.pool {
                pool.share(&self.gpu, &scene, &mut self.lights)?;
            }
            preparing += start.elapsed();
            for lit in &mut self.lights {
                passes.owner(Owner::Light(lit.number));
                let view = scene.view(&lit.light);
                let part = if self.clips_lights { view.lit_part() } else { Some(LitPart::ALL) };
                let Some(part) = part else {
                    lit.leave_out(&mut passes, self.one_target.is_some());
                    continue;
                };
                lit.is_left_out = false;
                let start = Instant::now();
                let prepared = lit.technique.prepare(&self.gpu, &view)?;
                preparing += start.elapsed();
                lit.target.record(prepared, &mut passes)?;
                if !is_at_once {
                    shade(&mut passes, lit, part);
                }
            }
        }
        self.prepare_ms = preparing.as_secs_f64() * 1e3;
        passes.owner(Owner::Host("shading"));
        if is_at_once {
            let views: Vec<_> = self.lights.iter().map(|lit| scene.view(&lit.light)).collect();
            let visibilities: Vec<_> = self.lights.iter().filter_map(|lit| lit.target.visibility()).collect();
            self.shading.join(&self.gpu, &visibilities, &mut self.together);
            if let Some(together) = &self.together {
                let light = (&*views, self.ambient);
                self.shading.record_picture(&mut passes, &self.targets, light, together, (target, format));
            }
        } else {
            self.tonemap.record(&mut passes, &self.targets.radiance, target, format);
        }
        passes.finish();
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()
    }

    /// The tone-mapped picture of the last [`Renderer::frame`], sRGB and opaque: to be sampled or
    /// copied from. Another one after [`Renderer::resize`].
    pub fn picture(&self) -> &wgpu::Texture {
        &self.targets.picture
    }

    /// A view of all of [`Renderer::picture`].
    pub fn picture_view(&self) -> &wgpu::TextureView {
        &self.targets.picture_view
    }

    /// Waits until submitted frames are done.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] and [`Error::Driver`].
    #[cfg(not(target_family = "wasm"))]
    pub fn wait(&self) -> Result<(), Error> {
        self.gpu.wait()
    }

    /// GPU times of the newest frame that is done; see [`Recorder::times`].
    pub fn times(&mut self) -> Vec<PassTime> {
        self.recorder.times()
    }

    /// CPU time that preparing techniques took in the last frame, all lights together,
    /// milliseconds. Recording does not count, but in an overlay, which is prepared and recorded in
    /// one.
    pub fn prepare_ms(&self) -> f64 {
        self.prepare_ms
    }

    /// CPU time that [`Casters::record`] took in the last frame, milliseconds.
    pub fn record_casters_ms(&self) -> f64 {
        self.record_casters_ms
    }

    /// What the technique of pass number `pass` drew and holds.
    pub fn stats(&self, pass: usize) -> Stats {
        self.lights.get(pass).map(|l| l.technique.inside().stats()).unwrap_or_default()
    }

    /// More numbers of the last frame of pass number `pass`; see
    /// [`Inside::counts`](umbrage::Inside::counts).
    pub fn counts(&self, pass: usize) -> Vec<(&'static str, u64)> {
        self.lights.get(pass).map(|l| l.technique.inside().counts()).unwrap_or_default()
    }

    /// The technique of pass number `pass`.
    pub fn technique(&self, pass: usize) -> Option<&dyn Technique> {
        self.lights.get(pass).map(|l| &*l.technique)
    }
}

/// Whether one pass can shade under all of these lights: a few that answer with visibility.
fn can_shade_at_once(lights: &[Lit]) -> bool {
    (1..=MOST_LIGHTS).contains(&lights.len()) && lights.iter().all(|lit| lit.target.visibility().is_some())
}

/// The lights of passes, none twice.
fn checked_lights(
    gpu: &Gpu,
    shading: &Shading,
    all: &[Light],
    size: (u32, u32),
    passes: Vec<LightPass>,
) -> Result<Vec<Lit>, Error> {
    for (i, pass) in passes.iter().enumerate() {
        if passes[..i].iter().any(|other| other.light == pass.light) {
            return Err(twice(pass.light));
        }
    }
    let lit = |LightPass { light, technique }: LightPass| {
        let target = Target::new(gpu, shading, technique.answer(), size, None)?;
        Ok(Lit::new(light, light_of(all, light)?, technique, target))
    };
    passes.into_iter().map(lit).collect()
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
