//! How the vectors of points are kept: SIGGRAPH 2004, course 26, "Reducing Storage Cost".

/// The vectors of all points of a mesh, front first. Each has the same length, `channels` · n².
#[derive(Clone, Debug, PartialEq)]
pub enum Stored {
    /// One number after the other, point by point.
    Full(Vec<f32>),
    /// A byte for each number, with a scale and a bias for each place of the vectors: value = bias
    /// + scale · byte.
    Bytes {
        /// For each place of a vector.
        bias: Vec<f32>,
        /// For each place of a vector.
        scale: Vec<f32>,
        /// Point by point.
        bytes: Vec<u8>,
    },
    /// Vectors from a list and weights for them: principal components of all points, one cluster;
    /// vector quantisation, many clusters without weights; or clustered principal components.
    Clustered {
        /// The lists.
        clusters: Vec<Cluster>,
        /// What each point takes of them.
        codes: Codes,
    },
}

/// What the points of a cluster have in common.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cluster {
    /// Their mean; the whole answer where there are no vectors.
    pub mean: Vec<f32>,
    /// What weights multiply, one vector after the other; the mean is not among them.
    pub vectors: Vec<f32>,
}

/// For each point, a cluster and a weight for each of its vectors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Codes {
    /// Index into the clusters, one for each point.
    pub cluster: Vec<u16>,
    /// Vectors of each cluster, the mean not counted.
    pub vectors: usize,
    /// `vectors` for each point.
    pub weights: Vec<f32>,
}

impl Stored {
    /// The vector of a point, into all of `into`, whose length is that of the vectors; zeros for a
    /// point that is not there.
    pub fn read(&self, point: usize, into: &mut [f32]) {
        let n = into.len();
        into.fill(0.0);
        match self {
            Self::Full(values) => {
                let values = values.get(point * n..(point + 1) * n).unwrap_or_default();
                into.iter_mut().zip(values).for_each(|(into, value)| *into = *value);
            }
            Self::Bytes { bias, scale, bytes } => {
                let bytes = bytes.get(point * n..(point + 1) * n).unwrap_or_default();
                let scaled = bias.iter().zip(scale).zip(bytes).map(|((bias, scale), b)| bias + scale * f32::from(*b));
                into.iter_mut().zip(scaled).for_each(|(into, value)| *into = value);
            }
            Self::Clustered { clusters, codes } => {
                let Some(cluster) = codes.cluster.get(point).and_then(|&k| clusters.get(usize::from(k))) else {
                    return;
                };
                into.iter_mut().zip(&cluster.mean).for_each(|(into, mean)| *into = *mean);
                let k = codes.vectors;
                let weights = codes.weights.get(point * k..(point + 1) * k).unwrap_or_default();
                for (weight, vector) in weights.iter().zip(cluster.vectors.chunks_exact(n.max(1))) {
                    into.iter_mut().zip(vector).for_each(|(into, value)| *into += weight * value);
                }
            }
        }
    }

    /// Bytes in memory: four a number, one a byte, and one for a cluster's number where there are
    /// at most 256, else two.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Full(values) => 4 * values.len(),
            Self::Bytes { bias, scale, bytes } => 4 * (bias.len() + scale.len()) + bytes.len(),
            Self::Clustered { clusters, codes } => {
                let lists: usize = clusters.iter().map(|c| 4 * (c.mean.len() + c.vectors.len())).sum();
                let number = match clusters.len() {
                    0 | 1 => 0,
                    2..=256 => 1,
                    _ => 2,
                };
                lists + number * codes.cluster.len() + 4 * codes.weights.len()
            }
        }
    }

    /// True where there are `points` vectors of `len` numbers.
    pub fn is_whole(&self, points: usize, len: usize) -> bool {
        match self {
            Self::Full(values) => values.len() == points * len,
            Self::Bytes { bias, scale, bytes } => {
                bytes.len() == points * len && bias.len() == len && scale.len() == len
            }
            Self::Clustered { clusters, codes } => {
                let whole = |c: &Cluster| c.mean.len() == len && c.vectors.len() == codes.vectors * len;
                codes.cluster.len() == points
                    && codes.weights.len() == points * codes.vectors
                    && codes.cluster.iter().all(|&k| usize::from(k) < clusters.len())
                    && clusters.iter().all(whole)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(stored: &Stored, point: usize) -> [f32; 2] {
        let mut vector = [7.0; 2];
        stored.read(point, &mut vector);
        vector
    }

    #[test]
    fn every_way_to_store_gives_vectors() {
        let full = Stored::Full(vec![1.0, 2.0, 3.0, 4.0]);
        let bytes = Stored::Bytes { bias: vec![1.0, -1.0], scale: vec![0.5, 0.25], bytes: vec![0, 4, 2, 255] };
        let clusters = vec![
            Cluster { mean: vec![1.0, 1.0], vectors: vec![1.0, 0.0] },
            Cluster { mean: vec![5.0, 6.0], vectors: vec![0.5, 2.0] },
        ];
        let codes = Codes { cluster: vec![1, 0], vectors: 1, weights: vec![2.0, -1.0] };
        let clustered = Stored::Clustered { clusters, codes };
        for (stored, first, second, size) in [
            (&full, [1.0, 2.0], [3.0, 4.0], 16),
            (&bytes, [1.0, 0.0], [2.0, 62.75], 20),
            (&clustered, [6.0, 10.0], [0.0, 1.0], 42),
        ] {
            assert_eq!((read(stored, 0), read(stored, 1), read(stored, 2)), (first, second, [0.0; 2]));
            assert!(stored.is_whole(2, 2) && !stored.is_whole(1, 2) && !stored.is_whole(2, 1));
            assert_eq!(stored.bytes(), size);
        }
    }
}
