//! Pictures to files.

use crate::Error;
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Layer, LayerAttributes, SmallVec, WritableImage};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use umbrage_core::Image;

mod sealed {
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
    impl Sealed for [u8; 3] {}
    impl Sealed for [u8; 4] {}
}

/// What the pixels of a PNG can be: `u8` and `u16` grey, `[u8; 3]` RGB, `[u8; 4]` RGBA with
/// straight alpha.
pub trait PngPixel: sealed::Sealed {
    /// How the PNG calls it.
    #[doc(hidden)]
    const COLOR: ExtendedColorType;
    /// Appends the pixel in the machine's order of bytes, as the encoder wants it.
    #[doc(hidden)]
    fn append(&self, bytes: &mut Vec<u8>);
}

impl PngPixel for u8 {
    const COLOR: ExtendedColorType = ExtendedColorType::L8;
    fn append(&self, bytes: &mut Vec<u8>) {
        bytes.push(*self);
    }
}

impl PngPixel for u16 {
    const COLOR: ExtendedColorType = ExtendedColorType::L16;
    fn append(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_ne_bytes());
    }
}

impl PngPixel for [u8; 3] {
    const COLOR: ExtendedColorType = ExtendedColorType::Rgb8;
    fn append(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self);
    }
}

impl PngPixel for [u8; 4] {
    const COLOR: ExtendedColorType = ExtendedColorType::Rgba8;
    fn append(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self);
    }
}

/// The bytes of a PNG; errors call it `name`.
///
/// # Errors
/// A picture of size 0, or whose data do not fit its size.
pub fn png_bytes<P: PngPixel>(name: &Path, image: &Image<P>) -> Result<Vec<u8>, Error> {
    check_size(name, image)?;
    let mut pixels = Vec::with_capacity(size_of_val(image.data.as_slice()));
    image.data.iter().for_each(|pixel| pixel.append(&mut pixels));
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(&pixels, image.width, image.height, P::COLOR)
        .map_err(|e| Error::new(name, format!("cannot be encoded: {e}")))?;
    Ok(bytes)
}

/// Writes a PNG.
///
/// # Errors
/// As [`png_bytes`] and [`save_bytes`].
pub fn save_png<P: PngPixel>(path: &Path, image: &Image<P>) -> Result<(), Error> {
    save_bytes(path, &png_bytes(path, image)?)
}

/// Writes shares, such as visibility, as a linear 16-bit grey PNG: 0 becomes 0, 1 becomes 65535,
/// what is beyond is cut off there.
///
/// # Errors
/// A value that is not a number, and as [`save_png`].
pub fn save_grey16(path: &Path, image: &Image<f32>) -> Result<(), Error> {
    check_size(path, image)?;
    if let Some(i) = image.data.iter().position(|v| v.is_nan()) {
        let (x, y) = (i % image.width as usize, i / image.width as usize);
        return Err(Error::new(path, format!("pixel ({x}, {y}) is not a number")).remedy("save it as EXR to see where"));
    }
    save_png(path, &image.map(|v| (v.clamp(0.0, 1.0) * 65535.0).round() as u16))
}

/// Writes an EXR of one 32-bit float channel: `V` for visibility, `Z` for depth.
///
/// # Errors
/// As [`save_png`].
pub fn save_exr(path: &Path, image: &Image<f32>, channel: &str) -> Result<(), Error> {
    check_size(path, image)?;
    save_channels(path, image.size(), vec![(channel, image.data.clone())])
}

/// Writes an EXR of 32-bit float channels R, G and B, linear.
///
/// # Errors
/// As [`save_png`].
pub fn save_exr_rgb(path: &Path, image: &Image<[f32; 3]>) -> Result<(), Error> {
    check_size(path, image)?;
    let channel = |i: usize| image.data.iter().map(|p| p[i]).collect();
    save_channels(path, image.size(), vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))])
}

fn save_channels(path: &Path, (width, height): (u32, u32), channels: Vec<(&str, Vec<f32>)>) -> Result<(), Error> {
    let channels: SmallVec<_> =
        channels.into_iter().map(|(name, values)| AnyChannel::new(name, FlatSamples::F32(values))).collect();
    let size = (width as usize, height as usize);
    let encoding = Encoding::SMALL_LOSSLESS;
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    exr::image::Image::from_layer(layer)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|e| Error::new(path, format!("cannot be encoded: {e}")))?;
    save_bytes(path, bytes.get_ref())
}

/// Writes a file as a whole: into a temporary file beside it, which then takes its name. Whatever
/// goes wrong, a file that was there before is still there. A symbolic link stays, and the file
/// that it names is written; what is a device or a pipe is written into.
///
/// # Errors
/// A folder that is missing or cannot be written to, a full disk.
pub fn save_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let failed = |e: std::io::Error| {
        Error::new(path, format!("cannot be written: {e}")).remedy("check the path, its permissions and the disk")
    };
    let target = behind_links(path).map_err(failed)?;
    if target.metadata().is_ok_and(|about| !about.is_file() && !about.is_dir()) {
        return std::fs::write(&target, bytes).map_err(failed);
    }
    let path = target.as_path();
    let dir = path.parent().filter(|d| !d.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !dir.is_dir() {
        let what = format!("cannot be written: there is no folder `{}`", dir.display());
        return Err(Error::new(path, what).remedy("create it, or write elsewhere"));
    }
    let write = || {
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        {
            // Temporary files are for the owner alone; the mask of the user decides about this one,
            // as usual.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let mut file = builder.prefix(".umbrage-").tempfile_in(dir)?;
        file.write_all(bytes)?;
        file.persist(path).map_err(|e| e.error)?;
        Ok(())
    };
    write().map_err(failed)
}

/// The file that a chain of symbolic links leads to; it need not be there.
fn behind_links(path: &Path) -> std::io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&path) {
            Ok(next) => path = path.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(path),
        }
    }
    Err(std::io::Error::other("symbolic links lead around in a circle"))
}

