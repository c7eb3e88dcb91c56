//! One picture of a scene, or of what is inside a technique.

use crate::{
    bakes::Bakes,
    choice::{Choice, PATH_TRACED},
    error::Error,
    given::Given,
    pictures::{inverse_depth, tone_mapped},
    progress::Progress,
    source::Source,
    truth::Tracing,
};
use std::{borrow::Cow, path::{Path, PathBuf}};
use umbrage::{Answer, DebugView, Gpu, Technique};
use umbrage_core::{Image, Light, LightKind};
use umbrage_io::pictures;
use umbrage_reference::Truth;
use umbrage_renderer::{LightPass, Renderer};

/// What a picture shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Aov {
    /// The shaded scene.
    Color,
    /// The share of one light that each pixel sees.
    Visibility,
    /// The light that surfaces send to the eye under the environment.
    Radiance,
    /// Which pixels are scored for one light: receiving surfaces that face it.
    Scored,
    /// Distance along the view.
    Depth,
    /// Geometric normals turned to the camera.
    Normal,
    /// A view into the technique, by its name.
    Inside(String),
}

impl From<&str> for Aov {
    fn from(name: &str) -> Self {
        match name {
            "color" => Self::Color,
            "visibility" => Self::Visibility,
            "radiance" => Self::Radiance,
            "scored" => Self::Scored,
            "depth" => Self::Depth,
            "normal" => Self::Normal,
            other => Self::Inside(other.into()),
        }
    }
}

/// How visibility is found.
#[derive(Clone, Debug)]
pub enum Method {
    /// By a technique on the GPU.
    Technique(Choice),
    /// By tracing this many rays for each pixel on the CPU.
    RayTraced {
        /// Rays for each pixel.
        samples: u32,
    },
}

/// A picture to take.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The scene.
    pub source: Source,
    /// The lights that shine; pictures of a single light take the first.
    pub lights: Vec<usize>,
    /// How visibility is found.
    pub method: Method,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// What it shows.
    pub aov: Aov,
    /// Shades by the single-pass algorithm: this share of the light is missing in any light's
    /// shadow.
    pub overlay: Option<f32>,
    /// A folder where baked transfer is kept and found again.
    pub bake_cache: Option<PathBuf>,
}

/// A picture taken.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// sRGB.
    Color(Image<[u8; 4]>),
    /// Shares, 0 to 1.
    Share(Image<f32>),
    /// Linear RGB.
    Radiance(Image<[f32; 3]>),
    /// What is stored inside of a technique.
    Inside(Image<f32>),
    /// Yes or no.
    Mask(Image<bool>),
    /// Metres along the view, 0 = nothing.
    Depth(Image<f32>),
    /// Unit vectors, zero = nothing.
    Normal(Image<[f32; 3]>),
}

/// Longest side of a picture that is made without a GPU, pixels: that of most GPUs.
const LONGEST_SIDE: u32 = 16_384;

impl Shot {
    /// True where the picture is made on the GPU; the ray tracer alone needs none.
    pub fn needs_gpu(&self) -> bool {
        match self.method {
            Method::Technique(_) => self.aov != Aov::Scored,
            Method::RayTraced { .. } => self.aov == Aov::Color,
        }
    }

    /// Takes it. `gpu` may be absent where [`Shot::needs_gpu`] is false.
    ///
    /// # Errors
    /// Lights and settings that the technique can't do, sizes beyond the adapter's limit, unknown
    /// views.
    pub fn take(&self, gpu: Option<&Gpu>, progress: &dyn Progress) -> Result<Picture, Error> {
        for &light in &self.lights {
            self.source.light(light)?;
        }
        let (width, height) = self.size;
        match gpu {
            Some(gpu) => gpu.check_size("the picture", width, height)?,
            None => check_side(width, height)?,
        }
        match gpu {
            _ if !self.needs_gpu() => self.take_on_cpu(progress),
            Some(gpu) => self.take_on_gpu(gpu, progress),
            None => Err(umbrage::Error::NoAdapter { found: String::new() }.into()),
        }
    }

    fn take_on_cpu(&self, progress: &dyn Progress) -> Result<Picture, Error> {
        let samples = match self.method {
            Method::RayTraced { samples } => samples,
            Method::Technique(_) => 1,
        };
        let tracing = Tracing::new(&self.source, self.size.0, self.size.1);
        let truth = |samples| self.trace(&tracing, &*self.first_light()?, samples, progress);
        match &self.aov {
            Aov::Depth => Ok(Picture::Depth(tracing.geometry.depth)),
            Aov::Normal => Ok(Picture::Normal(tracing.geometry.normal.map(|n| n.to_array()))),
            Aov::Scored => Ok(Picture::Mask(truth(1)?.scored)),
            Aov::Visibility => Ok(Picture::Share(truth(samples)?.visibility)),
            Aov::Color => Err(umbrage::Error::NoAdapter { found: String::new() }.into()),
            Aov::Radiance => Err(no_radiance()),
            Aov::Inside(name) => Err(unknown_view(name, &[])),
        }
    }

