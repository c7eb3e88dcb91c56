//! Casters that the host draws itself, among these casters.

use super::host::{CasterView, Host, HostCasters};
use super::world::{Casters, next_version};
use crate::error::Error;
use std::sync::Arc;
use umbrage_core::Bounds;

impl Casters {
    /// Has the host draw casters of its own into the maps of lights, somewhere within `bounds`;
    /// `None` ends that. Techniques that need more than depth refuse such casters: see
    /// [`crate::TechniqueInfo::casters`]. To be called again whenever they move or look otherwise,
    /// or maps that are kept show them as they were.
    ///
    /// # Errors
    /// [`Error::Scene`] for a box that is empty or not finite.
    pub fn set_host_casters(&mut self, new: Option<(Bounds, Arc<dyn HostCasters>)>) -> Result<(), Error> {
        self.host = new.map(|(bounds, draws)| Host::new(bounds, draws)).transpose()?;
        self.version = next_version();
        Ok(())
    }

    /// True where the host draws casters itself.
    pub(crate) fn has_host_casters(&self) -> bool {
        self.host.is_some()
    }

    /// Has the host draw its own casters.
    pub(crate) fn draw_host_casters(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView<'_>) {
        if let Some(host) = &self.host {
            host.draws.draw(pass, view);
        }
    }

    /// The box around what the host draws itself.
    pub(crate) fn host_bounds(&self) -> Option<Bounds> {
        self.host.as_ref().map(|host| host.bounds)
    }
}