/// Links in a chain; more go around in a circle.
const MOST_LINKS: usize = 40;

fn check_size<T>(path: &Path, image: &Image<T>) -> Result<(), Error> {
    let (width, height) = image.size();
    if width == 0 || height == 0 {
        return Err(Error::new(path, format!("a picture of {width} × {height} pixels has nothing to write")));
    }
    if image.data.len() as u64 != u64::from(width) * u64::from(height) {
        let what = format!("{} pixels are no picture of {width} × {height}", image.data.len());
        return Err(Error::new(path, what));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::{load_grey, load_rgb, load_texture};

    #[test]
    fn what_is_saved_is_loaded_again() {
        let dir = tempfile::tempdir().unwrap();
        let path = |name: &str| dir.path().join(name);
        let grey = Image::from_fn(7, 5, |x, y| (x + 7 * y) as f32 / 34.0);

        save_grey16(&path("v.png"), &grey).unwrap();
        let back = load_grey(&path("v.png")).unwrap();
        assert!(grey.data.iter().zip(&back.data).all(|(a, b)| (a - b).abs() <= 0.5 / 65535.0 + 1e-6));

        save_exr(&path("v.exr"), &grey, "V").unwrap();
        assert_eq!(load_grey(&path("v.exr")).unwrap(), grey);

        let rgb = Image::from_fn(33, 20, |x, y| [x as f32 * 1e3, -(y as f32), 1e-3]);
        save_exr_rgb(&path("c.exr"), &rgb).unwrap();
        assert_eq!(load_rgb(&path("c.exr")).unwrap(), rgb);

        let rgba = Image::from_fn(3, 2, |x, y| [x as u8, y as u8, 200, 255 - x as u8]);
        save_png(&path("c.png"), &rgba).unwrap();
        assert_eq!(load_texture(&path("c.png")).unwrap().rgba, rgba.data);
        save_png(&path("g.png"), &Image::from_fn(2, 1, |x, _| 10 + x as u8)).unwrap();
        assert_eq!(load_texture(&path("g.png")).unwrap().rgba, [[10, 10, 10, 255], [11, 11, 11, 255]]);
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 5, "temporary files were left");
    }

    #[test]
    fn bad_pictures_and_places_are_refused_and_nothing_is_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.png");
        let message = |r: Result<(), Error>| r.unwrap_err().to_string();
        assert!(message(save_grey16(&path, &Image::filled(0, 4, 0.0))).contains("a.png: a picture of 0 × 4"));
        assert!(message(save_exr(&path, &Image { width: 2, height: 2, data: vec![0.0] }, "V")).contains("1 pixels"));
        let mut nan = Image::filled(4, 4, 0.5);
        nan[(1, 2)] = f32::NAN;
        assert!(message(save_grey16(&path, &nan)).contains("pixel (1, 2) is not a number"));
        assert!(!path.exists());
        let nowhere = dir.path().join("no/a.png");
        assert!(message(save_png(&nowhere, &Image::filled(1, 1, 0u8))).contains("there is no folder"));
        assert!(message(save_bytes(dir.path(), b"x")).contains("cannot be written"));
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_devices_devices() {
        use std::os::unix::fs::symlink;
        let dir = tempfile::tempdir().unwrap();
        let path = |name: &str| dir.path().join(name);
        std::fs::create_dir(path("far")).unwrap();
        symlink("link", path("chain")).unwrap();
        symlink("far/file", path("link")).unwrap();
        for text in [b"one", b"two"] {
            save_bytes(&path("chain"), text).unwrap();
            assert_eq!(std::fs::read(path("far/file")).unwrap(), text);
        }
        assert!(path("chain").is_symlink() && path("link").is_symlink());
        symlink("b", path("a")).unwrap();
        symlink("a", path("b")).unwrap();
        assert!(save_bytes(&path("a"), b"x").unwrap_err().to_string().contains("circle"));
        symlink("/dev/null", path("null")).unwrap();
        save_bytes(&path("null"), b"x").unwrap();
        let error = save_bytes(Path::new("/dev/full"), b"x").unwrap_err().to_string();
        assert!(error.contains("/dev/full: cannot be written") && Path::new("/dev/full").exists(), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_what_was_written() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let (ours, usual) = (dir.path().join("a"), dir.path().join("b"));
        save_bytes(&ours, b"x").unwrap();
        std::fs::write(&usual, b"x").unwrap();
        let mode = |p: &Path| p.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&usual));
    }
}
