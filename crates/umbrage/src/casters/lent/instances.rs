//! Instances in buffers of a host's own.

use super::bounds::check_bounds;
use crate::casters::ids::{MaterialId, MeshId};
use crate::error::Error;
use umbrage_core::Bounds;
use umbrage_core::glam::DAffine3;

/// Copies of one mesh that matrices in a buffer of the host's place, see
/// [`crate::Casters::insert_lent`]: one caster, with as many instances as there are matrices.
#[derive(Clone, Debug)]
pub struct LentInstances {
    /// What is placed: any mesh, whether it is lent or not; joints do nothing to it.
    pub mesh: MeshId,
    /// How all of them look.
    pub material: MaterialId,
    /// Places what the matrices place, in double precision: matrices far away from the world's
    /// origin are coarse.
    pub world_from_group: DAffine3,
    /// From mesh to group space.
    pub matrices: LentMatrices,
    /// A box around all instances, in group space.
    pub bounds: Bounds,
    /// False: they cast no shadow.
    pub casts: bool,
    /// False: maps need not cover where they are.
    pub receives: bool,
}

/// Matrices in a buffer that was made with [`wgpu::BufferUsages::VERTEX`].
#[derive(Clone, Debug, PartialEq)]
pub struct LentMatrices {
    /// The host's, of the same device.
    pub buffer: wgpu::Buffer,
    /// Bytes to the first matrix, a multiple of 4.
    pub offset: u64,
    /// Bytes from one to the next, as in [`crate::LentVertices::stride`].
    pub stride: u64,
    /// How they are stored.
    pub form: MatrixForm,
    /// How many there are.
    pub count: u32,
}

/// How a matrix of 32-bit floats is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MatrixForm {
    /// Four columns of four, the last of each without meaning: `mat4x4f` and `mat4x3f` of WGSL.
    Columns4x4,
    /// Three rows of four.
    Rows3x4,
}

impl MatrixForm {
    /// Bytes.
    pub(in crate::casters) fn size(self) -> u64 {
        match self {
            Self::Columns4x4 => 64,
            Self::Rows3x4 => 48,
        }
    }

    /// Bytes to what the shader takes; of three rows the last number is not read.
    pub(in crate::casters) fn offsets(self) -> [u64; 4] {
        match self {
            Self::Columns4x4 => [0, 16, 32, 48],
            Self::Rows3x4 => [0, 16, 32, 0],
        }
    }
}

/// What the library keeps of instances that are lent.
#[derive(Clone)]
pub(crate) struct Many {
    pub matrices: LentMatrices,
    /// In group space.
    pub bounds: Bounds,
    /// How many matrices there is room for.
    room: u32,
}

impl Many {
    pub fn of(new: &LentInstances) -> Self {
        Self { matrices: new.matrices.clone(), bounds: new.bounds, room: new.matrices.count }
    }

    /// After the host has written others.
    ///
    /// # Errors
    /// [`Error::Lent`] for more than there is room for.
    pub fn touched(&self, count: u32, bounds: Bounds) -> Result<Self, Error> {
        let room = self.room;
        if count > room {
            return Err(Error::Lent(format!("{count} instances where {room} were lent; insert them anew")));
        }
        if count > 0 {
            check_bounds(&bounds)?;
        }
        Ok(Self { matrices: LentMatrices { count, ..self.matrices.clone() }, bounds, ..*self })
    }
}
