//! Principal components.

/// Steps of the iteration at most; fewer where nothing is gained any more.
const MOST_STEPS: usize = 60;

/// What counts as nothing, of all that is gained.
const NO_GAIN: f64 = 1e-6;

/// Mean and principal components of vectors.
#[derive(Clone, Debug, Default)]
pub(super) struct Components {
    pub mean: Vec<f64>,
    /// Orthonormal, those with most variance first.
    pub vectors: Vec<Vec<f64>>,
}

impl Components {
    /// Of vectors with `len` numbers: their mean and `count` components. Those of an earlier fit
    /// are where the search begins.
    ///
    /// Orthogonal iteration (Golub and Van Loan, "Matrix Computations", section 8.2.4): a basis is
    /// multiplied with the covariance and made orthonormal again. Components of about the same
    /// variance are told apart slowly, and then it does not matter which is taken.
    pub fn fit<'a>(vectors: impl Iterator<Item = &'a [f32]> + Clone, len: usize, count: usize, before: &Self) -> Self {
        let mean = mean(vectors.clone(), len);
        let count = count.min(len);
        if count == 0 {
            return Self { mean, vectors: Vec::new() };
        }
        let covariance = covariance(vectors, &mean);
        let mut basis = before.vectors.clone();
        basis.resize(count, Vec::new());
        // Where nothing is known: the columns with the largest variance.
        let mut places: Vec<usize> = (0..len).collect();
        places.sort_by(|a, b| covariance[b * len + b].total_cmp(&covariance[a * len + a]));
        for (vector, place) in basis.iter_mut().zip(&places).filter(|(vector, _)| vector.len() != len) {
            *vector = covariance[place * len..(place + 1) * len].to_vec();
        }
        make_orthonormal(&mut basis);
        let mut gained = 0.0;
        // A whole basis spans all that there is.
        for _ in 0..if count < len { MOST_STEPS } else { 0 } {
            let next: Vec<Vec<f64>> = basis.iter().map(|vector| multiplied(&covariance, vector)).collect();
            let gain: f64 = next.iter().zip(&basis).map(|(a, b)| dot(a, b)).sum();
            basis = next;
            make_orthonormal(&mut basis);
            if gain - gained <= NO_GAIN * gain {
                break;
            }
            gained = gain;
        }
        Self { mean, vectors: basis }
    }
}

fn mean<'a>(vectors: impl Iterator<Item = &'a [f32]>, len: usize) -> Vec<f64> {
    let (mut mean, mut count) = (vec![0.0; len], 0.0_f64);
    for vector in vectors {
        mean.iter_mut().zip(vector).for_each(|(sum, value)| *sum += f64::from(*value));
        count += 1.0;
    }
    mean.iter_mut().for_each(|sum| *sum /= count.max(1.0));
    mean
}

/// Not divided by the number of vectors, which changes no component.
fn covariance<'a>(vectors: impl Iterator<Item = &'a [f32]>, mean: &[f64]) -> Vec<f64> {
    let len = mean.len();
    let (mut sums, mut off) = (vec![0.0; len * len], vec![0.0; len]);
    for vector in vectors {
        off.iter_mut().zip(vector.iter().zip(mean)).for_each(|(off, (x, m))| *off = f64::from(*x) - m);
        for (i, row) in sums.chunks_exact_mut(len).enumerate() {
            let factor = off[i];
            row[i..].iter_mut().zip(&off[i..]).for_each(|(sum, other)| *sum += factor * other);
        }
    }
    for i in 0..len {
        for j in 0..i {
            sums[i * len + j] = sums[j * len + i];
        }
    }
    sums
}

fn multiplied(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(vector.len()).map(|row| dot(row, vector)).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Gram and Schmidt, each twice for the last digits. What depends on those before becomes an axis
/// that does not.
fn make_orthonormal(basis: &mut [Vec<f64>]) {
    for i in 0..basis.len() {
        let (done, rest) = basis.split_at_mut(i);
        let vector = &mut rest[0];
        let size = dot(vector, vector).sqrt();
        if is_independent(vector, done, size) {
            continue;
        }
        let len = vector.len();
        let axes = (0..len).map(|axis| (0..len).map(|k| f64::from(u8::from(k == axis))).collect::<Vec<_>>());
        for mut axis in axes {
            if is_independent(&mut axis, done, 1.0) {
                *vector = axis;
                break;
            }
        }
    }
}

/// Makes `vector`, of length `size`, a unit vector perpendicular to those of `done`; false where
/// hardly anything of it is.
fn is_independent(vector: &mut [f64], done: &[Vec<f64>], size: f64) -> bool {
    for other in done.iter().chain(done) {
        let along = dot(vector, other);
        vector.iter_mut().zip(other).for_each(|(value, other)| *value -= along * other);
    }
    let left = dot(vector, vector).sqrt();
    let is_there = left > 1e-9 * size && left > f64::MIN_POSITIVE;
    if is_there {
        vector.iter_mut().for_each(|value| *value /= left);
    }
    is_there
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::sampling::shift;

    #[test]
    fn the_axes_of_an_ellipsoid_are_found() {
        // Points in a box of 8 × 3 × 1, turned by 3-4-5 triangles, far from the origin.
        let axes = [[0.6, 0.64, 0.48], [-0.8, 0.48, 0.36], [0.0, -0.6, 0.8]];
        let point = |i: u32| {
            let (a, b) = (shift(2 * i) - 0.5, shift(2 * i + 1) - 0.5);
            let size = [8.0 * a.x, 3.0 * a.y, b.x];
            [0, 1, 2].map(|k| (10.0 + (0..3).map(|axis| size[axis] * axes[axis][k]).sum::<f64>()) as f32)
        };
        let points: Vec<[f32; 3]> = (0..4000).map(point).collect();
        let found = Components::fit(points.iter().map(|p| &p[..]), 3, 2, &Components::default());
        assert!(found.mean.iter().all(|m| (m - 10.0).abs() < 0.15), "{:?}", found.mean);
        for (vector, axis) in found.vectors.iter().zip(axes) {
            assert!(dot(vector, &axis).abs() > 0.999, "{vector:?} is not along {axis:?}");
        }
        assert!(dot(&found.vectors[0], &found.vectors[1]).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_variance_has_components_all_the_same() {
        let same = [[1.0_f32, 2.0, 3.0]; 5];
        let found = Components::fit(same.iter().map(|p| &p[..]), 3, 3, &Components::default());
        assert_eq!(found.mean, [1.0, 2.0, 3.0]);
        let unit = |v: &Vec<f64>| (dot(v, v) - 1.0).abs() < 1e-12;
        assert!(found.vectors.len() == 3 && found.vectors.iter().all(unit), "{:?}", found.vectors);
    }
}
