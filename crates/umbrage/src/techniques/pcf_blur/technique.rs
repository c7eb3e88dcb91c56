//! A frame: maps, visibility, blur.

use super::blur::ScreenBlur;
use crate::depth_maps::MapTechnique;
use crate::technique::{DebugView, Inside, Stats, Technique};
use crate::{error::Error, gpu::Gpu, passes::Passes, settings::Settings, view::View, visibility::VisibilityTarget};
use umbrage_core::light_view::LightView;

pub(super) struct Blurred {
    source: MapTechnique,
    /// None for a radius of 0.
    blur: Option<ScreenBlur>,
}

impl Blurred {
    pub(super) fn new(source: MapTechnique, blur: Option<ScreenBlur>) -> Self {
        Self { source, blur }
    }
}

impl Technique for Blurred {
    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) -> Result<(), Error> {
        self.source.prepare(gpu, view)?;
        if let Some(blur) = &mut self.blur {
            blur.prepare(gpu, view);
        }
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) -> Result<(), Error> {
        self.source.record(passes, view, visibility)?;
        if let Some(blur) = &mut self.blur {
            blur.record(passes, view.receivers, visibility);
        }
        Ok(())
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        self.source.set(gpu, settings)
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
    fn stats(&self) -> Stats {
        let mut stats = self.source.stats();
        if let Some(blur) = &self.blur {
            stats.draws += 1;
            stats.triangles += blur.triangles();
            stats.bytes += blur.bytes();
        }
        stats
    }

    fn forget(&mut self) {
        self.source.forget();
    }

    fn light_views(&self) -> &[LightView] {
        self.source.light_views()
    }

    fn split_distances(&self) -> &[f64] {
        self.source.split_distances()
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        self.source.counts()
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.source.inspect(view);
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        self.source.debug_views()
    }
}
