//! How many functions there are, and how they are numbered.

use std::fmt;

/// The number of bands: order n has the functions of degree 0 to n − 1, n² in all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Order(u8);

/// An order that is not from 1 to 10.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongOrder(pub u32);

impl Order {
    /// The largest: 100 functions.
    pub const MAX: Self = Self(10);

    /// Order `bands`.
    ///
    /// # Errors
    /// A number that is not from 1 to 10.
    pub fn new(bands: u32) -> Result<Self, WrongOrder> {
        match u8::try_from(bands) {
            Ok(n @ 1..=10) => Ok(Self(n)),
            _ => Err(WrongOrder(bands)),
        }
    }

    /// The order of so many functions; `None` where no order has them.
    pub fn of_functions(functions: usize) -> Option<Self> {
        (1..=Self::MAX.0).map(Self).find(|order| order.functions() == functions)
    }

    /// The number of bands, 1 to 10; the largest degree is one less.
    pub fn bands(self) -> usize {
        self.0.into()
    }

    /// The number of functions, n².
    pub fn functions(self) -> usize {
        self.bands() * self.bands()
    }
}

impl Default for Order {
    /// 5, the 25 functions of the text (SIGGRAPH 2004, course 26).
    fn default() -> Self {
        Self(5)
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for WrongOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "spherical harmonics have an order of 1 to 10, not {}", self.0)
    }
}

impl std::error::Error for WrongOrder {}

/// The number of the function of degree `l` and `m` from −l to l: l (l + 1) + m.
pub fn index(l: usize, m: isize) -> usize {
    (l * (l + 1)).saturating_add_signed(m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_from_1_to_10() {
        assert!((1..=10).all(|n| Order::new(n).is_ok_and(|o| o.functions() == (n * n) as usize)));
        for wrong in [0, 11, 257, u32::MAX] {
            let said = Order::new(wrong).unwrap_err().to_string();
            assert!(said.contains("1 to 10") && said.contains(&wrong.to_string()), "{said}");
        }
        assert_eq!(Order::of_functions(25), Order::new(5).ok());
        assert_eq!([0, 24, 121].map(Order::of_functions), [None; 3]);
    }

    #[test]
    fn functions_are_numbered_band_by_band() {
        let pairs = (0..10_usize).flat_map(|l| (-(l as isize)..=l as isize).map(move |m| (l, m)));
        assert!(pairs.map(|(l, m)| index(l, m)).eq(0..100));
        // Flipped, it would be l (l + 1) − m.
        assert_eq!((index(1, -1), index(1, 1), index(2, -2)), (1, 3, 4));
    }
}
