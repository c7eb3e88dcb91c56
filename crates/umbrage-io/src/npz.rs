//! Arrays in `.npz` files: a ZIP archive with an `.npy` file for each, as NumPy has them.

use crate::error::{self, Error, Place};
use glam::DVec3;
use npyz::{AutoSerialize, Deserialize, NpyFile, Order, WriteOptions, WriterBuilder};
use std::io::{self, Cursor, Read, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

/// The arrays of an `.npz` file.
pub(crate) struct Arrays<'a> {
    file: &'a Path,
    archive: ZipArchive<Cursor<Vec<u8>>>,
}

impl<'a> Arrays<'a> {
    pub fn open(file: &'a Path) -> Result<Self, Error> {
        let archive = ZipArchive::new(Cursor::new(error::read(file)?))
            .map_err(|e| Error::new(file, format!("is damaged or cut off: {e}")))?;
        Ok(Self { file, archive })
    }

    /// True where there is an array of this name.
    pub fn has(&self, name: &str) -> bool {
        self.archive.index_for_name(&format!("{name}.npy")).is_some()
    }

    /// The values of an array of `shape`, rows first.
    pub fn values<T: Deserialize>(&mut self, name: &str, shape: &[u64]) -> Result<Vec<T>, Error> {
        let (found, values) = self.shaped(name)?;
        if found == shape {
            return Ok(values);
        }
        let what = format!("is of shape {found:?} instead of {shape:?}");
        Err(Error::new(self.file, what).at(Place::Part(format!("array `{name}`"))))
    }

    /// The shape of an array and its values, rows first.
    pub fn shaped<T: Deserialize>(&mut self, name: &str) -> Result<(Vec<u64>, Vec<T>), Error> {
        let error = |what: String| Error::new(self.file, what).at(Place::Part(format!("array `{name}`")));
        let mut bytes = Vec::new();
        self.archive
            .by_name(&format!("{name}.npy"))
            .map_err(|e| error(e.to_string()))?
            .read_to_end(&mut bytes)
            .map_err(|e| error(e.to_string()))?;
        let array = NpyFile::new(bytes.as_slice()).map_err(|e| error(e.to_string()))?;
        if array.order() != Order::C {
            return Err(error("is stored columns first".to_owned()));
        }
        let shape = array.shape().to_vec();
        Ok((shape, array.into_vec().map_err(|e| error(e.to_string()))?))
    }

    /// `channels` values a pixel.
    pub fn picture<T: Deserialize>(
        &mut self,
        name: &str,
        (width, height): (u32, u32),
        channels: u64,
    ) -> Result<Vec<T>, Error> {
        let shape = [u64::from(height), u64::from(width), channels];
        self.values(name, if channels == 1 { &shape[..2] } else { &shape })
    }

    /// A few values; a single one has no dimension.
    pub fn array<T: Deserialize + Copy + Default, const N: usize>(&mut self, name: &str) -> Result<[T; N], Error> {
        let shape: &[u64] = if N == 1 { &[] } else { &[N as u64] };
        let mut array = [T::default(); N];
        for (to, from) in array.iter_mut().zip(self.values(name, shape)?) {
            *to = from;
        }
        Ok(array)
    }

    pub fn vector(&mut self, name: &str) -> Result<DVec3, Error> {
        self.array(name).map(DVec3::from_array)
    }
}

/// An `.npz` file in the making.
pub(crate) struct NewArrays(ZipWriter<Cursor<Vec<u8>>>);

impl Default for NewArrays {
    fn default() -> Self {
        Self(ZipWriter::new(Cursor::new(Vec::new())))
    }
}

impl NewArrays {
    /// Adds an array of `shape`, rows first.
    pub fn add<T: AutoSerialize + Copy>(&mut self, name: &str, shape: &[usize], values: &[T]) -> io::Result<()> {
        let shape: Vec<u64> = shape.iter().map(|n| *n as u64).collect();
        let mut bytes = Vec::new();
        let mut writer = WriteOptions::new().default_dtype().shape(&shape).writer(&mut bytes).begin_nd()?;
        writer.extend(values.iter().copied())?;
        writer.finish()?;
        // Files of four GiB and more need the larger headers.
        let options = SimpleFileOptions::default().large_file(bytes.len() > u32::MAX as usize / 2);
        self.0.start_file(format!("{name}.npy"), options)?;
        self.0.write_all(&bytes)
    }

    /// The whole file.
    pub fn finished(self) -> io::Result<Vec<u8>> {
        Ok(self.0.finish()?.into_inner())
    }
}
