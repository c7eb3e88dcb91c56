//! No shadow: the control that every error is compared with (ZA 5.4).

use crate::{
    error::Error,
    gpu::Gpu,
    passes::Passes,
    technique::{Stats, Technique, TechniqueInfo},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::LightKinds;

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "none",
    title: "No shadow",
    summary: "Every point sees the whole light; the control.",
    source: "ZA 5.4",
    lights: LightKinds::ALL,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[],
    views: &[],
    shaders: &[],
    readme: include_str!("README.md"),
    make: |_, _| Ok(Box::new(None)),
};

struct None;

impl Technique for None {
    fn prepare(&mut self, _: &Gpu, _: &View<'_>) -> Result<(), Error> {
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, _: &View<'_>, visibility: &VisibilityTarget) -> Result<(), Error> {
        passes.render("clear", &[visibility.overwrite()], Option::None);
        Ok(())
    }

    fn stats(&self) -> Stats {
        Stats::default()
    }
}
