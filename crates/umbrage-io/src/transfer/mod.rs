//! Baked transfer in files that other software reads: `.npz` for NumPy, in every way it can be
//! stored, and `.glb` with attributes of vertices. `docs/transfer-files.md` says what is in them.

mod glb;
mod glb_read;
mod npz;

use crate::error::{self, Error};
use crate::gltf_file;
use crate::pictures::save_bytes;
use std::path::Path;
use umbrage_core::transfer::{Kind, Transfer};
use umbrage_core::{Scene, harmonics::Order};

/// Writes a transfer to a file whose name ends in `.npz` or `.glb`. `scene` is the scene that was
/// baked, and says where meshes stand.
///
/// # Errors
/// Another ending; in `.glb`, points that are no vertices; a file that can't be written.
pub fn save_transfer(path: &Path, transfer: &Transfer, scene: &Scene) -> Result<(), Error> {
    let bytes = match ending(path)? {
        Ending::Npz => npz::bytes(transfer).map_err(|e| Error::new(path, format!("cannot be written: {e}")))?,
        Ending::Glb => glb::bytes(transfer, scene).map_err(|what| Error::new(path, what).remedy("write a .npz"))?,
    };
    save_bytes(path, &bytes)
}

/// Makes sure that [`save_transfer`] knows the ending of a name, before long work starts.
///
/// # Errors
/// An ending other than `.npz` and `.glb`.
pub fn check_transfer_name(path: &Path) -> Result<(), Error> {
    ending(path).map(|_| ())
}

/// Reads a transfer that [`save_transfer`] wrote. That of a `.glb` is stored in full, and its
/// instances are numbered as they are written.
///
/// # Errors
/// A file that can't be read, is damaged, or holds no transfer.
pub fn open_transfer(path: &Path) -> Result<Transfer, Error> {
    let transfer = match ending(path)? {
        Ending::Npz => npz::read(path)?,
        Ending::Glb => {
            let (document, blob) = gltf_file::document(path, error::read(path)?)?;
            glb_read::read(&document, &blob.unwrap_or_default()).map_err(|what| Error::new(path, what))?
        }
    };
    if transfer.is_whole() {
        Ok(transfer)
    } else {
        Err(Error::new(path, "has arrays whose lengths do not fit each other"))
    }
}

enum Ending {
    Npz,
    Glb,
}

fn ending(path: &Path) -> Result<Ending, Error> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("npz") => Ok(Ending::Npz),
        Some("glb") => Ok(Ending::Glb),
        _ => {
            Err(Error::new(path, "has an ending that no transfer has").remedy("write a name that ends in .npz or .glb"))
        }
    }
}

/// 0 unshadowed, 1 shadowed, 2 interreflected; and bounces.
fn numbers_of(kind: Kind) -> [u32; 2] {
    match kind {
        Kind::Unshadowed => [0, 0],
        Kind::Shadowed => [1, 0],
        Kind::Interreflected { bounces } => [2, bounces],
    }
}

fn kind_of([number, bounces]: [u32; 2]) -> Option<Kind> {
    match number {
        0 => Some(Kind::Unshadowed),
        1 => Some(Kind::Shadowed),
        2 => Some(Kind::Interreflected { bounces }),
        _ => None,
    }
}

fn order_of(number: u32) -> Result<Order, String> {
    Order::new(number).map_err(|e| format!("has an order that is none: {e}"))
}
