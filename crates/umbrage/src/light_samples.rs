//! Brute-force soft shadows: the mean of the hard visibilities from many points of the light, over
//! any hard technique (ZA 1.4 and B.3; GG 9.2.1).

use crate::{
    answer::Answer,
    contact::{Contact, contact_shadows},
    denoise::{HISTORY_BYTES, HISTORY_PASS, MOST_FRAMES, MeanOverFrames},
    error::Error,
    fullscreen::{self, FLOATS, Fullscreen, additive, attachment, bind, layout},
    gpu::Gpu,
    passes::Passes,
    settings::Settings,
    shader::Shader,
    technique::{InOrder, Inside, Stats, Technique, inside_of},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::sampling::{self, hard_lights};
use umbrage_core::{Light, LightShape};

/// Shader of the adaptor, for the registry's tests.
pub const SHADER: Shader = Shader::new("light samples", include_str!("wgsl/light_samples.wgsl"));

/// Which points of a light brute force takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightPoints {
    /// How many in each frame.
    pub samples: u32,
    /// Other ones in each of so many frames; `None` for the same ones in all.
    pub frames: Option<u32>,
    /// Contact shadows of each point, before the mean is taken.
    pub contact: Option<Contact>,
}

impl LightPoints {
    /// Wraps the technique of `settings`, so that its visibility is the mean over these points.
    ///
    /// With [`LightPoints::frames`] it is that of `samples` × `frames` points after as many frames,
    /// as long as nothing changes. Where the camera begins to show a surface, and where the light
    /// or a caster between it and the surface moves, the mean starts anew: no trace of an old
    /// shadow is left in the next frame. It takes 8 bytes a pixel.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a technique that is not hard; [`Error::Size`] for 0 samples or
    /// more than 2048, and 0 frames or more than 64; what making the technique itself gives, and
    /// [`contact_shadows`].
    pub fn average(&self, gpu: &Gpu, settings: &Settings) -> Result<Box<dyn Technique>, Error> {
        let Self { samples, frames, contact } = *self;
        let inner = checked(gpu, settings, samples)?;
        let inner = match contact {
            Some(contact) => contact_shadows(gpu, inner, contact)?,
            None => inner,
        };
        let spread = frames.map(|frames| Spread::new(gpu, frames)).transpose()?;
        Ok(Box::new(LightSamples { spread, ..LightSamples::new(gpu, inner, samples) }))
    }
}

/// Wraps the technique of `settings`, so that its visibility is the mean over `samples` points of
/// the light: [`LightPoints`] in one frame.
///
/// # Errors
/// As [`LightPoints::average`].
pub fn light_samples(gpu: &Gpu, settings: &Settings, samples: u32) -> Result<Box<dyn Technique>, Error> {
    LightPoints { samples, frames: None, contact: None }.average(gpu, settings)
}

/// The same with `samples` other points of the light in each of `frames` frames.
///
/// # Errors
/// As [`LightPoints::average`].
pub fn light_samples_over(
    gpu: &Gpu,
    settings: &Settings,
    samples: u32,
    frames: u32,
) -> Result<Box<dyn Technique>, Error> {
    LightPoints { samples, frames: Some(frames), contact: None }.average(gpu, settings)
}

/// Wraps the technique of `settings`, so that its visibility is the mean over about `pieces`
/// smaller lights that together are the light, see [`umbrage_core::sampling::light_pieces`]. Where
/// one map is not enough because casters hide one another from the whole of a large light, they
/// hide one another from fewer pieces. It costs as much as so many lights.
///
/// # Errors
/// [`Error::Unsupported`] for a hard technique, which [`light_samples`] is for, and for one that
/// answers with radiance; [`Error::Size`] for 0 pieces or more than 16; what making the technique
/// itself gives.
pub fn light_pieces(gpu: &Gpu, settings: &Settings, pieces: u32) -> Result<Box<dyn Technique>, Error> {
    let refuse = |what: &str| Err(Error::Unsupported { technique: settings.info().id.into(), what: what.into() });
    if settings.is_hard() {
        return refuse("pieces of the light, since it is a hard technique; take light samples");
    }
    if settings.info().answer() != Answer::Visibility {
        return refuse("pieces of the light, since it answers with radiance");
    }
    if pieces == 0 || pieces > MAX_PIECES {
        return Err(Error::Size { what: "light pieces".into(), size: pieces.into(), limit: MAX_PIECES.into() });
    }
    let inner = settings.make(gpu)?;
    Ok(Box::new(LightSamples { parts: Parts::Pieces, ..LightSamples::new(gpu, inner, pieces) }))
}

