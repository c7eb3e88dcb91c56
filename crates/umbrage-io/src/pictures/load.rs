//! Pictures from files.

use crate::error::{self, Error};
use crate::files::Files;
use crate::limits::{Budget, MOST_PIXELS, MOST_PIXELS_IN_ALL};
use exr::prelude::{AnyChannels, FlatSamples, MetaData, ReadChannels, ReadLayers};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use std::io::Cursor;
use std::path::Path;
use umbrage_core::{Image, Sampling, Texture};

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
    texture_within(name, bytes, &mut Budget::new(MOST_PIXELS))
}

/// Reads a texture as [`load_texture`] does, as long as there are pixels left.
pub(crate) fn load_within(files: Files<'_>, path: &Path, pixels: &mut Budget) -> Result<Texture, Error> {
    texture_within(path, &files.read(path)?, pixels)
}

/// The same from bytes.
pub(crate) fn texture_within(name: &Path, bytes: &[u8], pixels: &mut Budget) -> Result<Texture, Error> {
    let picture = decode(name, bytes, &[ImageFormat::Png, ImageFormat::Jpeg], pixels)?.into_rgba8();
    let (width, height) = picture.dimensions();
    // In place, where the memory allows it.
    let rgba = bytemuck::allocation::try_cast_vec(picture.into_raw())
        .unwrap_or_else(|(_, bytes)| bytes.as_chunks::<4>().0.to_vec());
    Ok(Texture { name: name.display().to_string(), width, height, rgba, sampling: Sampling::default() })
}

/// Reads a grey picture: an 8-bit or 16-bit PNG as 0…1, or an EXR with a channel `V`, `Y` or `Z`,
/// or with one channel of any name, as it stands.
///
/// # Errors
/// As [`load_texture`]; a picture in colour.
pub fn load_grey(path: &Path) -> Result<Image<f32>, Error> {
    let bytes = error::read(path)?;
    if image::guess_format(&bytes).ok() == Some(ImageFormat::OpenExr) {
        return Exr::decode(path, &bytes)?.grey(path);
    }
    let (width, height, data) = match decode(path, &bytes, &[ImageFormat::Png], &mut Budget::new(MOST_PIXELS))? {
        DynamicImage::ImageLuma8(p) => (p.width(), p.height(), p.iter().map(|v| f32::from(*v) / 255.0).collect()),
        DynamicImage::ImageLuma16(p) => (p.width(), p.height(), p.iter().map(|v| f32::from(*v) / 65535.0).collect()),
        _ => return Err(Error::new(path, "is a picture in colour").remedy("a grey one is needed, 8 or 16 bits")),
    };
    Ok(Image { width, height, data })
}

/// Reads a grey picture as a mask: true at one half and above.
///
/// # Errors
/// As [`load_grey`].
pub fn load_mask(path: &Path) -> Result<Image<bool>, Error> {
    load_grey(path).map(|image| image.map(|v| *v >= 0.5))
}

/// Reads a linear picture in colour: an EXR with channels R, G and B, or an HDR (Radiance).
///
/// # Errors
/// As [`load_texture`].
pub fn load_rgb(path: &Path) -> Result<Image<[f32; 3]>, Error> {
    rgb_from_bytes(path, &error::read(path)?)
}

/// The same from bytes; errors call them `path`.
pub(crate) fn rgb_from_bytes(path: &Path, bytes: &[u8]) -> Result<Image<[f32; 3]>, Error> {
    if image::guess_format(bytes).ok() == Some(ImageFormat::OpenExr) {
        return Exr::decode(path, bytes)?.rgb(path);
    }
    let picture = decode(path, bytes, &[ImageFormat::Hdr], &mut Budget::new(MOST_PIXELS))?.into_rgb32f();
    let (width, height) = picture.dimensions();
    let data = bytemuck::allocation::try_cast_vec(picture.into_raw())
        .unwrap_or_else(|(_, numbers)| numbers.as_chunks::<3>().0.to_vec());
    Ok(Image { width, height, data })
}

