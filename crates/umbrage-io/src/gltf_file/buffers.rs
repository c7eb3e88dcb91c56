//! Buffers and other bytes that a glTF file refers to.

use super::File;
use crate::error::Error;
use crate::limits::{Budget, MOST_BYTES};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::Document;
use gltf::buffer::Source;

/// The bytes of every buffer, at least as many as it says.
pub(super) fn read(file: &File<'_>, document: &Document, mut blob: Option<Vec<u8>>) -> Result<Vec<Vec<u8>>, Error> {
    let mut left = Budget::new(MOST_BYTES);
    let read_one = |buffer: gltf::Buffer<'_>| {
        let part = format!("buffer {}", buffer.index());
        if is_empty_fallback(&buffer) {
            // What stands in it is only found decompressed.
            return Ok(Vec::new());
        }
        let bytes = match buffer.source() {
            Source::Bin => blob.take().ok_or_else(|| file.error(&part, "there is no binary part for it"))?,
            Source::Uri(uri) => resolve(file, &part, uri)?,
        };
        if bytes.len() < buffer.length() {
            let what = format!("is {} bytes long instead of {}", bytes.len(), buffer.length());
            return Err(file.error(part, what).remedy("the file may be cut off: export it again"));
        }
        if !left.take(bytes.len() as u64) {
            let what = format!("its {} bytes are more than are read: {MOST_BYTES} of a file", bytes.len());
            return Err(file.error(part, what).remedy("export less detail, or several files"));
        }
        Ok(bytes)
    };
    document.buffers().map(read_one).collect()
}

/// True for a buffer that exists only to be filled by a decompressor.
pub(super) fn is_empty_fallback(buffer: &gltf::Buffer<'_>) -> bool {
    let is_fallback = |name| buffer.extension_value(name).and_then(|e| e.get("fallback")) == Some(&true.into());
    let named = is_fallback("EXT_meshopt_compression") || is_fallback("KHR_meshopt_compression");
    named && matches!(buffer.source(), Source::Bin)
}

/// The bytes that a URI names: base64 data, or a file relative to the glTF file.
pub(super) fn resolve(file: &File<'_>, part: &str, uri: &str) -> Result<Vec<u8>, Error> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, base64) = data.split_once(";base64,").ok_or_else(|| {
            file.error(part, "its data are not in base64").remedy("export it again, with its data in files or base64")
        })?;
        return STANDARD.decode(base64).map_err(|e| file.error(part, format!("its data are not valid base64: {e}")));
    }
    let path = resolve_path(file, uri);
    file.files.read(&path).map_err(|e| file.pass_on(part, &e))
}

/// The file that a relative URI names.
pub(super) fn resolve_path(file: &File<'_>, uri: &str) -> std::path::PathBuf {
    let name = urlencoding::decode(uri).map_or_else(|_| uri.to_owned(), |name| name.into_owned());
    file.path.parent().unwrap_or(std::path::Path::new("")).join(name)
}

/// The bytes of a buffer view, if they lie within its buffer.
pub(super) fn view<'a>(buffers: &'a [Vec<u8>], view: &gltf::buffer::View<'_>) -> Option<&'a [u8]> {
    let end = view.offset().checked_add(view.length())?;
    buffers.get(view.buffer().index())?.get(view.offset()..end)
}
