//! No shadow: the control that every error is compared with (ZA 5.4).

use crate::casters::Needs;
use crate::{
    error::Error,
    gpu::Gpu,
    inline::Lent,
    passes::Passes,
    settings,
    settings::Configure,
    technique::{Family, InOrder, Inside, SettingsOf, Stats, Technique, TechniqueInfo, storage_buffers},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::LightKinds;

settings! {
    /// See the module; there is nothing to set.
    pub struct NoShadow {}
}

impl Configure for NoShadow {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, _: &Gpu) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(Unshadowed))
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "none",
    title: "No shadow",
    summary: "No shadow at all: every point sees the whole light. The control.",
    source: "ZA 5.4",
    family: Family::Control,
    filter: None,
    lights: LightKinds::ALL,
    casters: Needs::Nothing,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<0>,
    hard: false,
    settings: SettingsOf::new::<NoShadow>(),
    views: &[],
    shaders: &[],
    readme: include_str!("README.md"),
};

struct Unshadowed;

impl Technique for Unshadowed {
    fn prepare_view(&mut self, _: &Gpu, _: &View<'_>, _: InOrder) -> Result<(), Error> {
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        _: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        passes.render("clear", &[visibility.overwrite()], None);
        Ok(())
    }

    fn record_maps(&mut self, _: &mut Passes<'_>, _: &View<'_>, _: InOrder) -> Result<(), Error> {
        Ok(())
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Ok(Lent::LIT)
    }

    fn draws_host_casters(&self) -> bool {
        true
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Unshadowed {
    fn stats(&self) -> Stats {
        Stats::default()
    }
}