/// Decodes a picture of one of the `formats`, told by its first bytes. Its size is believed, and
/// memory taken, only if that many `pixels` are left.
fn decode(name: &Path, bytes: &[u8], formats: &[ImageFormat], pixels: &mut Budget) -> Result<DynamicImage, Error> {
    let names: Vec<&str> = formats.iter().flat_map(|f| f.extensions_str().first()).copied().collect();
    let format = image::guess_format(bytes).ok().filter(|f| formats.contains(f)).ok_or_else(|| {
        Error::new(name, "is not a picture of a kind that can be read here")
            .remedy(format!("such are: {}", names.join(", ")))
    })?;
    let damaged =
        |e: image::ImageError| Error::new(name, format!("is damaged or cut off: {e}")).remedy("export it again");
    let decoder = ImageReader::with_format(Cursor::new(bytes), format).into_decoder().map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 {
        return Err(Error::new(name, "has no pixels").remedy("export it again"));
    }
    let count = u64::from(width) * u64::from(height);
    if count > MOST_PIXELS {
        return Err(too_large(name, width as usize, height as usize));
    }
    if !pixels.take(count) {
        let what =
            format!("is one picture of {width} × {height} pixels too many: of a model {MOST_PIXELS_IN_ALL} are read");
        return Err(Error::new(name, what).remedy("scale the pictures down, or name fewer"));
    }
    if format == ImageFormat::Png && count * png_bits(bytes) / 8 > MOST_PACKED * bytes.len() as u64 {
        let what = format!("is cut off: {width} × {height} pixels do not come out of {} bytes", bytes.len());
        return Err(Error::new(name, what).remedy("export it again"));
    }
    DynamicImage::from_decoder(decoder).map_err(damaged)
}

/// Bits of a pixel as a PNG packs it: its header has the depth and the kind of colour at the bytes
/// 24 and 25.
fn png_bits(bytes: &[u8]) -> u64 {
    let [depth, kind] = [24, 25].map(|at| bytes.get(at).copied().unwrap_or(0));
    let channels = match kind {
        2 => 3,
        4 => 2,
        6 => 4,
        _ => 1,
    };
    u64::from(depth) * channels
}

/// How many bytes may come out of one: what deflate packs best, rounded up.
const MOST_PACKED: u64 = 1100;

fn too_large(name: &Path, width: usize, height: usize) -> Error {
    let what = format!("is too large with {width} × {height} pixels: {MOST_PIXELS} are read of a picture");
    Error::new(name, what).remedy("scale it down")
}

/// An EXR with all channels of its first layer.
struct Exr {
    size: (u32, u32),
    channels: Vec<(String, Vec<f32>)>,
}

