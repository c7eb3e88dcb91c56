//! `umbrage render`: one picture.

use crate::{
    Context,
    args::{self, Adapter, Size},
    bars::Bars,
    say,
};
use anyhow::{Result, anyhow, bail};
use clap::Args;
use std::path::PathBuf;
use umbrage::{Answer, Registry, nearest};
use umbrage_report::{
    Aov, Choice, LIGHT_SAMPLES, Method, PATH_TRACED, PathTraced, Picture, RAY_TRACED, RayTraced, Shot, check_file,
};

/// Renders one picture of a scene with one technique
#[derive(Args)]
#[command(after_help = "\
Examples:
  umbrage render atrium -o atrium.png
  umbrage render bunny.scene.toml --technique shadow-map --light 0 --aov visibility -o v.exr
  umbrage render contact --technique shadow-map --light-samples 256 -o soft.png
  umbrage render atrium --technique volume --light 0 --aov overdraw -o overdraw.png
  umbrage render contact --technique ray-traced --samples 256 --aov visibility -o v.png
  umbrage render courtyard --technique path-traced --bounces 4 --aov radiance -o r.exr
  umbrage render courtyard --technique prt --set order=6 --bake-cache out/bakes -o sky.png

Pictures: `color` is sRGB PNG. `visibility` is linear: 16-bit grey PNG, or float EXR (channel V); it needs \
--light where a scene has several. `radiance` is linear RGB in EXR, tone-mapped in PNG. `scored` is 255 where the comparison looks. `depth` is metres along the view in \
EXR (channel Z), the nearest over the distance in PNG. `normal` is world space in EXR, (n + 1) / 2 in PNG. Maps are as \
stored in EXR (channel V), with the largest value white in PNG; a light to all sides has `map-0` to `map-5`, those of \
faces in use.")]
pub struct Render {
    /// Built-in scene or file
    scene: String,
    /// Technique, as in `umbrage list`, and settings if you like, as in `pcf:kernel=7`;
    /// `ray-traced` is the reference, `path-traced` that of light from the sky
    #[arg(long, value_name = "ID", default_value = "shadow-map")]
    technique: String,
    /// Parameter of the technique
    #[arg(long, value_name = "NAME=VALUE", value_parser = args::pair)]
    set: Vec<(String, String)>,
    /// Only this light, from 0 [default: all]
    #[arg(long, value_name = "N")]
    light: Option<usize>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = args::size)]
    size: Size,
    #[command(flatten)]
    changed: args::Changed,
    #[command(flatten)]
    moved: args::Moved,
    /// Rays for each pixel of `ray-traced`; 1 is the perfect hard shadow [default: 1024]. Paths
    /// for each pixel of `path-traced` [default: 256]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// How often light is reflected before the surface that is seen, with `path-traced` [default:
    /// 0]
    #[arg(long, value_name = "N")]
    bounces: Option<u32>,
    /// Average a hard technique over so many points of the light
    #[arg(long, value_name = "N")]
    light_samples: Option<u32>,
    /// Shade all lights at once and darken by this share, 0 to 1, whatever is in any shadow: the
    /// wrong single-pass algorithm, to compare with
    #[arg(long, value_name = "SHARE", value_parser = share)]
    overlay: Option<f32>,
    /// Folder where baked transfer is kept and found again, by what determines it
    #[arg(long, value_name = "DIR")]
    bake_cache: Option<PathBuf>,
    /// color, visibility, radiance, scored, depth, normal, or a view into the technique, such as
    /// map-0
    #[arg(long, value_name = "NAME", default_value = "color")]
    aov: String,
    /// File to write, .png or .exr
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    adapter: Adapter,
}

