//! An order in which things that are close to each other in space mostly stay so in a list (Morton
//! 1966).

use crate::bounds::Bounds;
use glam::DVec3;

/// Steps along each axis of the box around everything, in bits.
const BITS: u32 = 21;

/// Sorts by where things are in the box; what is at one place stays in order.
pub(super) fn sort_by_place<T>(things: &mut [T], place: impl Fn(&T) -> DVec3) {
    let bounds = Bounds::of(things.iter().map(&place));
    let per_metre = f64::from((1_u32 << BITS) - 1) / bounds.size().max_element().max(f64::MIN_POSITIVE);
    things.sort_by_cached_key(|thing| code((place(thing) - bounds.min) * per_metre));
}

/// The bits of all three coordinates in turn, the highest first.
fn code(at: DVec3) -> u64 {
    let [x, y, z] = at.to_array().map(|c| c as u64);
    (0..BITS).rev().flat_map(|bit| [x, y, z].map(|c| c >> bit & 1)).fold(0, |code, bit| code << 1 | bit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_interleave_the_bits_of_coordinates() {
        assert_eq!(code(DVec3::new(0.0, 0.0, 1.0)), 0b001);
        assert_eq!(code(DVec3::new(1.0, 0.0, 0.0)), 0b100);
        assert_eq!(code(DVec3::new(2.0, 3.0, 1.9)), 0b110_011);
        assert_eq!(code(DVec3::splat(f64::from((1_u32 << BITS) - 1))), (1 << (3 * BITS)) - 1);
    }

    #[test]
    fn every_part_of_the_list_is_a_part_of_space() {
        let mut cells: Vec<DVec3> =
            (0..16).flat_map(|x| (0..16).map(move |y| DVec3::new(f64::from(x), f64::from(y), 0.0))).collect();
        sort_by_place(&mut cells, |cell| *cell);
        for (side, number) in [(1.0, 4), (3.0, 16), (7.0, 64)] {
            let parts: Vec<_> = cells.chunks(number).map(|part| Bounds::of(part.iter().copied()).size()).collect();
            assert!(parts.iter().all(|size| *size == DVec3::new(side, side, 0.0)), "squares of {number}: {parts:?}");
        }
    }

    #[test]
    fn one_place_keeps_the_order() {
        let mut things = [(1, DVec3::ONE), (2, DVec3::ONE), (0, DVec3::ZERO), (3, DVec3::ONE)];
        sort_by_place(&mut things, |(_, place)| *place);
        assert_eq!(things.map(|(number, _)| number), [0, 1, 2, 3]);
        sort_by_place(&mut [] as &mut [DVec3], |place| *place);
    }
}