    fn take_on_gpu(&self, gpu: &Gpu, progress: &dyn Progress) -> Result<Picture, Error> {
        if self.aov == Aov::Radiance && self.answer() == Answer::Visibility {
            return Err(no_radiance());
        }
        let mut techniques: Vec<Box<dyn Technique>> = Vec::new();
        match &self.method {
            Method::RayTraced { samples } => {
                let tracing = Tracing::new(&self.source, self.size.0, self.size.1);
                for &light in &self.lights {
                    let truth = self.trace(&tracing, &*self.source.light(light)?, *samples, progress)?;
                    techniques.push(Box::new(Given::new(gpu, &truth.visibility)?));
                }
            }
            Method::Technique(choice) => {
                let bakes = Bakes::new(&self.source, self.bake_cache.as_deref(), progress);
                for &light in &self.lights {
                    choice.supports(self.source.light(light)?.shape.kind())?;
                    techniques.push(bakes.make(choice, gpu)?);
                }
            }
        }
        self.render(gpu, techniques)
    }

    /// A frame with one technique for each light.
    fn render(&self, gpu: &Gpu, techniques: Vec<Box<dyn Technique>>) -> Result<Picture, Error> {
        let scene = &self.source.scene;
        let passes = self.lights.iter().zip(techniques).map(|(&light, mut technique)| {
            if let Aov::Inside(name) = &self.aov {
                technique.inside_mut().inspect(Some(name));
            }
            LightPass { light, technique }
        });
        let mut renderer = Renderer::new(gpu, scene, self.size.0, self.size.1, passes.collect())?;
        if self.overlay.is_some() {
            renderer.set_overlay(self.overlay)?;
        }
        // A light that lights nothing in view has pictures of its inside, too.
        renderer.set_clipping(!matches!(self.aov, Aov::Inside(_)));
        renderer.frame(&scene.camera)?;
        Ok(match &self.aov {
            Aov::Color => Picture::Color(renderer.color()?),
            Aov::Depth => Picture::Depth(renderer.depth(&scene.camera)?),
            Aov::Normal => Picture::Normal(renderer.normal()?),
            Aov::Visibility | Aov::Scored => Picture::Share(renderer.visibility(0)?),
            Aov::Radiance => Picture::Radiance(renderer.radiance(0)?),
            Aov::Inside(name) => {
                let views = renderer.technique(0).map(|t| t.inside().debug_views()).unwrap_or_default();
                let view = views.iter().find(|v| v.name == name).ok_or_else(|| self.no_view(name, &views))?;
                if view.texture.format().components() == 4 {
                    Picture::Color(renderer.read_debug_color(view)?)
                } else {
                    Picture::Inside(renderer.read_debug_view(view)?)
                }
            }
        })
    }

    /// Why there is no such picture of the inside.
    fn no_view(&self, name: &str, made: &[DebugView<'_>]) -> Error {
        let known = match &self.method {
            Method::Technique(choice) => choice.info.views,
            Method::RayTraced { .. } => &[],
        };
        if !known.contains(&name) {
            return unknown_view(name, known);
        }
        let made: Vec<&str> = made.iter().map(|v| v.name).collect();
        let made = if made.is_empty() { "none".into() } else { made.join(", ") };
        Error::Name(format!("there is no `{name}` of this light; its views: {made}"))
    }

    fn answer(&self) -> Answer {
        match &self.method {
            Method::Technique(choice) => choice.info.answer(),
            Method::RayTraced { .. } => Answer::Visibility,
        }
    }

    fn first_light(&self) -> Result<Cow<'_, Light>, Error> {
        self.source.light(self.lights.first().copied().unwrap_or_default())
    }

    fn trace(
        &self,
        tracing: &Tracing,
        light: &Light,
        samples: u32,
        progress: &dyn Progress,
    ) -> Result<Truth, Error> {
        if light.shape.kind() == LightKind::Environment {
            return Err(Error::Name(format!(
                "this light is the environment, whose answer is radiance; take `--technique {PATH_TRACED}`"
            )));
        }
        let pixels = u64::from(self.size.0) * u64::from(self.size.1);
        let scene = &self.source.scene;
        progress.begin(&format!("{}, {} light: tracing", scene.name, light.shape.kind().name()), pixels);
        let truth = tracing.visibility(light, &scene.textures, samples, progress);
        progress.end();
        Ok(truth)
    }
}

/// Checks the size of a picture that is made without a GPU.
pub(crate) fn check_side(width: u32, height: u32) -> Result<(), Error> {
    let wrong = [width, height].into_iter().find(|side| !(1..=LONGEST_SIDE).contains(side));
    wrong.map_or(Ok(()), |size| {
        let limit = u64::from(LONGEST_SIDE);
        Err(umbrage::Error::Size { what: "the picture".into(), size: size.into(), limit }.into())
    })
}

const EIGHT_BITS: &str = "this picture has 8 bits a channel: end its name in .png";