impl Exr {
    fn decode(path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        let damaged = |what: String| {
            Error::new(path, format!("is damaged or cut off: {what}")).remedy("export it again, with flat pixels")
        };
        let meta = MetaData::read_from_buffered(bytes, false).map_err(|e| damaged(e.to_string()))?;
        for header in &meta.headers {
            let [width, height] = [header.layer_size.width(), header.layer_size.height()];
            if width == 0 || height == 0 {
                return Err(damaged(format!("its size is {width} × {height}")));
            }
            let values = (width as u64).saturating_mul(height as u64).saturating_mul(header.channels.list.len() as u64);
            if values > MOST_PIXELS {
                return Err(too_large(path, width, height));
            }
            if values > MOST_PACKED * bytes.len() as u64 {
                return Err(damaged(format!("{width} × {height} pixels do not come out of {} bytes", bytes.len())));
            }
        }
        let layer = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            // Threads would work on, and hold memory, after an error.
            .non_parallel()
            .from_buffered(Cursor::new(bytes))
            .map_err(|e| damaged(e.to_string()))?
            .layer_data;
        let AnyChannels { list }: AnyChannels<FlatSamples> = layer.channel_data;
        let channels: Vec<(String, Vec<f32>)> =
            list.iter().map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect())).collect();
        let pixels = layer.size.area();
        if let Some((name, _)) = channels.iter().find(|(_, values)| values.len() != pixels) {
            return Err(damaged(format!("channel `{name}` is subsampled")));
        }
        Ok(Self { size: (layer.size.width() as u32, layer.size.height() as u32), channels })
    }

    fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|(n, _)| n == name).map(|(_, values)| values.as_slice())
    }

    fn missing(&self, path: &Path, wanted: &str) -> Error {
        let names: Vec<&str> = self.channels.iter().map(|(n, _)| n.as_str()).collect();
        Error::new(path, format!("has no channel {wanted} but {}", names.join(", "))).remedy("name another picture")
    }

    fn grey(&self, path: &Path) -> Result<Image<f32>, Error> {
        let only = || self.channels.first().filter(|_| self.channels.len() == 1).map(|(_, values)| values.as_slice());
        let values = ["V", "Y", "Z"].iter().find_map(|n| self.channel(n)).or_else(only);
        let data = values.ok_or_else(|| self.missing(path, "V, Y or Z"))?.to_vec();
        Ok(Image { width: self.size.0, height: self.size.1, data })
    }

    fn rgb(&self, path: &Path) -> Result<Image<[f32; 3]>, Error> {
        let channel = |name| self.channel(name).ok_or_else(|| self.missing(path, name));
        let (r, g, b) = (channel("R")?, channel("G")?, channel("B")?);
        let data = r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b]).collect();
        Ok(Image { width: self.size.0, height: self.size.1, data })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::{save_exr_rgb, save_grey16, save_png};

    #[test]
    fn an_hdr_is_read_as_linear_colour() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("sky.hdr");
        let pixels = [image::Rgb([1.0, 2.0, 4.0]), image::Rgb([0.5, 0.25, 0.0])];
        let mut bytes = Vec::new();
        image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&pixels, 2, 1).unwrap();
        std::fs::write(&path, bytes).unwrap();
        let image = load_rgb(&path).unwrap();
        for (got, want) in image.data.iter().zip(pixels) {
            assert!(got.iter().zip(want.0).all(|(a, b)| (a - b).abs() <= 0.02 * b), "{got:?} for {want:?}");
        }
    }

    #[test]
    fn plain_pictures_pack_well_and_are_read() {
        // Pixels of 1 bit each, all alike, is what deflate packs best.
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("plain.png");
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 4000, 4000);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::One);
        encoder.set_compression(png::Compression::High);
        encoder.write_header().unwrap().write_image_data(&vec![0; 2_000_000]).unwrap();
        assert!(bytes.len() < 10_000, "{} bytes", bytes.len());
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(load_texture(&path).unwrap().rgba.len(), 16_000_000);
    }

    #[test]
    fn pictures_of_the_wrong_kind_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.png");
        save_png(&path, &Image::filled(2, 2, [1u8, 2, 3])).unwrap();
        assert!(load_grey(&path).unwrap_err().to_string().contains("in colour"));
        assert!(load_rgb(&path).unwrap_err().to_string().ends_with("such are: hdr"));
        std::fs::write(&path, "text").unwrap();
        assert!(load_texture(&path).unwrap_err().to_string().contains("not a picture"));
        save_exr_rgb(&path, &Image::filled(2, 2, [0.0; 3])).unwrap();
        assert!(load_grey(&path).unwrap_err().to_string().contains("no channel V, Y or Z but B, G, R"));
    }

    #[test]
    fn pictures_cut_off_anywhere_are_errors() {
        let dir = tempfile::tempdir().unwrap();
        let (png, exr) = (dir.path().join("a.png"), dir.path().join("a.exr"));
        save_grey16(&png, &Image::from_fn(9, 9, |x, y| (x * y) as f32 / 64.0)).unwrap();
        save_exr_rgb(&exr, &Image::from_fn(9, 9, |x, y| [x as f32, y as f32, 0.5])).unwrap();
        let cut = dir.path().join("cut");
        for (path, load) in
            [(&png, (|p| load_grey(p).map(drop)) as fn(&Path) -> Result<(), Error>), (&exr, |p| load_rgb(p).map(drop))]
        {
            let whole = std::fs::read(path).unwrap();
            for length in (0..whole.len() - 12).step_by(3) {
                std::fs::write(&cut, &whole[..length]).unwrap();
                assert!(load(&cut).is_err(), "{} cut off after {length} bytes", path.display());
            }
            for i in 0..whole.len() {
                let mut damaged = whole.clone();
                damaged[i] ^= 0x55;
                std::fs::write(&cut, &damaged).unwrap();
                // Some bytes are only names and dates: no error is fine, a panic is not.
                let _ = load(&cut);
            }
        }
    }
}
