//! Ways to store vectors: SIGGRAPH 2004, course 26, "Reducing Storage Cost"; clustered principal
//! components are those of Sloan, Hall, Hart and Snyder, "Clustered Principal Components for
//! Precomputed Radiance Transfer", 2003.

mod clusters;
mod components;
mod loss;
mod words;

use clusters::clustered;
pub use loss::Loss;
use rayon::prelude::*;
use umbrage_core::harmonics::Order;
use umbrage_core::transfer::{BakedMesh, Stored, Transfer};

/// A way to store the vectors of points. As text, and in [`std::str::FromStr`]: `full`, `bytes`,
/// `pca:K`, `vq:N` and `cpca:N:K`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Storage {
    /// Four bytes a number.
    #[default]
    Full,
    /// A byte a number, with scale and bias for each place of the vectors.
    Bytes,
    /// The mean of all vectors and their first principal components, the mean not counted.
    Components {
        /// Components, 1 to 300.
        vectors: usize,
    },
    /// Vector quantisation: each point has one vector of a list.
    Quantised {
        /// Vectors of the list, 1 to 4096.
        clusters: usize,
    },
    /// Principal components in each of many clusters; which cluster a point is in and what the
    /// components are is improved in turn, so that least is lost. Each cluster has its mean
    /// besides, which is **not counted**: the figures of the text count it.
    Clustered {
        /// Clusters, 1 to 4096.
        clusters: usize,
        /// Components in each, 1 to 300.
        vectors: usize,
    },
}

impl Storage {
    /// Stores `vectors`, one after the other, each of `len` numbers. Fewer vectors than clusters,
    /// or numbers than components, make fewer.
    pub fn encode(self, vectors: &[f32], len: usize) -> Stored {
        if len == 0 || vectors.len() < len {
            return Stored::Full(vectors.to_vec());
        }
        match self {
            Self::Full => Stored::Full(vectors.to_vec()),
            Self::Bytes => bytes(vectors, len),
            Self::Components { vectors: k } => clustered(vectors, len, 1, k),
            Self::Quantised { clusters } => clustered(vectors, len, clusters, 0),
            Self::Clustered { clusters, vectors: k } => clustered(vectors, len, clusters, k),
        }
    }

    /// Stores every mesh of a transfer in this way, with clusters of its own; a mesh that would not
    /// become smaller stays as it is.
    #[must_use]
    pub fn apply(self, transfer: &Transfer) -> Transfer {
        let mut stored = transfer.clone();
        for mesh in &mut stored.meshes {
            let smaller = self.encode(&vectors(mesh, transfer.order), mesh.vector_len(transfer.order));
            if smaller.bytes() < mesh.stored.bytes() {
                mesh.stored = smaller;
            }
        }
        stored
    }
}

/// The vectors of all points of a mesh, one after the other: what was stored, decoded.
pub fn vectors(mesh: &BakedMesh, order: Order) -> Vec<f32> {
    let len = mesh.vector_len(order);
    let mut vectors = vec![0.0; mesh.point_count() * len];
    vectors.par_chunks_mut(len).enumerate().for_each(|(point, vector)| mesh.stored.read(point, vector));
    vectors
}

fn bytes(vectors: &[f32], len: usize) -> Stored {
    let (mut least, mut most) = (vec![f32::INFINITY; len], vec![f32::NEG_INFINITY; len]);
    for vector in vectors.chunks_exact(len) {
        least.iter_mut().zip(vector).for_each(|(least, value)| *least = least.min(*value));
        most.iter_mut().zip(vector).for_each(|(most, value)| *most = most.max(*value));
    }
    let scale: Vec<f32> = least.iter().zip(&most).map(|(least, most)| (most - least) / 255.0).collect();
    let byte = |(value, (bias, scale)): (&f32, (&f32, &f32))| {
        // Where all are the same, any byte is right.
        if *scale > 0.0 { ((value - bias) / scale).round() as u8 } else { 0 }
    };
    let places = || least.iter().zip(&scale);
    let bytes = vectors.chunks_exact(len).flat_map(|vector| vector.iter().zip(places()).map(byte)).collect();
    Stored::Bytes { bias: least, scale, bytes }
}
