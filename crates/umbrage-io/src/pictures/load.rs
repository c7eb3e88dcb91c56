//! Pictures from files.

use crate::error::{self, Error};
use image::{DynamicImage, ImageFormat, ImageReader};
use std::io::Cursor;
use std::path::Path;
use umbrage_core::Texture;

/// Reads a PNG or JPEG as a texture; 16-bit pictures lose their lower half.
///
/// # Errors
/// A file that cannot be read, is damaged, or of another kind.
pub fn load_texture(path: &Path) -> Result<Texture, Error> {
    texture_from_bytes(path, &error::read(path)?)
}

/// The same from the bytes of a PNG or JPEG; errors call it `name`.
///
/// # Errors
/// As [`load_texture`].
pub fn texture_from_bytes(name: &Path, bytes: &[u8]) -> Result<Texture, Error> {
    let picture = decode(name, bytes, &[ImageFormat::Png, ImageFormat::Jpeg])?.into_rgba8();
    let (width, height) = picture.dimensions();
    let rgba = picture.pixels().map(|p| p.0).collect();
    Ok(Texture { name: name.display().to_string(), width, height, rgba })
}

/// Decodes a picture of one of the `formats`, told by its first bytes.
fn decode(name: &Path, bytes: &[u8], formats: &[ImageFormat]) -> Result<DynamicImage, Error> {
    let names: Vec<&str> = formats.iter().flat_map(|f| f.extensions_str().first()).copied().collect();
    let format = image::guess_format(bytes).ok().filter(|f| formats.contains(f)).ok_or_else(|| {
        Error::new(name, "is not a picture of a known kind").remedy(format!("known are: {}", names.join(", ")))
    })?;
    let picture = ImageReader::with_format(Cursor::new(bytes), format)
        .decode()
        .map_err(|e| Error::new(name, format!("is damaged or cut off: {e}")).remedy("export it again"))?;
    if picture.width() == 0 || picture.height() == 0 {
        return Err(Error::new(name, "has no pixels"));
    }
    Ok(picture)
}
