//! Polygons of any simple shape, cut into triangles.
//!
//! A fan from the first corner is right for convex polygons, and for every other whose first corner
//! sees all of it. The others are cut by ear clipping. (Source: D. Eberly, "Triangulation by ear
//! clipping", 1998.)

use crate::limits::MOST_CORNERS;
use earcut::Earcut;
use glam::{DVec2, DVec3, Vec3};
use std::collections::HashMap;

/// How a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// Into triangles that are as large as the polygon.
    Right,
    /// As a fan, since its outline crosses itself: what is inside of it is anybody's guess.
    Crossing,
    /// Not at all, since it is concave and has so many corners that cutting it takes too long.
    TooLong,
}

/// Cuts polygons one after the other.
#[derive(Default)]
pub(crate) struct Cutter {
    ears: Ears,
}

#[derive(Default)]
struct Ears(Earcut<f64>);

impl Cutter {
    /// Appends triangles of the corners, by their numbers, to `triangles`.
    pub fn cut(&mut self, corners: &[Vec3], triangles: &mut Vec<[u32; 3]>) -> Cut {
        let count = corners.len() as u32;
        let fan = (2..count).map(|i| [0, i - 1, i]);
        let Some(flat) = flatten(corners) else {
            triangles.extend(fan.clone());
            let place = |i: u32| corners[i as usize].as_dvec3();
            let is_line = |[a, b, c]: [u32; 3]| (place(b) - place(a)).cross(place(c) - place(a)) == DVec3::ZERO;
            return if fan.clone().all(is_line) { Cut::Right } else { Cut::Crossing };
        };
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| flat[i as usize]);
            0.5 * (b - a).perp_dot(c - a)
        };
        let whole: f64 = fan.clone().map(area).sum();
        let least = -1e-7 * whole;
        if fan.clone().all(|t| area(t) >= least) {
            triangles.extend(fan);
            return Cut::Right;
        }
        if corners.len() > MOST_CORNERS {
            return Cut::TooLong;
        }
        let cut = self.ears.clip(&flat);
        let covered: f64 = cut.iter().map(|t| area(*t).abs()).sum();
        if (covered - whole).abs() > 1e-6 * whole {
            triangles.extend(fan);
            return Cut::Crossing;
        }
        triangles.extend(cut);
        Cut::Right
    }
}

impl Ears {
    /// Triangles of a polygon that runs counter-clockwise.
    fn clip(&mut self, flat: &[DVec2]) -> Vec<[u32; 3]> {
        let mut indices: Vec<u32> = Vec::new();
        self.0.earcut(flat.iter().map(|p| p.to_array()), &[], &mut indices);
        let mut triangles = indices.as_chunks::<3>().0.to_vec();
        for triangle in &mut triangles {
            let [a, b, c] = triangle.map(|i| flat[i as usize]);
            if (b - a).perp_dot(c - a) < 0.0 {
                triangle.swap(1, 2);
            }
        }
        restore(flat.len() as u32, &mut triangles);
        triangles
    }
}

/// Gives triangles back the corners on straight sides, which ear clipping leaves out: without them
/// neighbours that have them would not share their edges.
fn restore(count: u32, triangles: &mut Vec<[u32; 3]>) {
    let mut used = vec![false; count as usize];
    triangles.as_flattened().iter().for_each(|i| used[*i as usize] = true);
    let Some(first) = used.iter().position(|u| *u) else { return };
    let sides: HashMap<[u32; 2], usize> = triangles
        .iter()
        .enumerate()
        .flat_map(|(at, [a, b, c])| [([*a, *b], at), ([*b, *c], at), ([*c, *a], at)])
        .collect();
    // A triangle may have left-out corners on two of its sides: those before split it in parts.
    let mut parts: HashMap<usize, Vec<[u32; 3]>> = HashMap::new();
    let mut from = first as u32;
    let mut between: Vec<u32> = Vec::new();
    for step in 1..=count {
        let corner = (first as u32 + step) % count;
        if !used[corner as usize] {
            between.push(corner);
            continue;
        }
        if let (Some(at), false) = (sides.get(&[from, corner]), between.is_empty()) {
            split(parts.entry(*at).or_insert_with(|| vec![triangles[*at]]), from, &between, corner);
        }
        between.clear();
        from = corner;
    }
    for (at, split) in parts {
        triangles[at] = split[0];
        triangles.extend(&split[1..]);
    }
}

/// Splits the one of `parts` that has the side from `from` to `to` at the corners between.
fn split(parts: &mut Vec<[u32; 3]>, from: u32, between: &[u32], to: u32) {
    let turned = |t: &[u32; 3]| [[t[0], t[1], t[2]], [t[1], t[2], t[0]], [t[2], t[0], t[1]]];
    let found = parts.iter().enumerate().find_map(|(at, t)| {
        turned(t).into_iter().find(|[a, b, _]| (*a, *b) == (from, to)).map(|[_, _, apex]| (at, apex))
    });
    let Some((at, apex)) = found else { return };
    let side: Vec<u32> = [&[from], between, &[to]].concat();
    let mut new = side.windows(2).map(|pair| [pair[0], pair[1], apex]);
    if let Some(first) = new.next() {
        parts[at] = first;
    }
    parts.extend(new);
}

