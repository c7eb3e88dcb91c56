//! Casters with alpha masks beside techniques that know casters by their edges or triangles alone:
//! these are looked up in maps of their own, and of both visibilities the smaller one counts.

use crate::depth_maps::{Cover, Depth, Held, Map, MapSetup};
use crate::fullscreen::{self, FLOATS, Fullscreen, attachment, bind, smaller};
use crate::inline::Lent;
use crate::registry::FilterId;
use crate::shader::Shader;
use crate::technique::{InOrder, Inside, Stats, Technique, inside_of};
use crate::{Error, Gpu, Passes, Settings, View, VisibilityTarget, choices, settings};

/// The shader, for the registry's tests.
pub(crate) const SHADERS: [&Shader; 1] = [&SHADER];

const SHADER: Shader = Shader::new("masked casters", include_str!("masked.wgsl"));

/// Name of the pass that takes the smaller visibility.
const PASS: &str = "masked casters";

choices! {
    /// What casters with alpha masks shadow.
    pub enum MaskedBy {
        /// What maps of their own say.
        Maps = "maps",
        /// What they would without the mask.
        Whole = "whole",
    }
}

settings! {
    /// What becomes of casters with alpha masks.
    pub struct Masked {
        /// What casters with alpha masks shadow: what `shadow-map` (under `volume`) or `pcss` finds
        /// in maps of these casters alone, which are made where there are any; or their whole
        /// triangles.
        masked: MaskedBy = MaskedBy::Maps,
        /// Width and height of these maps.
        masked_size: u32 = 2048, in 1..=16384, unit "texels",
    }
}

impl Masked {
    /// Masked casters are left to maps.
    pub fn leaves_out(&self) -> bool {
        self.masked == MaskedBy::Maps
    }

    /// `inner`, which [leaves masked casters out](Masked::leaves_out), and `filter` for them.
    pub(crate) fn beside(&self, gpu: &Gpu, inner: Box<dyn Technique>, filter: FilterId) -> Box<dyn Technique> {
        if !self.leaves_out() {
            return inner;
        }
        let map = Map { size: self.masked_size, ..Map::default() };
        let setup = MapSetup { held: Held::Masked, ..map.covering(&Cover::default(), Depth::Projective) };
        Box::new(WithMasked::new(gpu, inner, filter, setup))
    }
}

/// A technique, and maps of the casters that it leaves out.
pub(crate) struct WithMasked {
    gpu: Gpu,
    inner: Box<dyn Technique>,
    filter: FilterId,
    setup: MapSetup,
    layout: wgpu::BindGroupLayout,
    /// Once there was a masked caster.
    maps: Option<Box<dyn Technique>>,
    pipeline: Option<wgpu::RenderPipeline>,
    target: Option<(VisibilityTarget, wgpu::BindGroup)>,
    /// There are masked casters in the frame that was prepared.
    is_used: bool,
}

impl WithMasked {
    fn new(gpu: &Gpu, inner: Box<dyn Technique>, filter: FilterId, setup: MapSetup) -> Self {
        let stages = wgpu::ShaderStages::FRAGMENT;
        let layout = fullscreen::layout(gpu, PASS, stages, &[fullscreen::texture(FLOATS)]);
        let gpu = gpu.clone();
        Self { gpu, inner, filter, setup, layout, maps: None, pipeline: None, target: None, is_used: false }
    }

    /// The technique that knows no masks.
    pub fn inner_mut(&mut self) -> &mut dyn Technique {
        &mut *self.inner
    }

    fn make_room(&mut self, size: (u32, u32)) -> Result<(), Error> {
        if self.target.as_ref().is_none_or(|(target, _)| target.size != size) {
            let target = VisibilityTarget::new(&self.gpu, size.0, size.1)?;
            let read = [wgpu::BindingResource::TextureView(&target.view)];
            let group = bind(&self.gpu, PASS, &self.layout, &read);
            self.target = Some((target, group));
        }
        if self.pipeline.is_none() {
            let pass = Fullscreen {
                label: PASS,
                module: &SHADER.module(&self.gpu),
                entry: "copied",
                groups: &[&self.layout],
                target: smaller(VisibilityTarget::FORMAT),
                constants: &[],
            };
            self.pipeline = Some(pass.pipeline(&self.gpu));
        }
        Ok(())
    }
}

impl Technique for WithMasked {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, order: InOrder) -> Result<(), Error> {
        self.inner.prepare_view(gpu, view, order)?;
        self.is_used = view.casters.has_masked();
        if self.is_used {
            self.make_room(view.receivers.size)?;
            let maps = match self.maps.take() {
                Some(maps) => maps,
                None => self.filter.make_on(gpu, &self.setup)?,
            };
            self.maps.insert(maps).prepare_view(gpu, view, order)?;
        }
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        order: InOrder,
    ) -> Result<(), Error> {
        self.inner.record_visibility(passes, view, visibility, order)?;
        let (true, Some(maps), Some((target, group)), Some(pipeline)) =
            (self.is_used, &mut self.maps, &self.target, &self.pipeline)
        else {
            return Ok(());
        };
        maps.record_visibility(passes, view, target, order)?;
        let mut pass = passes.render(PASS, &[attachment(&visibility.view, wgpu::LoadOp::Load)], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    fn set_frame(&mut self, frame: u32) {
        self.inner.set_frame(frame);
        self.maps.iter_mut().for_each(|maps| maps.set_frame(frame));
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        self.inner.set(gpu, settings)
    }

    fn lend(&mut self, gpu: &Gpu) -> Result<Lent, Error> {
        self.inner.lend(gpu)
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

/// All but the maps is the inner technique's.
impl Inside for WithMasked {
    inside_of!(inner);

    fn stats(&self) -> Stats {
        let own = self.inner.inside().stats();
        let Some(maps) = self.maps.as_ref().filter(|_| self.is_used) else { return own };
        let more = maps.inside().stats();
        Stats {
            draws: own.draws + more.draws + 1,
            triangles: own.triangles + more.triangles + 1,
            casters_drawn: own.casters_drawn + more.casters_drawn,
            casters_culled: own.casters_culled.saturating_sub(more.casters_drawn),
            bytes: own.bytes + more.bytes + self.target.as_ref().map_or(0, |(target, _)| target.bytes()),
        }
    }

    fn forget(&mut self) {
        self.inner.inside_mut().forget();
        self.maps.iter_mut().for_each(|maps| maps.inside_mut().forget());
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        let of_maps = || self.maps.as_ref()?.inside().reads(pass);
        // What is read, and what it is blended with.
        if pass == PASS { Some(4) } else { self.inner.inside().reads(pass).or_else(of_maps) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::assert_forwards;

    #[test]
    fn all_that_is_inside_a_technique_is_inside_the_one_with_masked_casters() {
        assert_forwards(|gpu, inner| Masked::default().beside(gpu, inner, FilterId::hard()));
    }
}
