//! Which sizes a budget allows.

/// What is to be divided for one light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Share {
    /// Texels across that the screen has use for, a power of two or the most that settings allow; 0
    /// where maps are of no use.
    pub wanted: u32,
    /// What maps of each size take.
    pub price: Price,
    /// What this light takes beyond that, whatever the size.
    pub extra: u64,
    /// What it took beyond that when it was last seen, with maps of the size `at`: such as a store
    /// for what moves.
    pub more: u64,
    pub at: u32,
    /// What it takes without maps.
    pub idle: u64,
}

/// Sizes whose bytes are measured.
pub(super) const TRIED: [u32; 4] = [32, 64, 128, 256];

/// No map is smaller, but where settings say so.
const LEAST: u32 = TRIED[0];

/// How much farther than to the next power of two a need has to go to count.
const SLACK: f64 = 1.25;

/// Coarser levels of larger maps take a little more than those of the sizes that are tried.
const TO_SPARE: f64 = 1.01;

/// Bytes of all maps of a light by their size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Price {
    tried: [u64; TRIED.len()],
}

impl Price {
    /// From the bytes of maps of the sizes that are tried.
    pub fn new(tried: [u64; TRIED.len()]) -> Self {
        Self { tried }
    }

    /// Bytes of maps of this size, or a little more.
    pub fn of(&self, size: u32) -> u64 {
        let [.., half, most] = self.tried;
        let known = TRIED.iter().zip(self.tried).find(|(tried, _)| **tried >= size);
        known.map_or_else(
            || {
                let squares = [TRIED[2], TRIED[3], size].map(|size| f64::from(size).powi(2));
                let per_texel = TO_SPARE * most.saturating_sub(half) as f64 / (squares[1] - squares[0]);
                most + (per_texel * (squares[2] - squares[1])).ceil() as u64
            },
            |(_, bytes)| bytes,
        )
    }
}

impl Share {
    /// Bytes with maps of this size.
    pub fn bytes(&self, size: u32) -> u64 {
        // Of what was seen besides, smaller maps take less; larger ones count in the next frame.
        let part = (f64::from(size) / f64::from(self.at.max(1))).min(1.0).powi(2);
        let more = (self.more as f64 * part).ceil() as u64;
        if size == 0 { self.idle } else { self.price.of(size) + self.extra + more }
    }
}

/// The size for a need in texels, which stays `before` for as long as the need is near that.
pub(super) fn wanted(need: f64, before: u32, most: u32) -> u32 {
    let most_texels = f64::from(most);
    let size = |need: f64| (need.clamp(1.0, most_texels).ceil() as u32).next_power_of_two().max(LEAST).min(most);
    let (low, high) = (size(need / SLACK), size(need * SLACK));
    if (low..=high).contains(&before) { before } else { size(need) }
}

/// Fills `sizes` so that all together take `bytes` at most: what is wanted, halved again and again
/// where there is most left of it. False where the smallest maps are too much.
pub(super) fn divide(shares: &[Share], bytes: u64, sizes: &mut Vec<u32>) -> bool {
    sizes.clear();
    sizes.extend(shares.iter().map(|share| share.wanted));
    let mut total: u64 = shares.iter().zip(&*sizes).map(|(share, size)| share.bytes(*size)).sum();
    while total > bytes {
        let can_shrink = |i: &usize| sizes[*i] > LEAST;
        // How much of it is left, as a fraction; among equals the largest, the last first.
        let left = |i: &usize| f64::from(sizes[*i]) / f64::from(shares[*i].wanted);
        let order = |a: &usize, b: &usize| left(a).total_cmp(&left(b)).then(sizes[*a].cmp(&sizes[*b])).then(a.cmp(b));
        let Some(i) = (0..shares.len()).filter(can_shrink).max_by(order) else { return false };
        // Settings may ask for what is no power of two: the next one below then.
        let smaller = (sizes[i].next_power_of_two() / 2).max(LEAST);
        total = total - shares[i].bytes(sizes[i]) + shares[i].bytes(smaller);
        sizes[i] = smaller;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(wanted: u32) -> Share {
        let price = Price::new(TRIED.map(|size| 1000 + 24 * u64::from(size).pow(2)));
        Share { wanted, price, idle: 10, ..Share::default() }
    }

    fn divided(shares: &[Share], bytes: u64) -> Option<Vec<u32>> {
        let mut sizes = Vec::new();
        let fits = divide(shares, bytes, &mut sizes);
        let total: u64 = shares.iter().zip(&sizes).map(|(share, size)| share.bytes(*size)).sum();
        assert!(!fits || total <= bytes, "{total} of {bytes}");
        fits.then_some(sizes)
    }

    #[test]
    fn what_fits_is_given() {
        assert_eq!(divided(&[cube(512), cube(128), cube(0)], 1 << 30), Some(vec![512, 128, 0]));
    }

    #[test]
    fn a_small_budget_is_kept_and_divided_by_importance() {
        let sizes = divided(&[cube(1024), cube(256), cube(64), cube(0)], 2 << 20).unwrap();
        assert!(sizes[0] > sizes[1] && sizes[1] >= sizes[2] && sizes[2] >= LEAST && sizes[3] == 0, "{sizes:?}");
        assert_eq!(divided(&[cube(1024); 64], 64 * 26_000), Some(vec![LEAST; 64]));
        assert_eq!(divided(&[cube(1024); 64], 64 * 20_000), None);
    }

    #[test]
    fn sizes_that_are_no_powers_of_two_shrink_to_such() {
        let sizes = divided(&[cube(1000)], 24 * 900 * 900).unwrap();
        assert_eq!(sizes, [512]);
    }

    #[test]
    fn a_need_that_wavers_changes_nothing() {
        assert_eq!(wanted(500.0, 0, 2048), 512);
        for need in [412.0, 500.0, 600.0, 639.0, 300.0] {
            assert_eq!(wanted(need, 512, 2048), 512, "{need}");
        }
        assert_eq!(wanted(700.0, 512, 2048), 1024);
        assert_eq!(wanted(200.0, 512, 2048), 256);
        assert_eq!(wanted(f64::INFINITY, 0, 1000), 1000);
        assert_eq!(wanted(0.0, 0, 1000), LEAST);
        assert_eq!(wanted(f64::NAN, 0, 1000), LEAST);
        assert_eq!(wanted(9.0, 0, 16), 16);
    }
}
