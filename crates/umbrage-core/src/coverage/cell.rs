//! Coverage of a piece of the disc, for lights that are split against the error of a single
//! silhouette.

/// A piece of the unit disc: what of it lies in a rectangle. Seen from a point, its silhouettes are
/// those from one point on it.
///
/// With c that point, P the place where the ray from c through p leaves the piece and Q the one
/// through q, the sector between them is ½ ∮ (X − c) × dX along the border from P to Q. That is a
/// difference of ½ ∮ X × dX, which does not depend on c and is known in closed form for each side
/// and for the arc, less ½ c × (Q − P). So c may be anywhere on the piece.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// The rectangle; ±[`NO_SIDE`] where the piece is bounded by the circle alone.
    pub low: [f64; 2],
    /// The same.
    pub high: [f64; 2],
    /// What to add to x y on the right side, −x y on the upper one, x y on the left and −x y on the
    /// lower one so that they run on around the piece as ∮ X × dX.
    pub sides: [f64; 4],
    /// Direction of the arc's middle, from which angles count.
    pub arc_middle: [f64; 2],
    /// What to add to the angle on the arc.
    pub arc: f64,
    /// ∮ X × dX all around: twice the area.
    pub around: f64,
    /// Its centre of gravity.
    pub center: [f64; 2],
}

/// Outside of the disc.
pub const NO_SIDE: f64 = 2.0;

/// Parts of the border: right, upper, left and lower side, arc.
const ARC: usize = 4;

type Point = [f64; 2];

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

impl Cell {
    /// The disc cut in `count` columns and rows of the same width; of 1 to 3 each piece has at most
    /// one arc.
    pub fn grid(count: usize) -> Vec<Self> {
        let count = count.clamp(1, 3);
        let at = |i: usize| match i {
            0 => -NO_SIDE,
            i if i == count => NO_SIDE,
            i => 2.0 * i as f64 / count as f64 - 1.0,
        };
        let cell = |i: usize| {
            let (x, y) = (i % count, i / count);
            Self::new([at(x), at(y)], [at(x + 1), at(y + 1)])
        };
        (0..count * count).map(cell).collect()
    }

    fn new(low: Point, high: Point) -> Self {
        let zero = Self {
            low,
            high,
            sides: [0.0; 4],
            arc_middle: [-1.0, 0.0],
            arc: 0.0,
            around: std::f64::consts::TAU,
            center: [0.0; 2],
        };
        let corners = zero.corners();
        if corners.is_empty() { zero } else { zero.along(&corners) }
    }

    /// Where sides meet each other or the circle, counter-clockwise.
    fn corners(&self) -> Vec<Point> {
        let xs = [self.low[0], self.high[0]];
        let ys = [self.low[1], self.high[1]];
        let mut found: Vec<Point> = xs.iter().flat_map(|x| ys.map(|y| [*x, y])).filter(|p| length(*p) < 1.0).collect();
        let is_in = |at: f64, ends: [f64; 2]| ends[0] <= at && at <= ends[1];
        let others = |at: f64| [-1.0, 1.0].map(|sign| sign * (1.0 - at * at).sqrt());
        for x in xs.into_iter().filter(|x| x.abs() < 1.0) {
            found.extend(others(x).into_iter().filter(|y| is_in(*y, ys)).map(|y| [x, y]));
        }
        for y in ys.into_iter().filter(|y| y.abs() < 1.0) {
            found.extend(others(y).into_iter().filter(|x| is_in(*x, xs)).map(|x| [x, y]));
        }
        let middle = mean(&found);
        let angle = |p: &Point| (p[1] - middle[1]).atan2(p[0] - middle[0]);
        found.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        found
    }

    /// Goes around from corner to corner, and finds what each part of the border starts with.
    fn along(mut self, corners: &[Point]) -> Self {
        let middle = mean(corners);
        let pairs = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
        let chord_middle = |(a, b): (Point, Point)| mean(&[a, b]);
        if let Some(ends) = pairs().find(|ends| self.exit(middle, minus(chord_middle(*ends), middle)).1 == ARC) {
            let out = chord_middle(ends);
            self.arc_middle = out.map(|c| c / length(out));
        }
        let mut sum = 0.0;
        let mut weighted = [0.0; 2];
        for (a, b) in pairs() {
            let part = self.exit(middle, minus(mean(&[a, b]), middle)).1;
            *self.start(part) = 0.0;
            let [from, to] = [a, b].map(|p| self.potential(p, part));
            *self.start(part) = sum - from;
            sum += to - from;
            let moment = self.moment(a, b, part == ARC);
            weighted = [weighted[0] + moment[0], weighted[1] + moment[1]];
        }
        self.around = sum;
        self.center = weighted.map(|m| m / (0.5 * sum));
        self
    }

    fn start(&mut self, part: usize) -> &mut f64 {
        if part == ARC { &mut self.arc } else { &mut self.sides[part] }
    }

    /// ∫ (x, y) over the triangle, or the sector, between the origin and a part of the border.
    fn moment(&self, a: Point, b: Point, is_arc: bool) -> Point {
        if is_arc {
            return [(b[1] - a[1]) / 3.0, (a[0] - b[0]) / 3.0];
        }
        [0, 1].map(|i| cross(a, b) * (a[i] + b[i]) / 6.0)
    }

