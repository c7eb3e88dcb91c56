//! Errors of finished pictures.

use crate::error::{Error, same_size};
#[cfg(feature = "flip")]
use crate::flip;
use umbrage_core::Image;

/// Errors of an 8-bit sRGB picture over all channels of all pixels, as shares of white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorScores {
    /// Mean absolute error, 0…1.
    pub mae: f64,
    /// Root of the mean square error, 0…1.
    pub rmse: f64,
    /// Peak signal-to-noise ratio in decibels; `None` for equal pictures, which have no noise.
    pub psnr_db: Option<f64>,
    /// Mean ꟻLIP, see [`crate::Scores::flip`].
    #[cfg(feature = "flip")]
    pub flip: f64,
}

/// Compares two finished pictures.
///
/// # Errors
/// Pictures of different sizes or without pixels.
pub fn color_scores(produced: &Image<[u8; 3]>, reference: &Image<[u8; 3]>) -> Result<ColorScores, Error> {
    same_size("produced", produced, reference)?;
    if reference.data.is_empty() {
        return Err(Error::NothingScored);
    }
    let (mut absolute, mut square) = (0.0, 0.0);
    for (p, r) in produced.data.as_flattened().iter().zip(reference.data.as_flattened()) {
        let d = (f64::from(*p) - f64::from(*r)) / 255.0;
        absolute += d.abs();
        square += d * d;
    }
    let count = 3.0 * reference.data.len() as f64;
    let mean_square = square / count;
    Ok(ColorScores {
        mae: absolute / count,
        rmse: mean_square.sqrt(),
        psnr_db: (mean_square > 0.0).then(|| -10.0 * mean_square.log10()),
        #[cfg(feature = "flip")]
        flip: flip::of_colors(produced, reference),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_error_is_its_own_mean_and_root_mean_square() {
        let (a, b) = (Image::filled(16, 8, [100_u8; 3]), Image::filled(16, 8, [151_u8; 3]));
        let scores = color_scores(&b, &a).expect("equal sizes");
        assert!((scores.mae - 0.2).abs() < 1e-12 && (scores.rmse - 0.2).abs() < 1e-12, "{scores:?}");
        assert!(scores.psnr_db.is_some_and(|p| (p - 13.979_400).abs() < 1e-5) && scores.flip > 0.05, "{scores:?}");
        let same = color_scores(&a, &a).expect("equal sizes");
        assert_eq!(same, ColorScores { mae: 0.0, rmse: 0.0, psnr_db: None, flip: 0.0 });
    }

    #[test]
    fn different_sizes_and_empty_pictures_are_errors() {
        let (a, b) = (Image::filled(2, 2, [0; 3]), Image::filled(2, 3, [0; 3]));
        assert!(matches!(color_scores(&b, &a), Err(Error::Size { .. })));
        let none = Image::filled(0, 0, [0; 3]);
        assert_eq!(color_scores(&none, &none), Err(Error::NothingScored));
    }
}
