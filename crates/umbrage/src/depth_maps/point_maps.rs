//! The maps of one point of a light, for techniques that look up those of several points in one
//! frame.

use super::draw::Drawer;
use super::fit::{Fitter, Views};
use super::frame::MapFrame;
use super::lookup::{Lookup, LookupInput};
use super::setup::{Depth, Faces, MapSetup};
use crate::casters::Casters;
use crate::{gpu::Gpu, passes::Passes, technique::Stats, view::View};
use umbrage_core::light_view::Focus;

/// All of a map technique but the look-up itself, whose pipelines are those of all points. Where
/// there are others, every caster is in the maps, flat ones too, since it may be a receiver.
pub(crate) struct PointMaps {
    is_linear: bool,
    frame: MapFrame,
    fit: Fitter,
    draw: Drawer,
    pub input: LookupInput,
}

impl PointMaps {
    /// `reach_texels`: how far the shader looks around a receiver in the map.
    pub fn new(gpu: &Gpu, setup: &MapSetup, reach_texels: f64) -> Self {
        let MapSetup { size, faces, cache, bias, depth, .. } = *setup;
        Self {
            is_linear: depth == Depth::Linear,
            frame: MapFrame { size, border_texels: reach_texels + 1.0, ..MapFrame::default() },
            fit: Fitter::new(Views::of(setup)),
            draw: Drawer::new(gpu, faces == Faces::Back, faces == Faces::Midpoint, cache),
            input: LookupInput::new(gpu, bias),
        }
    }

    /// Chooses views and casters. `view` has the point as its light; `apart_m` is how far the
    /// others are whose shadows end on this point's maps, which then cover more than what is seen.
    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, apart_m: f64, lookup: &mut Lookup) {
        self.fit.apart_m = if self.fit.choice.focus() == Focus::Visible { apart_m } else { 0.0 };
        self.fit.prepare(view, self.is_linear, &mut self.frame);
        let has_others = apart_m > 0.0;
        if std::mem::replace(&mut self.draw.every_caster, has_others) != has_others {
            self.draw.forget();
        }
        self.draw.prepare(gpu, view, &mut self.frame);
        self.look_up(gpu, view, lookup);
    }

    /// Chooses another look-up.
    pub fn look_up(&mut self, gpu: &Gpu, view: &View<'_>, lookup: &mut Lookup) {
        lookup.prepare(gpu, view, &self.frame, &mut self.input);
    }

    /// The maps of this frame.
    pub fn frame(&self) -> &MapFrame {
        &self.frame
    }

    /// Uploads and draws; returns the number of draws.
    pub fn record(&mut self, passes: &mut Passes<'_>, casters: &Casters) -> u32 {
        self.input.upload(passes);
        self.draw.record(passes, casters, &self.frame)
    }

    /// Nothing that was drawn is kept.
    pub fn forget(&mut self) {
        self.draw.forget();
    }

    /// All but the number of draws.
    pub fn stats(&self) -> Stats {
        let stats = self.draw.stats(&self.frame);
        Stats { bytes: stats.bytes + self.input.bytes(), ..stats }
    }
}