/// The technique that is to be averaged.
fn checked(gpu: &Gpu, settings: &Settings, samples: u32) -> Result<Box<dyn Technique>, Error> {
    let info = settings.info();
    if !settings.is_hard() {
        let what = "brute force over light samples, since it is not a hard technique".into();
        return Err(Error::Unsupported { technique: info.id.into(), what });
    }
    if samples == 0 || samples > MAX_SAMPLES {
        return Err(Error::Size { what: "light samples".into(), size: samples.into(), limit: MAX_SAMPLES.into() });
    }
    settings.make(gpu)
}

/// Half floats count whole numbers exactly up to here, and hard visibilities are whole.
const MAX_SAMPLES: u32 = 2048;

/// Sums of more soft visibilities would lose what half floats have no room for.
const MAX_PIECES: u32 = 16;

/// What lights are replaced by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Parts {
    /// Hard lights.
    Points,
    /// Smaller soft ones.
    Pieces,
}

struct LightSamples {
    gpu: Gpu,
    inner: Box<dyn Technique>,
    parts: Parts,
    samples: u32,
    lights: Vec<Light>,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    add: wgpu::RenderPipeline,
    /// Divides by the number of lights, which a hard light makes 1 whatever was asked for.
    mean: Option<(usize, wgpu::RenderPipeline)>,
    targets: Option<Targets>,
    spread: Option<Spread>,
    stats: Stats,
}

/// Points of the light over several frames.
struct Spread {
    frames: u32,
    /// Number of the next frame.
    frame: u32,
    mean: MeanOverFrames,
    /// The light of the frame that was prepared has several points.
    is_soft: bool,
}

impl Spread {
    fn new(gpu: &Gpu, frames: u32) -> Result<Self, Error> {
        if frames == 0 || frames > MOST_FRAMES {
            return Err(Error::Size { what: "light frames".into(), size: frames.into(), limit: MOST_FRAMES.into() });
        }
        Ok(Self { frames, frame: 0, mean: MeanOverFrames::new(gpu, frames), is_soft: false })
    }

    /// Of the points of all frames those of the next one: every `frames`-th, in an order in which
    /// frames that follow one another are far apart.
    fn points(&self, all: Vec<LightShape>) -> Vec<LightShape> {
        let frames = self.frames as usize;
        let first = (self.frame as usize).wrapping_mul(stride(frames)) % frames;
        all.into_iter().skip(first).step_by(frames).collect()
    }
}

/// The number nearest to the golden share of `n` that has no divisor in common with it.
fn stride(n: usize) -> usize {
    fn divisor(a: usize, b: usize) -> usize {
        if b == 0 { a } else { divisor(b, a % b) }
    }
    let golden = (n as f64 * 0.618_034) as usize;
    (golden.max(1)..=n.max(1)).find(|step| divisor(n, *step) == 1).unwrap_or(1)
}

/// One sample's visibility and the sum so far.
struct Targets {
    one: VisibilityTarget,
    sum: VisibilityTarget,
    read_one: wgpu::BindGroup,
    read_sum: wgpu::BindGroup,
}

impl LightSamples {
    fn new(gpu: &Gpu, inner: Box<dyn Technique>, samples: u32) -> Self {
        let module = SHADER.module(gpu);
        let layout = layout(gpu, "visibility", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS)]);
        let add = pipeline(gpu, &module, &layout, "add", &[]);
        let gpu = gpu.clone();
        Self {
            gpu,
            inner,
            parts: Parts::Points,
            samples,
            lights: Vec::new(),
            module,
            layout,
            add,
            mean: None,
            targets: None,
            spread: None,
            stats: Stats::default(),
        }
    }

    fn targets(&self, (width, height): (u32, u32)) -> Result<Targets, Error> {
        let one = VisibilityTarget::new(&self.gpu, width, height)?;
        let sum = VisibilityTarget::new(&self.gpu, width, height)?;
        let read = |target: &VisibilityTarget| {
            bind(&self.gpu, "visibility", &self.layout, &[wgpu::BindingResource::TextureView(&target.view)])
        };
        let (read_one, read_sum) = (read(&one), read(&sum));
        Ok(Targets { one, sum, read_one, read_sum })
    }
}

