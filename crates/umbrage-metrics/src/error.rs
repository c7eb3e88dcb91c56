//! Why two pictures cannot be compared.

use umbrage_core::Image;

/// Why two pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// The pictures have different sizes.
    #[error(
        "the {name} picture is {}x{} pixels, the reference {}x{}: render both at the same size",
        size.0, size.1, reference.0, reference.1
    )]
    Size {
        /// Which picture: produced, mask, …
        name: &'static str,
        /// Its width and height.
        size: (u32, u32),
        /// Width and height of the reference.
        reference: (u32, u32),
    },
    /// The mask holds no pixel, so that there is nothing to compare.
    #[error("no pixel is scored: the camera sees no receiving surface that faces the light")]
    NothingScored,
}

/// An error unless `picture` is as large as the reference.
pub(crate) fn same_size<T, R>(name: &'static str, picture: &Image<T>, reference: &Image<R>) -> Result<(), Error> {
    if picture.size() == reference.size() {
        Ok(())
    } else {
        Err(Error::Size { name, size: picture.size(), reference: reference.size() })
    }
}