fn wrong_name(path: &Path, remedy: &str) -> Error {
    Error::Name(format!("{}: can't be written in this format; {remedy}", path.display()))
}

fn no_radiance() -> Error {
    Error::Name(format!("this technique finds visibility; `--aov radiance` is what `{PATH_TRACED}` finds"))
}

fn unknown_view(name: &str, inside: &[&str]) -> Error {
    let names = [&["color", "visibility", "radiance", "scored", "depth", "normal"], inside].concat();
    let nearest = umbrage::nearest(name, names.iter().copied());
    let guess = nearest.map_or(String::new(), |n| format!("did you mean `{n}`? "));
    Error::Name(format!("unknown picture `{name}`; {guess}there are {}", names.join(", ")))
}

impl Picture {
    /// Checks that a file of this name can hold what `aov` shows, before the work.
    ///
    /// # Errors
    /// An extension that can't.
    pub fn check_name(aov: &Aov, path: &Path) -> Result<(), Error> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match (extension.as_str(), aov) {
            ("png", _) => Ok(()),
            ("exr", Aov::Color | Aov::Scored) => Err(wrong_name(path, EIGHT_BITS)),
            ("exr", _) => Ok(()),
            _ => Err(wrong_name(path, "end the name in .png or .exr")),
        }
    }

    /// Writes the picture as the extension says: PNG to look at, EXR with the numbers as they are.
    ///
    /// In a PNG radiance is tone-mapped, shares are 16-bit grey, depth is the nearest over the
    /// distance in 16-bit grey, what is inside of a technique is 16-bit grey with its largest value
    /// white, normals are 8-bit (n + 1) / 2.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn save(&self, path: &Path) -> Result<(), Error> {
        let is_exr = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr"));
        Ok(match self {
            Self::Color(_) if is_exr => return Err(wrong_name(path, EIGHT_BITS)),
            Self::Color(image) => pictures::save_png(path, image),
            Self::Mask(image) => pictures::save_png(path, &image.map(|&m| if m { 255u8 } else { 0 })),
            Self::Radiance(image) if is_exr => pictures::save_exr_rgb(path, image),
            Self::Radiance(image) => pictures::save_png(path, &image.map(|&c| tone_mapped(c.into()))),
            Self::Share(image) if is_exr => pictures::save_exr(path, image, "V"),
            Self::Share(image) => pictures::save_grey16(path, image),
            Self::Inside(image) if is_exr => pictures::save_exr(path, image, "V"),
            Self::Inside(image) => pictures::save_grey16(path, &largest_white(image)),
            Self::Depth(image) if is_exr => pictures::save_exr(path, image, "Z"),
            Self::Depth(image) => pictures::save_grey16(path, &inverse_depth(image)),
            Self::Normal(image) if is_exr => pictures::save_exr_rgb(path, image),
            Self::Normal(image) => {
                let byte = |c: f32| ((c * 0.5 + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8;
                pictures::save_png(path, &image.map(|n| n.map(byte)))
            }
        }?)
    }
}

/// Scaled so that the largest value is 1: depths of a light to all sides, near over distance, are
/// thousandths as they are.
fn largest_white(image: &Image<f32>) -> Image<f32> {
    let largest = image.data.iter().copied().fold(0.0, f32::max);
    let scale = if largest > 0.0 { largest.recip() } else { 1.0 };
    image.map(|&v| v * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;

    #[test]
    fn small_values_inside_of_a_technique_can_be_seen() {
        let map = Image { width: 3, height: 1, data: vec![0.0, 0.001, 0.002] };
        assert_eq!(largest_white(&map).data, [0.0, 0.5, 1.0]);
        assert_eq!(largest_white(&Image::filled(1, 1, 0.0)).data, [0.0]);
    }

    #[test]
    fn the_extension_must_fit_the_picture() {
        let check = |aov: &str, name: &str| Picture::check_name(&Aov::from(aov), Path::new(name)).is_ok();
        assert!(check("color", "a.png") && check("visibility", "a.EXR") && check("map", "a.exr"));
        assert!(!check("color", "a.exr") && !check("depth", "a.jpg") && !check("depth", "a"));
    }

    #[test]
    fn a_ray_traced_picture_of_a_light_is_between_umbra_and_full_light() {
        let source = Source::open("contact").unwrap();
        let shot = Shot {
            source,
            lights: vec![0],
            method: Method::RayTraced { samples: 4 },
            size: (32, 24),
            aov: Aov::Visibility,
            overlay: None,
            bake_cache: None,
        };
        let Picture::Share(picture) = shot.take(None, &Silent).unwrap() else { panic!("no picture of shares") };
        assert_eq!(picture.size(), (32, 24));
        assert!(picture.data.contains(&1.0) && picture.data.contains(&0.0));
        let unknown = Shot { aov: Aov::Inside("colour".into()), ..shot }.take(None, &Silent).unwrap_err().to_string();
        assert!(unknown.contains("did you mean `color`"), "{unknown}");
    }
}
