//! Pictures in and out of files.
//!
//! | file | holds |
//! |---|---|
//! | 8-bit PNG | what is to be looked at: sRGB as it stands, nothing is converted |
//! | 16-bit grey PNG | visibility and other shares, linear: 0 is 0, 65535 is 1 |
//! | EXR | 32-bit floats, linear: one named channel, or R, G, B |
//! | JPEG | read only: textures |
//! | HDR (Radiance RGBE) | read only: environments, linear |
//!
//! Files are written beside their place and then renamed: nothing is ever half-written.

mod cross;
mod load;
mod save;

pub(crate) use cross::{equirectangular_of_cross, side_of_cross};
pub use load::{load_grey, load_mask, load_rgb, load_texture, texture_from_bytes};
pub(crate) use load::{load_within, rgb_from_bytes, texture_within};
pub use save::{PngPixel, png_bytes, save_bytes, save_exr, save_exr_rgb, save_grey16, save_png};
