//! What a renderer hands out, read back without waiting, for browsers.

use crate::{Renderer, lit::Target, no_pass};
use umbrage::{Answer, Error};
use umbrage_core::Image;

impl Renderer {
    pub(crate) fn target(&self, pass: usize) -> Result<&Target, Error> {
        self.lights.get(pass).map(|lit| &lit.target).ok_or_else(|| no_pass(pass))
    }

    /// The visibility that pass number `pass` left, 0…1, as a future that ends only while somebody
    /// polls the device, as browsers do; where threads may wait, `Renderer::visibility` does.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is no such pass; [`Error::Unsupported`] where it answers with
    /// radiance; [`Error::DeviceLost`] and [`Error::Driver`].
    pub async fn visibility_async(&self, pass: usize) -> Result<Image<f32>, Error> {
        match self.target(pass)? {
            Target::Visibility(target, _) => target.read_async(&self.gpu).await,
            Target::Radiance(..) => Answer::Radiance.refuse(),
        }
    }
}