    /// Where a ray from a point on the piece leaves it, and through which part of the border.
    fn exit(&self, from: Point, way: Point) -> (Point, usize) {
        let square = way[0] * way[0] + way[1] * way[1];
        let along = from[0] * way[0] + from[1] * way[1];
        let inside = 1.0 - from[0] * from[0] - from[1] * from[1];
        let mut best = (((along * along + square * inside).max(0.0).sqrt() - along) / square, ARC);
        for axis in (0..2).filter(|axis| way[*axis] != 0.0) {
            let (bound, part) = if way[axis] > 0.0 { (self.high[axis], axis) } else { (self.low[axis], axis + 2) };
            let time = (bound - from[axis]) / way[axis];
            if time < best.0 {
                best = (time, part);
            }
        }
        ([from[0] + way[0] * best.0, from[1] + way[1] * best.0], best.1)
    }

    /// ∮ X × dX from where it starts to a point on a part of the border.
    fn potential(&self, at: Point, part: usize) -> f64 {
        match part {
            ARC => cross(self.arc_middle, at).atan2(self.arc_middle[0] * at[0] + self.arc_middle[1] * at[1]) + self.arc,
            0 | 2 => at[0] * at[1] + self.sides[part],
            _ => -at[0] * at[1] + self.sides[part],
        }
    }

    /// The part of an edge from `from` to `to` that runs across the piece, both in the light's
    /// plane.
    pub fn chord(&self, from: Point, to: Point) -> Option<[Point; 2]> {
        let way = minus(to, from);
        let square = way[0] * way[0] + way[1] * way[1];
        let along = from[0] * way[0] + from[1] * way[1];
        let root = along * along - square * (from[0] * from[0] + from[1] * from[1] - 1.0);
        if !(root > 0.0 && square > 0.0) {
            return None;
        }
        let (mut start, mut end) = ((-along - root.sqrt()) / square, (-along + root.sqrt()) / square);
        (start, end) = (start.max(0.0), end.min(1.0));
        for axis in 0..2 {
            let [a, b] = [self.low[axis], self.high[axis]].map(|bound| (bound - from[axis]) / way[axis]);
            if way[axis] == 0.0 {
                if from[axis] < self.low[axis] || from[axis] > self.high[axis] {
                    return None;
                }
                continue;
            }
            (start, end) = (start.max(a.min(b)), end.min(a.max(b)));
        }
        let at = |t: f64| [from[0] + way[0] * t, from[1] + way[1] * t];
        (start < end).then(|| [at(start), at(end)])
    }

    /// A − S of a chord as a share of the piece, see [`super`], where silhouettes are those seen
    /// from `center`, a point on the piece, which `is_left` of the chord or not.
    pub fn term(&self, center: Point, [from, to]: [Point; 2], is_left: bool) -> f64 {
        let ways = [minus(from, center), minus(to, center)];
        let [(p, part_p), (q, part_q)] = ways.map(|way| self.exit(center, way));
        let sector = self.potential(q, part_q) - self.potential(p, part_p) - cross(center, minus(q, p));
        // A sector next to nothing may have any sign, as numbers are rounded.
        let least = 1e-4 * self.around;
        let sector = match is_left {
            true if sector < -least => sector + self.around,
            false if sector > least => sector - self.around,
            _ => sector,
        };
        (cross(ways[0], ways[1]) - sector) / self.around
    }
}

fn length(p: Point) -> f64 {
    p[0].hypot(p[1])
}

fn mean(points: &[Point]) -> Point {
    let sum = points.iter().fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
    sum.map(|s| s / points.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Flat, mix_flat, share_within, winding_about};
    use super::*;
    use proptest::prelude::*;

    /// The piece as a polygon, counter-clockwise.
    fn outline(cell: &Cell) -> Vec<Flat> {
        let steps = 2048;
        let way = |i: usize| (i as f64 / f64::from(steps) * std::f64::consts::TAU).sin_cos();
        (0..steps as usize).map(way).map(|(y, x)| cell.exit(cell.center, [x, y]).0).collect()
    }

    #[test]
    fn pieces_make_up_the_disc() {
        for count in 1..=3 {
            let cells = Cell::grid(count);
            let area: f64 = cells.iter().map(|c| 0.5 * c.around).sum();
            assert!((area - std::f64::consts::PI).abs() < 1e-12, "{count}: {area}");
            let moments =
                cells.iter().fold([0.0; 2], |m, c| [m[0] + c.around * c.center[0], m[1] + c.around * c.center[1]]);
            assert!(length(moments) < 1e-12, "{count}: {moments:?}");
        }
        let quarter = Cell::grid(2)[3];
        let center = 4.0 / (3.0 * std::f64::consts::PI);
        assert!(length(minus(quarter.center, [center; 2])) < 1e-12, "{:?}", quarter.center);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn terms_of_any_loop_add_up_to_its_area(
            polygon in prop::collection::vec(prop::array::uniform2(-1.6..1.6f64), 3..8),
            way in 0.0..1.0f64,
            far in 0.0..0.95f64,
        ) {
            for cell in (1..=3).flat_map(Cell::grid) {
                let border = outline(&cell);
                let eye = mix_flat(cell.center, border[(way * 2000.0) as usize], far);
                let edges = || (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]));
                // Where silhouettes are seen from a point that lies on one, the side is a matter of
                // rounding.
                let close = edges().any(|(a, b)| cross(minus(b, a), minus(eye, a)).abs() < 1e-6 * length(minus(b, a)));
                if close {
                    continue;
                }
                let term = |(a, b): (Flat, Flat)| {
                    let is_left = cross(minus(a, eye), minus(b, eye)) > 0.0;
                    cell.chord(a, b).map_or(0.0, |chord| cell.term(eye, chord, is_left))
                };
                let got = winding_about(eye, &polygon) + edges().map(term).sum::<f64>();
                let want = share_within(&border, &polygon) / (0.5 * cell.around);
                prop_assert!((got - want).abs() < 2e-4, "{cell:?} {eye:?} {polygon:?}: {got}, not {want}");
            }
        }
    }
}