/// The polygon in the plane that it lies in at least roughly, counter-clockwise; `None` where it
/// has no area, or as much on one side as on the other. The normal is Newell's, the mean of those
/// of all corners.
fn flatten(corners: &[Vec3]) -> Option<Vec<DVec2>> {
    let first = corners.first()?.as_dvec3();
    let relative: Vec<DVec3> = corners.iter().map(|p| p.as_dvec3() - first).collect();
    let pairs = relative.iter().zip(relative.iter().cycle().skip(1));
    let normal = pairs.map(|(a, b)| a.cross(*b)).sum::<DVec3>().try_normalize()?;
    let (x, y) = normal.any_orthonormal_pair();
    let flat: Vec<DVec2> = relative.iter().map(|p| DVec2::new(x.dot(*p), y.dot(*p))).collect();
    Some(flat)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(corners: &[[f32; 2]], turn: usize) -> (Cut, Vec<[u32; 3]>, f32, Vec<Vec3>) {
        // In a plane that leans, far from the origin.
        let place = |p: &[f32; 2]| Vec3::new(100.0 + p[0], 3.0 + 0.5 * p[0] + p[1], 7.0 - 2.0 * p[1]);
        let mut points: Vec<Vec3> = corners.iter().map(place).collect();
        points.rotate_left(turn);
        let mut triangles = Vec::new();
        let cut = Cutter::default().cut(&points, &mut triangles);
        let normal = Vec3::new(0.5, -1.0, 0.0).cross(Vec3::new(0.0, 1.0, -2.0));
        let unit = Vec3::new(1.0, 0.5, 0.0).cross(Vec3::new(0.0, 1.0, -2.0));
        assert!(normal.length() > 0.0);
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            0.5 * (b - a).cross(c - a).dot(unit) / unit.length_squared()
        };
        let sum = triangles.iter().map(|t| area(t).abs()).sum();
        assert!(triangles.iter().all(|t| area(t) > -1e-3), "{triangles:?}");
        (cut, triangles, sum, points)
    }

    #[test]
    fn polygons_of_any_simple_shape_are_covered_from_every_corner() {
        let notch = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]];
        let dart = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]];
        let spiral = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 5.0],
            [1.0, 5.0],
            [1.0, 2.0],
            [3.0, 2.0],
            [3.0, 3.0],
            [2.0, 3.0],
            [2.0, 4.0],
            [4.0, 4.0],
            [4.0, 1.0],
            [0.0, 1.0],
        ];
        // A square with a hole, joined by a slit.
        let ring = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ];
        for (name, corners, area) in
            [("notch", &notch[..], 2.5), ("dart", &dart, 1.5), ("spiral", &spiral, 15.0), ("ring", &ring, 8.0)]
        {
            for turn in 0..corners.len() {
                let (cut, triangles, sum, _) = cut(corners, turn);
                assert_eq!(cut, Cut::Right, "{name} from {turn}");
                assert!((sum - area).abs() < 1e-3, "{name} from {turn}: {sum} {triangles:?}");
            }
        }
    }

    #[test]
    fn corners_on_straight_sides_stay_corners() {
        let comb = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.5, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
        ];
        for turn in 0..comb.len() {
            let (cut, triangles, sum, _) = cut(&comb, turn);
            assert_eq!((cut, triangles.len()), (Cut::Right, comb.len() - 2), "{triangles:?}");
            assert!((sum - 5.0).abs() < 1e-3, "from {turn}: {sum}");
            let sides: Vec<[u32; 2]> = triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).collect();
            for i in 0..comb.len() as u32 {
                assert!(sides.contains(&[i, (i + 1) % comb.len() as u32]), "side {i} from {turn}: {triangles:?}");
            }
        }
    }

    #[test]
    fn crossing_and_flat_polygons_stay_fans() {
        let bow = [[0.0, 0.0], [2.0, 2.0], [3.0, 0.0], [0.0, 1.0]];
        let points: Vec<Vec3> = bow.iter().map(|p| Vec3::new(p[0], p[1], 0.0)).collect();
        let mut triangles = Vec::new();
        assert_eq!(Cutter::default().cut(&points, &mut triangles), Cut::Crossing);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        triangles.clear();
        let line = [0.0, 2.0, 1.0, 3.0].map(|x| Vec3::new(x, 0.0, 0.0));
        assert_eq!(Cutter::default().cut(&line, &mut triangles), Cut::Right);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn the_largest_polygon_takes_no_time() {
        // A comb of teeth, and a zigzag that crosses itself everywhere.
        let comb: Vec<Vec3> = (0..MOST_CORNERS)
            .map(|i| Vec3::new(i as f32, if i % 2 == 0 { 9.0 } else { 1.0 }, 0.0))
            .chain([Vec3::new(MOST_CORNERS as f32, -1.0, 0.0), Vec3::new(0.0, -1.0, 0.0)])
            .skip(2)
            .collect();
        let mut bits = 1u32;
        let mut random = || {
            bits = bits.wrapping_mul(1664525).wrapping_add(1013904223);
            (bits >> 8) as f32 / 16_777_216.0
        };
        let chaos: Vec<Vec3> = (0..MOST_CORNERS).map(|_| Vec3::new(random(), random(), 0.0)).collect();
        for (name, polygon) in [("comb", comb), ("chaos", chaos)] {
            let started = std::time::Instant::now();
            let mut triangles = Vec::new();
            let cut = Cutter::default().cut(&polygon, &mut triangles);
            eprintln!("{name}: {cut:?} {:?}", started.elapsed());
            assert!(started.elapsed().as_secs() < 5, "{name}");
        }
    }
}
