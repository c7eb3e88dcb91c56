//! Windows against ringing.

use super::order::Order;
use std::f64::consts::PI;

/// What high bands are multiplied by, so that a hard light rings less and is blurred more. Of
/// order n and degree l, 0 ≤ l < n.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Window {
    /// 1: coefficients stay.
    #[default]
    None,
    /// (1 + cos(π l / n)) / 2.
    Hanning,
    /// sin(π l / n) / (π l / n).
    Lanczos,
}

impl Window {
    /// The factor of the band of degree `l`; 1 for l = 0, 0 from n.
    pub fn factor(self, order: Order, l: usize) -> f64 {
        let angle = PI * l as f64 / order.bands() as f64;
        match self {
            Self::None => 1.0,
            _ if l >= order.bands() => 0.0,
            Self::Hanning => 0.5 * (1.0 + angle.cos()),
            Self::Lanczos if l == 0 => 1.0,
            Self::Lanczos => angle.sin() / angle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_fall_from_1_to_0() {
        let order = Order::new(6).unwrap();
        for window in [Window::Hanning, Window::Lanczos] {
            let factors: Vec<f64> = (0..=6).map(|l| window.factor(order, l)).collect();
            assert_eq!((factors[0], factors[6]), (1.0, 0.0), "{window:?}");
            assert!(factors.windows(2).all(|pair| pair[0] > pair[1]), "{window:?}: {factors:?}");
        }
        assert!((Window::Hanning.factor(order, 3) - 0.5).abs() < 1e-15);
        assert!((Window::Lanczos.factor(order, 3) - 2.0 / PI).abs() < 1e-15);
        assert_eq!(Window::None.factor(order, 5), 1.0);
    }
}