impl Render {
    /// Takes the picture and writes it.
    pub fn run(mut self, context: &Context<'_>) -> Result<()> {
        self.take_settings()?;
        let aov = Aov::from(self.aov.as_str());
        Picture::check_name(&aov, &self.output)?;
        check_file(&self.output)?;
        if self.technique == PATH_TRACED {
            return self.path_traced(context.registry, &aov);
        }
        if self.bounces.is_some() {
            bail!("--bounces is for `{PATH_TRACED}`; techniques that reflect light take it by --set bounces=N");
        }
        let method = self.method(context.registry)?;
        if self.overlay.is_some() && (aov != Aov::Color || self.technique == RAY_TRACED) {
            bail!(
                "--overlay is a way of shading: it goes with `--aov color` and a technique that knows it, such as `volume`"
            );
        }
        let source = self.moved.of(self.changed.open(&self.scene)?, self.size);
        let lights = source.lights(self.light, &[answer(&method)])?;
        self.check_aov(&aov)?;
        let of_one_light = matches!(aov, Aov::Visibility | Aov::Radiance | Aov::Scored | Aov::Inside(_));
        if of_one_light && lights.len() > 1 {
            let last = lights.len() - 1;
            bail!("{}: `{}` is of one light; say which with --light, 0 to {last}", source.asked, self.aov);
        }
        source.notes.iter().for_each(|note| say::note(note));
        if aov == Aov::Color && answer(&method) == Answer::Visibility && source.scene.environment.is_some() {
            let others: Vec<&str> = context.registry.of_radiance().iter().map(|info| info.id).collect();
            say::note(&format!(
                "the light of the sky is left out; `--technique {PATH_TRACED}` shows it, and so does {}",
                others.join(", ")
            ));
        }
        let shot = Shot {
            source,
            lights,
            method,
            size: (self.size.width, self.size.height),
            aov,
            overlay: self.overlay,
            bake_cache: args::kept_in(self.bake_cache)?,
        };
        let gpu = if shot.needs_gpu() { Some(self.adapter.gpu()?) } else { None };
        let picture = shot.take(gpu.as_ref(), &Bars::default())?;
        picture.save(&self.output)?;
        Ok(())
    }

    /// Settings may stand with the technique as in the lists of other commands; `--set` comes
    /// after them.
    fn take_settings(&mut self) -> Result<()> {
        let text = std::mem::take(&mut self.technique);
        let mut parts = text.split(':');
        self.technique = parts.next().unwrap_or_default().into();
        let pairs: Result<Vec<_>, String> = parts.map(args::pair).collect();
        let pairs = pairs.map_err(|remedy| anyhow!("`{text}`: {remedy}, after each `:`"))?;
        self.set.splice(..0, pairs);
        Ok(())
    }

    /// Takes the picture on the CPU, under the scene's environment.
    fn path_traced(&self, registry: &Registry, aov: &Aov) -> Result<()> {
        for (given, name) in [
            (self.light.is_some(), "--light"),
            (self.light_samples.is_some(), "--light-samples"),
            (self.overlay.is_some(), "--overlay"),
        ] {
            if given {
                bail!("{name} is not for `{PATH_TRACED}`, whose one light is the scene's environment");
            }
        }
        let mut set = self.set.clone();
        set.extend(self.samples.map(|n| ("samples".into(), n.to_string())));
        set.extend(self.bounces.map(|n| ("bounces".into(), n.to_string())));
        let settings = PathTraced::read(registry, &set)?;
        let source = self.moved.of(self.changed.open(&self.scene)?, self.size);
        source.notes.iter().for_each(|note| say::note(note));
        let picture = settings.take(&source, (self.size.width, self.size.height), aov, &Bars::default())?;
        Ok(picture.save(&self.output)?)
    }

    /// Names the picture that was probably meant, before a light is asked for that it does not
    /// need.
    fn check_aov(&self, aov: &Aov) -> Result<()> {
        let Aov::Inside(name) = aov else { return Ok(()) };
        match nearest(name, PICTURES.into_iter()) {
            Some(meant) => bail!("there is no picture `{name}`; did you mean `{meant}`?"),
            None => Ok(()),
        }
    }

    fn method(&self, registry: &Registry) -> Result<Method> {
        let mut set = self.set.clone();
        if self.technique == RAY_TRACED {
            if self.light_samples.is_some() {
                bail!("--light-samples is for hard techniques; `{RAY_TRACED}` takes --samples");
            }
            set.extend(self.samples.map(|n| ("samples".into(), n.to_string())));
            return Ok(Method::RayTraced { samples: RayTraced::read(registry, &set)?.samples });
        }
        if self.samples.is_some() {
            bail!("--samples is for `{RAY_TRACED}`; hard techniques take --light-samples");
        }
        set.extend(self.light_samples.map(|n| (LIGHT_SAMPLES.into(), n.to_string())));
        let choice = Choice::new(registry, &self.technique, &set)?;
        args::print_note(&choice);
        Ok(Method::Technique(choice))
    }
}

/// What the lights are chosen by where none is named.
fn answer(method: &Method) -> Answer {
    match method {
        Method::Technique(choice) => choice.info.answer(),
        Method::RayTraced { .. } => Answer::Visibility,
    }
}

/// Pictures of a scene, whatever the technique.
const PICTURES: [&str; 6] = ["color", "visibility", "radiance", "scored", "depth", "normal"];

fn share(text: &str) -> Result<f32, String> {
    let share = text.parse().ok().filter(|s| (0.0..=1.0).contains(s));
    share.ok_or_else(|| "write a number from 0 to 1, such as 0.5".into())
}