impl Technique for LightSamples {
    fn prepare_view(&mut self, _: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        let frames = self.spread.as_ref().map_or(1, |spread| spread.frames);
        let count = (self.samples * frames) as usize;
        let mut shapes = match self.parts {
            Parts::Points => hard_lights(&view.light.shape, view.textures, count),
            Parts::Pieces => sampling::light_pieces(&view.light.shape, view.textures, count),
        };
        if let Some(spread) = &mut self.spread {
            spread.is_soft = shapes.len() > 1;
            if spread.is_soft {
                shapes = spread.points(shapes);
                spread.frame = spread.frame.wrapping_add(1);
                spread.mean.prepare(view)?;
            }
        }
        self.lights.clear();
        self.lights.extend(shapes.into_iter().map(|shape| Light { shape, ..view.light.clone() }));
        if self.mean.as_ref().is_none_or(|(n, _)| *n != self.lights.len()) {
            let constants = [("COUNT", self.lights.len().max(1) as f64)];
            self.mean = Some((self.lights.len(), pipeline(&self.gpu, &self.module, &self.layout, "mean", &constants)));
        }
        if self.targets.as_ref().is_none_or(|t| t.one.size != view.receivers.size) {
            self.targets = Some(self.targets(view.receivers.size)?);
        }
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        let (Some(targets), Some((_, mean))) = (&self.targets, &self.mean) else { return Ok(()) };
        let mut stats = Stats::default();
        for (i, light) in self.lights.iter().enumerate() {
            let view = View { light, ..*view };
            self.inner.prepare(&self.gpu, &view)?.record(passes, &targets.one)?;
            let load = if i == 0 { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
            draw(passes, "add a sample", &self.add, &targets.read_one, &targets.sum.view, load);
            let one = self.inner.inside().stats();
            stats.draws += one.draws + 1;
            stats.triangles += one.triangles + 1;
            stats.casters_drawn += one.casters_drawn;
            stats.casters_culled += one.casters_culled;
            stats.bytes = one.bytes;
        }
        let load = wgpu::LoadOp::Clear(wgpu::Color::WHITE);
        let spread = self.spread.as_mut().filter(|spread| spread.is_soft);
        let fresh = spread.as_ref().and_then(|spread| spread.mean.fresh()).unwrap_or(visibility);
        draw(passes, "mean of samples", mean, &targets.read_sum, &fresh.view, load);
        if let Some(spread) = spread {
            spread.mean.record(passes, view, visibility);
            stats.draws += 1;
            stats.triangles += 1;
            stats.bytes += spread.mean.bytes();
        }
        stats.bytes += targets.one.bytes() + targets.sum.bytes();
        self.stats = stats;
        Ok(())
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        self.inner.set(gpu, settings)
    }

    fn set_frame(&mut self, frame: u32) {
        self.spread.iter_mut().for_each(|spread| spread.frame = frame);
        self.inner.set_frame(frame);
    }

    fn draws_host_casters(&self) -> bool {
        self.inner.draws_host_casters()
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

/// All but the sums is the inner technique's, and what it says is of the last sample.
impl Inside for LightSamples {
    inside_of!(inner);

    fn stats(&self) -> Stats {
        self.stats
    }

    fn forget(&mut self) {
        self.spread.iter_mut().for_each(|spread| spread.mean.forget());
        self.inner.inside_mut().forget();
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        // One sample, and what it is added to.
        let of_sums = [("add a sample", 4), ("mean of samples", 2), (HISTORY_PASS, HISTORY_BYTES)];
        let own = of_sums.iter().find(|(name, _)| *name == pass).map(|(_, bytes)| *bytes);
        own.or_else(|| self.inner.inside().reads(pass))
    }
}

fn draw(
    passes: &mut Passes<'_>,
    label: &str,
    pipeline: &wgpu::RenderPipeline,
    read: &wgpu::BindGroup,
    target: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) {
    let mut pass = passes.render(label, &[attachment(target, load)], None);
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, read, &[]);
    pass.draw(0..3, 0..1);
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    entry: &str,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    let format = VisibilityTarget::FORMAT;
    let target = if entry == "add" { additive(format) } else { format.into() };
    Fullscreen { label: entry, module, entry, groups: &[layout], target, constants }.pipeline(gpu)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::assert_forwards;

    #[test]
    fn all_that_is_inside_a_technique_is_inside_the_mean_of_its_samples() {
        assert_forwards(|gpu, inner| Box::new(LightSamples::new(gpu, inner, 4)));
    }
}
