//! What any technique costs at least, measured in the same run: the yardsticks that timings are
//! given against.

use crate::depth_maps::{Blend, Cover, Depth, Map, MapTechnique};
use crate::{
    error::Error,
    fullscreen::Fullscreen,
    gpu::Gpu,
    passes::Passes,
    receivers::Receivers,
    shader::Shader,
    technique::{InOrder, Inside, Stats, Technique},
    techniques::cascaded::Cascaded,
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

/// The bare minimum of shadow maps of `size` texels: one depth-only pass over the casters that each
/// view sees, one full-screen pass with one compare in the first map, no bias at all. Full of acne;
/// its time is what counts. With more than one of `splits` the views are those of `cascaded` where
/// a light has any.
///
/// # Errors
/// [`Error::Size`] beyond the adapter's limit, and for more splits than there may be.
pub fn bare_minimum(gpu: &Gpu, size: u32, splits: u32) -> Result<Box<dyn Technique>, Error> {
    let map = Map { size, cache: false, ..Map::default() };
    let setup = if splits > 1 {
        let most = umbrage_core::splits::MOST_SPLITS;
        if splits as usize > most {
            return Err(Error::Size { what: "splits".into(), size: splits.into(), limit: most as u64 });
        }
        Cascaded { map, splits, blend: Blend::Off, ..Cascaded::default() }.setup()
    } else {
        map.covering(&Cover::default(), Depth::Projective)
    };
    Ok(Box::new(MapTechnique::new(gpu, &setup, &BARE, 0.0, &[])?.with_every_caster().with_back_faces()))
}

struct Floor {
    pipeline: wgpu::RenderPipeline,
}

impl Technique for Floor {
    fn prepare_view(&mut self, _: &Gpu, _: &View<'_>, _: InOrder) -> Result<(), Error> {
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
        let mut pass = passes.render("floor", &[visibility.overwrite()], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Floor {
    fn stats(&self) -> Stats {
        Stats { draws: 1, triangles: 1, ..Stats::default() }
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        (pass == "floor").then_some(4)
    }
}
