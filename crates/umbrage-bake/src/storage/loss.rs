//! What is lost where vectors are stored in less.

use umbrage_core::transfer::Stored;

/// How far stored vectors are off those that were to be stored. The functions are orthonormal, so
/// that the square of a vector's error is what light of equal coefficients would be off on average.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loss {
    /// Root of the mean square error of all numbers.
    pub rms: f64,
    /// The same over the root mean square of the numbers themselves.
    pub relative: f64,
    /// The largest error of a number.
    pub worst: f64,
}

impl Loss {
    /// Of `stored` against the `vectors` of `len` numbers.
    pub fn of(stored: &Stored, vectors: &[f32], len: usize) -> Self {
        let (mut squares, mut all, mut worst) = (0.0, 0.0, 0.0_f64);
        let mut read = vec![0.0; len];
        for (point, vector) in vectors.chunks_exact(len.max(1)).enumerate() {
            stored.read(point, &mut read);
            for (found, wanted) in read.iter().zip(vector) {
                let off = f64::from(*found) - f64::from(*wanted);
                squares += off * off;
                all += f64::from(*wanted).powi(2);
                worst = worst.max(off.abs());
            }
        }
        let relative = if all > 0.0 { (squares / all).sqrt() } else { 0.0 };
        Self { rms: (squares / (vectors.len() as f64).max(1.0)).sqrt(), relative, worst }
    }
}
