//! Coverage of a square whose points differ in weight.

use super::double::{Chord, around_square};

/// The share A of a weighted square, see [`super`], as a table over both ends of the chord (SG
/// "Precomputed 4D textures"), and the share S as one over the way around the square.
#[derive(Clone, Debug)]
pub struct TexturedTable {
    side: usize,
    triangles: Vec<f32>,
    sectors: Vec<f32>,
}

/// Points at which weights are integrated, along each axis.
const FINE: usize = 128;

/// Points of a chord at which that is done.
const ALONG: usize = 48;

/// Steps around the square.
const AROUND: usize = 512;

impl TexturedTable {
    /// `share`: of all light, of any scale, that comes from the rectangle between two corners of
    /// the square, coordinates −1…1; not negative. `side`: values along each of four axes, at least
    /// 2; 16 make 64 Ki values, 32 make 1 Mi. `None` where nothing gives light.
    pub fn new(share: impl Fn([f64; 2], [f64; 2]) -> f64, side: usize) -> Option<Self> {
        let side = side.max(2);
        let rows = Rows::new(share)?;
        let at = |i: usize| 2.0 * i as f64 / (side - 1) as f64 - 1.0;
        let point = |i: usize| [at(i % side), at(i / side)];
        let spokes: Vec<f64> = (0..side * side).map(|i| rows.along([0.0; 2], point(i))).collect();
        let count = spokes.len();
        let mut triangles = vec![0.0; count * count];
        for (to, of_to) in spokes.iter().enumerate() {
            for (from, of_from) in spokes[..to].iter().enumerate() {
                let value = (of_from + rows.along(point(from), point(to)) - of_to) as f32;
                triangles[to * count + from] = value;
                triangles[from * count + to] = -value;
            }
        }
        let border: Vec<[f64; 2]> = (0..=AROUND).map(|i| on_border(i as f64 / AROUND as f64)).collect();
        let spoke = |p: [f64; 2]| rows.along([0.0; 2], p);
        let mut sum = 0.0;
        let mut sectors = vec![0.0];
        for ends in border.windows(2) {
            sum += spoke(ends[0]) + rows.along(ends[0], ends[1]) - spoke(ends[1]);
            sectors.push(sum as f32);
        }
        // All of it is 1, whatever was rounded.
        let all = sum as f32;
        sectors.iter_mut().for_each(|s| *s /= all);
        Some(Self { side, triangles, sectors })
    }

    /// Values along each axis.
    pub fn side(&self) -> usize {
        self.side
    }

    /// A over the ends of a chord: `from`'s x fastest, then its y, then `to`'s x and y.
    pub fn triangles(&self) -> &[f32] {
        &self.triangles
    }

    /// The share within the angle that starts at the corner (1, −1), counter-clockwise, see
    /// [`around_square`]; evenly spaced from 0 to 1, both included.
    pub fn sectors(&self) -> &[f32] {
        &self.sectors
    }

    /// A − S of a chord.
    pub fn term(&self, chord: &Chord) -> f64 {
        self.triangle(chord) - self.sector(chord)
    }

    fn triangle(&self, chord: &Chord) -> f64 {
        let last = (self.side - 1) as f64;
        let ends = [chord.from[0], chord.from[1], chord.to[0], chord.to[1]];
        let scaled = ends.map(|c| (c.clamp(-1.0, 1.0) + 1.0) * 0.5 * last);
        let low = scaled.map(|s| (s as usize).min(self.side - 2));
        let mut sum = 0.0;
        for corner in 0..16 {
            let up: [usize; 4] = std::array::from_fn(|i| corner >> i & 1);
            let part = |i: usize| scaled[i] - low[i] as f64;
            let weight: f64 = (0..4).map(|i| if up[i] == 1 { part(i) } else { 1.0 - part(i) }).product();
            let place = (0..4).rev().fold(0, |place, i| place * self.side + low[i] + up[i]);
            sum += weight * f64::from(self.triangles[place]);
        }
        sum
    }

    fn sector(&self, chord: &Chord) -> f64 {
        let [from, to] = [chord.from, chord.to].map(around_square);
        // The way there may lead over the corner where counting starts, once.
        let rounds = (chord.turn() - (to - from)).round();
        self.up_to(to) - self.up_to(from) + rounds
    }

    fn up_to(&self, around: f64) -> f64 {
        let scaled = around * (self.sectors.len() - 1) as f64;
        let low = (scaled as usize).min(self.sectors.len() - 2);
        let [a, b] = [low, low + 1].map(|i| f64::from(self.sectors[i]));
        a + (b - a) * (scaled - low as f64)
    }
}

/// The inverse of [`around_square`].
fn on_border(around: f64) -> [f64; 2] {
    let way = around * 8.0;
    match way {
        w if w <= 2.0 => [1.0, w - 1.0],
        w if w <= 4.0 => [3.0 - w, 1.0],
        w if w <= 6.0 => [-1.0, 5.0 - w],
        w => [w - 7.0, -1.0],
    }
}

/// For each row of the square the share of the whole that lies left of a place: what turns the area
/// of a region into an integral along its border.
struct Rows {
    left: Vec<f64>,
}

impl Rows {
    fn new(share: impl Fn([f64; 2], [f64; 2]) -> f64) -> Option<Self> {
        let border = |i: usize| 2.0 * i as f64 / FINE as f64 - 1.0;
        let mut left = Vec::with_capacity(FINE * (FINE + 1));
        let mut all = 0.0;
        for row in 0..FINE {
            let mut sum = 0.0;
            left.push(0.0);
            for column in 0..FINE {
                let (low, high) = ([border(column), border(row)], [border(column + 1), border(row + 1)]);
                sum += share(low, high).max(0.0);
                left.push(sum);
            }
            all += sum;
        }
        if !(all > 0.0 && all.is_finite()) {
            return None;
        }
        // A row is 2 / FINE high, and `along` integrates over y.
        left.iter_mut().for_each(|l| *l *= 0.5 * FINE as f64 / all);
        Some(Self { left })
    }

    /// ∫ left(x, y) dy along a chord.
    fn along(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let rise = to[1] - from[1];
        if rise == 0.0 {
            return 0.0;
        }
        let at = |i: usize| {
            let t = (i as f64 + 0.5) / ALONG as f64;
            self.at(from[0] + (to[0] - from[0]) * t, from[1] + rise * t)
        };
        (0..ALONG).map(at).sum::<f64>() * rise / ALONG as f64
    }

    /// Linear between the edges of pixels along a row, and between the middles of rows.
    fn at(&self, x: f64, y: f64) -> f64 {
        let along = (x + 1.0) * 0.5 * FINE as f64;
        let column = (along.max(0.0) as usize).min(FINE - 1);
        let part = (along - column as f64).clamp(0.0, 1.0);
        let across = ((y + 1.0) * 0.5 * FINE as f64 - 0.5).clamp(0.0, (FINE - 1) as f64);
        let row = (across as usize).min(FINE - 2);
        let in_row = |row: usize| {
            let at = row * (FINE + 1) + column;
            self.left[at] + (self.left[at + 1] - self.left[at]) * part
        };
        in_row(row) + (in_row(row + 1) - in_row(row)) * (across - row as f64)
    }
}
