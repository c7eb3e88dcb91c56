//! A frame: choose casters, put them into trees, remove samples.

use super::mask::Mask;
use crate::area_light::{Form, casters_in_view, is_on_a_caster};
use crate::depth_maps::RECEIVER_BYTES;
use crate::technique::{InOrder, Inside, Stats, Technique};
use crate::{error::Error, gpu::Gpu, inline::Lent, passes::Passes, view::View, visibility::VisibilityTarget};

/// What users type.
pub(super) const ID: &str = "light-mask";

/// See the module.
pub(super) struct LightMask {
    samples: u32,
    /// Of points and spots.
    point_radius: f64,
    /// Casters with alpha masks are looked up in maps.
    leaves_masked: bool,
    /// Made when there is something to hide.
    mask: Option<Mask>,
    form: Option<Form>,
    /// Chosen casters, by their number in [`Casters::placed`](crate::casters::Casters::placed).
    chosen: Vec<u32>,
    casting: u32,
    draws: u32,
}

impl LightMask {
    pub fn new(samples: u32, point_radius: f64, leaves_masked: bool) -> Self {
        Self { samples, point_radius, leaves_masked, mask: None, form: None, chosen: Vec::new(), casting: 0, draws: 0 }
    }
}

impl Technique for LightMask {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        // The picture of a light is in its samples.
        let mut form = Form::of(&view.light.shape, false, self.point_radius);
        if form.is_point() && is_on_a_caster(gpu, view, form.center)? {
            form = form.off_ties(view.rounding());
        }
        self.casting = view.casters.casting().len() as u32;
        self.form = Some(form);
        casters_in_view(view, &form, self.leaves_masked, &mut self.chosen);
        if self.chosen.is_empty() {
            return Ok(());
        }
        let mask = self.mask.get_or_insert_with(|| Mask::new(gpu, self.samples));
        mask.prepare(gpu, view, &form, &self.chosen)
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.draws = 0;
        let mask = self.mask.as_mut().filter(|_| !self.chosen.is_empty());
        if let Some((mask, form)) = mask.zip(self.form) {
            mask.record(passes, view, &form, visibility);
            self.draws = 1;
        } else {
            drop(passes.render("visibility", &[visibility.overwrite()], None));
        }
        Ok(())
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("light-mask")
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for LightMask {
    fn stats(&self) -> Stats {
        let chosen = self.chosen.len() as u32;
        Stats {
            draws: self.draws,
            triangles: 0,
            casters_drawn: chosen,
            casters_culled: self.casting.saturating_sub(chosen),
            bytes: self.mask.as_ref().map_or(0, Mask::bytes),
        }
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        (pass == "visibility").then(|| RECEIVER_BYTES + self.mask.as_ref().map_or(0, Mask::most_read))
    }
}
