//! Solids that the procedural scenes are built of. All are closed and face outwards.

use crate::mesh::Mesh;
use glam::{DVec2, Vec3};
use std::f64::consts::TAU;

/// Edges that bend by more than this many degrees are sharp.
const CREASE_DEG: f32 = 44.0;

/// A solid of revolution around Y with `columns` columns, at least 3. The profile goes from the top
/// down, as (radius, height); it is closed where both ends have radius 0.
pub fn lathe(name: &str, columns: u32, profile: &[DVec2]) -> Mesh {
    let columns = columns.max(3);
    let mut mesh = Mesh { name: name.into(), ..Mesh::default() };
    let mut above: Option<Ring> = None;
    for point in profile {
        let ring = Ring { first: mesh.positions.len() as u32, pole: point.x <= 0.0 };
        for i in 0..if ring.pole { 1 } else { columns } {
            let around = DVec2::from_angle(TAU * f64::from(i) / f64::from(columns)) * point.x.max(0.0);
            mesh.positions.push(Vec3::new(around.x as f32, point.y as f32, -around.y as f32));
        }
        for i in 0..above.map_or(0, |_| columns) {
            let j = (i + 1) % columns;
            let (top, bottom) = (above.unwrap_or(ring), ring);
            if !bottom.pole {
                mesh.indices.extend([top.vertex(i), bottom.vertex(i), bottom.vertex(j)]);
            }
            if !top.pole {
                mesh.indices.extend([top.vertex(i), bottom.vertex(j), top.vertex(j)]);
            }
        }
        above = Some(ring);
    }
    mesh.with_creases(CREASE_DEG)
}

/// The vertices of one profile point.
#[derive(Clone, Copy)]
struct Ring {
    first: u32,
    pole: bool,
}

impl Ring {
    fn vertex(self, i: u32) -> u32 {
        if self.pole { self.first } else { self.first + i }
    }
}

/// Points of a circular arc for a profile or an outline, both ends included, angles in degrees
/// from +X towards +Y.
pub fn arc(center: DVec2, radius: f64, from_deg: f64, to_deg: f64, segments: u32) -> Vec<DVec2> {
    let step = (to_deg - from_deg) / f64::from(segments);
    let angle = |i: u32| if i == segments { to_deg } else { from_deg + step * f64::from(i) };
    (0..=segments).map(|i| center + DVec2::from_angle(angle(i).to_radians()) * radius).collect()
}

/// What lies between two open outlines of equally many points in the XY plane that run
/// counter-clockwise around the same middle, `inner` nearer to it; `depth` thick along Z, centred.
/// An arch, for example.
pub fn between(name: &str, inner: &[DVec2], outer: &[DVec2], depth: f64) -> Mesh {
    let mut mesh = Mesh { name: name.into(), ..Mesh::default() };
    let z = (depth * 0.5) as f32;
    for (i, o) in inner.iter().zip(outer) {
        let [i, o] = [i.as_vec2(), o.as_vec2()];
        mesh.positions.extend([i.extend(z), i.extend(-z), o.extend(z), o.extend(-z)]);
    }
    let last = (mesh.positions.len() as u32).saturating_sub(4);
    for a in (0..last).step_by(4) {
        let b = a + 4;
        for side in
            [[a, a + 2, b + 2, b], [a + 1, b + 1, b + 3, a + 3], [a + 2, a + 3, b + 3, b + 2], [a, b, b + 1, a + 1]]
        {
            quad(&mut mesh, side);
        }
    }
    quad(&mut mesh, [0, 1, 3, 2]);
    quad(&mut mesh, [last, last + 2, last + 3, last + 1]);
    mesh.with_creases(CREASE_DEG)
}

/// A convex outline in the XY plane, counter-clockwise, `depth` thick along Z, centred.
pub fn prism(name: &str, outline: &[DVec2], depth: f64) -> Mesh {
    let mut mesh = Mesh { name: name.into(), ..Mesh::default() };
    let (z, n) = ((depth * 0.5) as f32, outline.len() as u32);
    mesh.positions.extend(outline.iter().map(|p| p.as_vec2().extend(z)));
    mesh.positions.extend(outline.iter().map(|p| p.as_vec2().extend(-z)));
    for i in 0..n {
        let j = (i + 1) % n;
        quad(&mut mesh, [i, n + i, n + j, j]);
        if i > 0 && j > 0 {
            mesh.indices.extend([0, i, j, n, n + j, n + i]);
        }
    }
    mesh.with_creases(CREASE_DEG)
}

