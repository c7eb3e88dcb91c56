//! Accessors: typed arrays in buffers, every range checked.

use super::{buffers, document};
use crate::error::{Error, Place};
use crate::limits::{Budget, MOST_NUMBERS, MOST_ZEROS};
use gltf::Accessor;
use gltf::accessor::DataType;
use gltf::buffer::View;
use std::cell::RefCell;
use std::path::Path;

/// Reads arrays out of the buffers of a file.
pub(super) struct Accessors<'a> {
    path: &'a Path,
    buffers: &'a [Vec<u8>],
    /// Numbers that may still be read: many primitives may name the same large array.
    numbers: RefCell<Budget>,
}

/// One array, for errors.
struct Array<'a> {
    path: &'a Path,
    index: usize,
}

impl Array<'_> {
    fn error(&self, what: impl std::fmt::Display) -> Error {
        Error::new(self.path, what)
            .at(Place::Part(format!("accessor {}", self.index)))
            .remedy("the file may be cut off or damaged: export it again")
    }
}

impl<'a> Accessors<'a> {
    pub fn new(path: &'a Path, buffers: &'a [Vec<u8>]) -> Self {
        Self { path, buffers, numbers: RefCell::new(Budget::new(MOST_NUMBERS)) }
    }

    /// Elements of `N` numbers as floats; whole numbers are normalised where the accessor says so.
    pub fn floats<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[f32; N]>, Error> {
        let (kind, normalized) = (accessor.data_type(), accessor.normalized());
        self.elements(accessor, |bytes| float(kind, normalized, bytes))
    }

    /// Elements of `N` whole numbers.
    pub fn integers<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[u32; N]>, Error> {
        let kind = accessor.data_type();
        if !matches!(kind, DataType::U8 | DataType::U16 | DataType::U32) {
            return Err(self.array(accessor).error(format!("must hold whole numbers of 0 and up, not {kind:?}")));
        }
        self.elements(accessor, |bytes| integer(kind, bytes))
    }

    fn array(&self, accessor: &Accessor<'_>) -> Array<'a> {
        Array { path: self.path, index: accessor.index() }
    }

    fn elements<const N: usize, T: Copy + Default>(
        &self,
        accessor: &Accessor<'_>,
        number: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<[T; N]>, Error> {
        let array = self.array(accessor);
        let found = accessor.dimensions().multiplicity();
        if found != N {
            return Err(array.error(format!("has elements of {found} numbers instead of {N}")));
        }
        let (number_size, count) = (accessor.data_type().size(), accessor.count());
        let needed = (count as u64).saturating_mul(N as u64);
        if !self.numbers.borrow_mut().take(needed) {
            let what = format!("its {count} elements are more than are read: {MOST_NUMBERS} numbers of a file");
            return Err(array.error(what).remedy("export less detail, or several files"));
        }
        let element = |bytes: &[u8]| {
            let mut numbers = [T::default(); N];
            for (to, from) in numbers.iter_mut().zip(bytes.chunks_exact(number_size)) {
                *to = number(from);
            }
            numbers
        };
        let size = N * number_size;
        let mut elements: Vec<[T; N]> = match accessor.view() {
            Some(view) => {
                let slices = self.slices(&array, &view, accessor.offset(), count, size)?;
                slices.map(element).collect()
            }
            None if count <= MOST_ZEROS => vec![[T::default(); N]; count],
            None => {
                let what = format!("holds {count} elements and no bytes; at most {MOST_ZEROS} are made up");
                return Err(array.error(what));
            }
        };
        if let Some(sparse) = accessor.sparse() {
            let (indices, values) = (sparse.indices(), sparse.values());
            let index_kind = match indices.index_type() {
                gltf::accessor::sparse::IndexType::U8 => DataType::U8,
                gltf::accessor::sparse::IndexType::U16 => DataType::U16,
                gltf::accessor::sparse::IndexType::U32 => DataType::U32,
            };
            let count = sparse.count();
            let at = self.slices(&array, &indices.view(), indices.offset(), count, index_kind.size())?;
            let values = self.slices(&array, &values.view(), values.offset(), count, size)?;
            for (index, value) in at.map(|bytes| integer(index_kind, bytes)).zip(values) {
                *elements
                    .get_mut(index as usize)
                    .ok_or_else(|| array.error(format!("its sparse index {index} is out of range")))? = element(value);
            }
        }
        Ok(elements)
    }

    /// `count` slices of `size` bytes or more, each an element and what lies between it and the
    /// next.
    fn slices(
        &self,
        array: &Array<'_>,
        view: &View<'_>,
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, Error> {
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(array.error(format!("its elements of {size} bytes overlap: they are {stride} apart")));
        }
        let length = match count.checked_sub(1) {
            Some(rest) => rest.checked_mul(stride).and_then(|n| n.checked_add(size)),
            None => Some(0),
        };
        if let Some(extension) = compression(view) {
            let what = format!("its numbers are stored by `{extension}`, which cannot be read");
            return Err(array.error(what).remedy(document::remedy(extension)));
        }
        let bytes = buffers::view(self.buffers, view)
            .ok_or_else(|| array.error(format!("buffer view {} does not lie within its buffer", view.index())))?;
        let end = length.and_then(|length| length.checked_add(offset));
        let bytes = end
            .and_then(|end| bytes.get(offset..end))
            .ok_or_else(|| array.error(format!("{count} elements do not fit into buffer view {}", view.index())))?;
        Ok(bytes.chunks(stride))
    }
}

/// The extension that compresses a view, where there is nothing to fall back to.
fn compression(view: &View<'_>) -> Option<&'static str> {
    let extensions = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
    let found = extensions.into_iter().find(|name| view.extension_value(name).is_some())?;
    buffers::is_empty_fallback(&view.buffer()).then_some(found)
}

/// A number of little-endian bytes; 0 for too few of them.
fn integer(kind: DataType, bytes: &[u8]) -> u32 {
    match (kind, bytes) {
        (DataType::U8, &[a, ..]) => u32::from(a),
        (DataType::U16, &[a, b, ..]) => u32::from(u16::from_le_bytes([a, b])),
        (DataType::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
        _ => 0,
    }
}

/// The same as a float; normalised after the specification's section 3.6.2.2.
fn float(kind: DataType, normalized: bool, bytes: &[u8]) -> f32 {
    let scaled = |value: f32, largest: f32| if normalized { (value / largest).max(-1.0) } else { value };
    match (kind, bytes) {
        (DataType::F32, &[a, b, c, d, ..]) => f32::from_le_bytes([a, b, c, d]),
        (DataType::I8, &[a, ..]) => scaled(f32::from(a as i8), 127.0),
        (DataType::I16, &[a, b, ..]) => scaled(f32::from(i16::from_le_bytes([a, b])), 32767.0),
        (DataType::U8, _) => scaled(integer(kind, bytes) as f32, 255.0),
        (DataType::U16, _) => scaled(integer(kind, bytes) as f32, 65535.0),
        _ => scaled(integer(kind, bytes) as f32, u32::MAX as f32),
    }
}
