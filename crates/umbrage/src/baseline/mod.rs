//! What any technique costs at least, measured in the same run: the yardsticks that timings are given against.

use crate::depth_maps::MapTechnique;
use crate::{
    error::Error,
    fullscreen::Fullscreen,
    gpu::Gpu,
    passes::Passes,
    receivers::Receivers,
    shader::Shader,
    technique::{Stats, Technique},
    techniques,
    view::View,
    visibility::VisibilityTarget,
};

/// Shaders of the baselines, for the registry's tests.
pub const SHADERS: &[Shader] = &[FLOOR, BARE];

const FLOOR: Shader = Shader::new("floor", include_str!("floor.wgsl"));
const BARE: Shader = Shader::new("bare minimum", include_str!("bare.wgsl"));

/// The floor: one full-screen pass that reads depth and writes visibility. Not a shadow.
pub fn floor(gpu: &Gpu) -> Box<dyn Technique> {
    let module = FLOOR.module(gpu);
    let pipeline = Fullscreen {
        label: "floor",
        module: &module,
        entry: "visibility",
        groups: &[&Receivers::layout(gpu)],
        target: VisibilityTarget::FORMAT.into(),
        constants: &[],
    }
    .pipeline(gpu);
    Box::new(Floor { pipeline })
}

/// The bare minimum of shadow maps of `size` texels: one depth-only pass over the casters that each view sees, one
/// full-screen pass with one compare in the first map, no bias at all. Full of acne; its time is what counts. With more than one of `splits`
/// the views are those of `cascaded` where a light has any.
///
/// # Errors
/// [`Error::Size`] beyond the adapter's limit, [`Error::Setting`] for more splits than there may be.
pub fn bare_minimum(gpu: &Gpu, size: u32, splits: u32) -> Result<Box<dyn Technique>, Error> {
    let of_one = &techniques::shadow_map::INFO;
    let set = [("size".into(), size.to_string()), ("cache".into(), "off".into())];
    let settings = if splits > 1 {
        let more = [("splits".into(), splits.to_string()), ("blend".into(), "off".into())];
        techniques::cascaded::INFO.settings(&[set, more].concat())?.with_defaults_of(of_one.params)
    } else {
        of_one.settings(&set)?
    };
    Ok(Box::new(MapTechnique::new(gpu, &settings, &BARE, 0.0, &[])?.with_every_caster().with_back_faces()))
}

struct Floor {
    pipeline: wgpu::RenderPipeline,
}

impl Technique for Floor {
    fn prepare(&mut self, _: &Gpu, _: &View<'_>) -> Result<(), Error> {
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        let mut pass = passes.render("floor", &[visibility.overwrite()], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    fn stats(&self) -> Stats {
        Stats { draws: 1, triangles: 1, ..Stats::default() }
    }
}