/// A panel of 1 × 1 in the XY plane and 1 thick along Z, centred, of `columns` × `rows` cells,
/// without those that `is_hole` names. Cells must not touch at a corner only, or the edge there is
/// not manifold.
pub fn perforated_panel(columns: u32, rows: u32, is_hole: impl Fn(u32, u32) -> bool) -> Mesh {
    let mut mesh = Mesh { name: "perforated panel".into(), ..Mesh::default() };
    for z in [0.5, -0.5] {
        for j in 0..=rows {
            for i in 0..=columns {
                mesh.positions.push(Vec3::new(i as f32 / columns as f32 - 0.5, j as f32 / rows as f32 - 0.5, z));
            }
        }
    }
    let back = (columns + 1) * (rows + 1);
    let corner = |i: u32, j: u32| j * (columns + 1) + i;
    let is_open = |i: i64, j: i64| match (u32::try_from(i), u32::try_from(j)) {
        (Ok(i), Ok(j)) => i >= columns || j >= rows || is_hole(i, j),
        _ => true,
    };
    for j in 0..rows {
        for i in (0..columns).filter(|&i| !is_hole(i, j)) {
            let ring = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            quad(&mut mesh, ring);
            quad(&mut mesh, [ring[0], ring[3], ring[2], ring[1]].map(|v| v + back));
            // Walls to the neighbours below, right, above, left where there is none.
            for (k, (di, dj)) in [(0, -1), (1, 0), (0, 1), (-1, 0)].into_iter().enumerate() {
                if is_open(i64::from(i) + di, i64::from(j) + dj) {
                    let (a, b) = (ring[k], ring[(k + 1) % 4]);
                    quad(&mut mesh, [a, a + back, b + back, b]);
                }
            }
        }
    }
    mesh.with_creases(CREASE_DEG)
}

/// Two triangles around a quadrilateral that runs counter-clockwise seen from its front.
fn quad(mesh: &mut Mesh, [a, b, c, d]: [u32; 4]) {
    mesh.indices.extend([a, b, c, a, c, d]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_check::check;

    /// Signed volume: positive where triangles face outwards.
    fn volume(m: &Mesh) -> f64 {
        let of = |t| {
            let [a, b, c] = m.corners(t).map(|p| p.as_dvec3());
            a.dot(b.cross(c)) / 6.0
        };
        m.triangles().map(of).sum()
    }

    fn assert_solid(mesh: &Mesh, want_volume: f64) {
        let report = check(mesh);
        assert!(report.is_closed() && report.degenerate_triangles == 0, "{}: {report:?}", mesh.name);
        let got = volume(mesh);
        assert!((got / want_volume - 1.0).abs() < 2e-3, "{}: volume {got} instead of {want_volume}", mesh.name);
    }

    #[test]
    fn a_lathe_turns_closed_solids() {
        let ball = arc(DVec2::ZERO, 1.0, 90.0, -90.0, 64);
        // The ends of the arc lie on the axis up to rounding; a profile must say so.
        let ball: Vec<_> = ball.iter().map(|p| if p.x.abs() < 1e-9 { DVec2::new(0.0, p.y) } else { *p }).collect();
        assert_solid(&lathe("ball", 128, &ball), 4.0 / 3.0 * std::f64::consts::PI);
    }

    #[test]
    fn an_arch_is_a_half_ring() {
        let ring = |radius| arc(DVec2::ZERO, radius, 0.0, 180.0, 64);
        assert_solid(&between("arch", &ring(1.0), &ring(2.0), 0.5), std::f64::consts::PI * 1.5 * 0.5);
    }

    #[test]
    fn a_prism_has_the_area_of_its_outline() {
        let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 2.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
        assert_solid(&prism("house", &outline, 3.0), 9.0);
    }

    #[test]
    fn a_perforated_panel_lacks_its_holes() {
        let panel = perforated_panel(7, 5, |i, j| i % 2 == 1 && (j == 1 || j == 2));
        assert_solid(&panel, 1.0 - 6.0 / 35.0);
    }
}
