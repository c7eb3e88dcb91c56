//! Coverage of a disc as two tables over three distances.

/// For an edge's line at distance d0 from the disc's centre and its ends at d1 and d2 from the foot
/// of the perpendicular, all in radii: the share of the disc beyond the edge within the angle under
/// which the centre sees it, S − A of [`super`] without its sign. One table for ends on the same
/// side of the foot and one for ends on either side (PX 4.2.2). Ends outside of the disc may be
/// anywhere there; look-ups at 1 are the most exact, since what is between values has a bend at the
/// border. Next to the centre, where an end within a cell of it may be seen under any angle, values
/// may be off by as much as a quarter.
#[derive(Clone, Debug)]
pub struct SphereTable {
    side: usize,
    /// Same side and either side, d0 fastest, d2 slowest.
    values: Vec<[f32; 2]>,
}

impl SphereTable {
    /// `side`: values along each axis, for distances from 0 to 1; PX uses 32. At least 2.
    pub fn new(side: usize) -> Self {
        let side = side.max(2);
        let at = |i: usize| i as f64 / (side - 1) as f64;
        let mut values = Vec::with_capacity(side * side * side);
        for far in 0..side {
            for near in 0..side {
                values.extend((0..side).map(|d0| {
                    let (one, other) = (wedge(at(d0), at(near)), wedge(at(d0), at(far)));
                    [(one - other).abs(), one + other].map(|v| v as f32)
                }));
            }
        }
        Self { side, values }
    }

    /// Values along each axis.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Same side and either side, d0 fastest, d2 slowest.
    pub fn values(&self) -> &[[f32; 2]] {
        &self.values
    }

    /// What a filtering look-up gives. Distances are clamped to 0…1.
    pub fn sample(&self, distances: [f32; 3], same_side: bool) -> f32 {
        let last = self.side - 1;
        let scaled = distances.map(|d| d.clamp(0.0, 1.0) * last as f32);
        let low = scaled.map(|s| (s as usize).min(last - 1));
        let part: [f32; 3] = std::array::from_fn(|i| scaled[i] - low[i] as f32);
        let mut sum = 0.0;
        for corner in 0..8 {
            let up: [usize; 3] = std::array::from_fn(|i| corner >> i & 1);
            let weight: f32 = (0..3).map(|i| if up[i] == 1 { part[i] } else { 1.0 - part[i] }).product();
            let place = (0..3).rev().fold(0, |place, i| place * self.side + low[i] + up[i]);
            sum += weight * self.values[place][usize::from(!same_side)];
        }
        sum
    }
}

/// The share of the disc beyond the edge for an edge from the foot of the perpendicular outwards to
/// `end`.
fn wedge(distance: f64, end: f64) -> f64 {
    let end = end.min((1.0 - distance * distance).max(0.0).sqrt());
    (end.atan2(distance) - distance * end) / std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::super::double::{Chord, chord, term};
    use super::*;
    use crate::coverage::Face;

    /// What shaders make of the table: A − S.
    fn by_table(table: &SphereTable, Chord { from, to, is_left }: Chord) -> f64 {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        let distance = (from[0] * dy - from[1] * dx).abs() / length;
        let [one, other] = [from, to].map(|p| (p[0] * dx + p[1] * dy) / length);
        let border = (1.0 - distance * distance).max(0.0).sqrt();
        let outside = |d: f64| if d.abs() >= border * (1.0 - 1e-6) { 1.0 } else { d.abs() };
        let distances = [distance, outside(one), outside(other)].map(|d| d as f32);
        let value = f64::from(table.sample(distances, one * other > 0.0));
        if is_left { -value } else { value }
    }

    #[test]
    fn a_table_of_32_is_within_six_thousandths() {
        let table = SphereTable::new(32);
        let mut worst: f64 = 0.0;
        for i in 0..20_000 {
            let at = |k: usize| ((i * 7 + k) as f64 * 0.618_033_988_749_895_f64 * (k + 1) as f64).fract() * 3.0 - 1.5;
            let (from, to) = ([at(0), at(1), 1.0], [at(2), at(3), 1.0]);
            if let Some(chord) = chord(Face::Disc, from, to) {
                worst = worst.max((by_table(&table, chord) - term(Face::Disc, from, to)).abs());
            }
        }
        // Next to the disc's border, where the sector ends within a cell of the table.
        assert!(worst < 0.006, "{worst}");
        assert!(worst > 1e-6, "nothing was looked up");
    }
}
