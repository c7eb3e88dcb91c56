//! A frame: maps, visibility, blur.

use super::blur::ScreenBlur;
use crate::technique::{InOrder, Inside, Stats, Technique, inside_of};
use crate::{
    error::Error, gpu::Gpu, inline::Lent, passes::Passes, settings::Settings, view::View, visibility::VisibilityTarget,
};

pub(super) struct Blurred {
    source: Box<dyn Technique>,
    /// None for a radius of 0.
    blur: Option<ScreenBlur>,
}

impl Blurred {
    pub(super) fn new(source: Box<dyn Technique>, blur: Option<ScreenBlur>) -> Self {
        Self { source, blur }
    }
}

impl Technique for Blurred {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, order: InOrder) -> Result<(), Error> {
        self.source.prepare_view(gpu, view, order)?;
        if let Some(blur) = &mut self.blur {
            blur.prepare(gpu, view);
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
        self.source.record_visibility(passes, view, visibility, order)?;
        if let Some(blur) = &mut self.blur {
            blur.record(passes, view.receivers, visibility);
        }
        Ok(())
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        self.source.set(gpu, settings)
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("pcf-blur")
    }

    fn set_frame(&mut self, frame: u32) {
        self.source.set_frame(frame);
    }

    fn draws_host_casters(&self) -> bool {
        self.source.draws_host_casters()
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

/// All of it is the source's, but for what the blur costs.
impl Inside for Blurred {
    inside_of!(source);

    fn stats(&self) -> Stats {
        let mut stats = self.source.inside().stats();
        if let Some(blur) = &self.blur {
            stats.draws += 1;
            stats.triangles += blur.triangles();
            stats.bytes += blur.bytes();
        }
        stats
    }

    fn forget(&mut self) {
        self.source.inside_mut().forget();
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        self.source.inside().reads(pass)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::assert_forwards;

    #[test]
    fn all_that_is_inside_the_source_is_inside_the_blur() {
        assert_forwards(|_, source| Box::new(Blurred::new(source, None)));
    }
}
