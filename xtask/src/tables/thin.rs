//! Meshes with fewer triangles: corners that share a cell of a grid become one.

use anyhow::{Context, Result};
use std::collections::{BTreeMap, BTreeSet};

type Cell = [i64; 3];

/// The OBJ text of a mesh with about `triangles` triangles, from the OBJ text of a finer one.
pub fn thin(obj: &str, triangles: usize) -> Result<String> {
    let mesh = Mesh::read(obj)?;
    // The count falls as cells grow, with small steps up and down: halving comes near enough.
    let (mut fine, mut coarse) = (mesh.size * 1e-4, mesh.size);
    let mut best = mesh.clustered(fine);
    for _ in 0..24 {
        let cell = (fine * coarse).sqrt();
        let found = mesh.clustered(cell);
        if found.triangles.len() > triangles {
            fine = cell
        } else {
            coarse = cell
        }
        let off = |mesh: &Mesh| mesh.triangles.len().abs_diff(triangles);
        if off(&found) < off(&best) {
            best = found;
        }
    }
    Ok(best.text())
}

struct Mesh {
    corners: Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    /// Longest side of the box around it.
    size: f64,
}

impl Mesh {
    fn read(obj: &str) -> Result<Self> {
        let mut mesh = Self { corners: Vec::new(), triangles: Vec::new(), size: 0.0 };
        for (number, line) in obj.lines().enumerate() {
            let mut words = line.split_whitespace();
            let broken = || format!("line {} of the mesh: `{line}`", number + 1);
            match words.next() {
                Some("v") => {
                    let corner: Vec<f64> =
                        words.take(3).map(str::parse).collect::<Result<_, _>>().with_context(broken)?;
                    mesh.corners.push(corner.try_into().ok().with_context(broken)?);
                }
                Some("f") => {
                    let index =
                        |word: &str| word.split('/').next().and_then(|i| i.parse::<usize>().ok()?.checked_sub(1));
                    let indices = words.map(index).collect::<Option<Vec<_>>>().with_context(broken)?;
                    let fan = (2..indices.len()).map(|i| [indices[0], indices[i - 1], indices[i]]);
                    mesh.triangles.extend(fan);
                }
                _ => {}
            }
        }
        anyhow::ensure!(
            mesh.triangles.iter().flatten().all(|i| *i < mesh.corners.len()),
            "a triangle lacks its corner"
        );
        let side = |axis: usize| {
            let values = mesh.corners.iter().map(|c| c[axis]);
            values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
        };
        mesh.size = (0..3).map(side).fold(0.0, f64::max);
        anyhow::ensure!(mesh.size > 0.0, "the mesh is empty");
        Ok(mesh)
    }

    fn clustered(&self, cell: f64) -> Self {
        let cell_of = |corner: &[f64; 3]| corner.map(|v| (v / cell).floor() as i64);
        let mut clusters: BTreeMap<Cell, (usize, [f64; 4])> = BTreeMap::new();
        for corner in &self.corners {
            let count = clusters.len();
            let (_, sum) = clusters.entry(cell_of(corner)).or_insert((count, [0.0; 4]));
            (0..3).for_each(|axis| sum[axis] += corner[axis]);
            sum[3] += 1.0;
        }
        let mut corners = vec![[0.0; 3]; clusters.len()];
        clusters.values().for_each(|(number, [x, y, z, count])| corners[*number] = [x / count, y / count, z / count]);
        let mut seen = BTreeSet::new();
        let numbers = self.triangles.iter().map(|t| t.map(|i| clusters[&cell_of(&self.corners[i])].0));
        let triangles = numbers.filter(|[a, b, c]| {
            let mut sorted = [*a, *b, *c];
            sorted.sort_unstable();
            a != b && b != c && c != a && seen.insert(sorted)
        });
        Self { triangles: triangles.collect(), corners, size: self.size }
    }

    fn text(&self) -> String {
        let corners = self.corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let triangles = self.triangles.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
        corners.chain(triangles).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `side` × `side` squares.
    fn sheet(side: usize) -> String {
        let mut text = String::new();
        for (i, j) in (0..=side).flat_map(|i| (0..=side).map(move |j| (i, j))) {
            text += &format!("v {i} {} {j}\n", (i * j) as f64 * 0.01);
        }
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let at = |i: usize, j: usize| i * (side + 1) + j + 1;
            text += &format!("f {}/1/1 {}//2 {} {}\n", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
        text
    }

    #[test]
    fn about_as_many_triangles_remain_as_asked_for() {
        for wanted in [100, 500, 1500] {
            let thinned = Mesh::read(&thin(&sheet(40), wanted).unwrap()).unwrap();
            let found = thinned.triangles.len();
            assert!(found.abs_diff(wanted) * 4 < wanted, "{found} for {wanted}");
            assert!((35.0..=40.0).contains(&thinned.size), "{}", thinned.size);
        }
        assert_eq!(Mesh::read(&thin(&sheet(10), 9999).unwrap()).unwrap().triangles.len(), 200);
    }

    #[test]
    fn broken_meshes_are_named() {
        let text = |obj: &str| format!("{:#}", thin(obj, 9).unwrap_err());
        assert!(text("v 1 2\n").contains("line 1") && text("v 0 0 0\nv 1 1 1\nv 1 0 0\nf 1 2 9\n").contains("corner"));
        assert!(text("").contains("empty"));
    }
}
