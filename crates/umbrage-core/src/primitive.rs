//! The primitives of the scene file as unit meshes: sizes go into the instance's transform, so that
//! a thousand boxes share one mesh.

use crate::mesh::Mesh;
use glam::{DVec2, DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// A square of side 1 in the XZ plane, centred, normal +Y, two triangles.
pub fn plane() -> Mesh {
    let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)];
    Mesh {
        name: "plane".into(),
        positions: corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec(),
        normals: vec![Vec3::Y; 4],
        uvs: corners.map(|(x, z)| Vec2::new(x + 0.5, z + 0.5)).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    }
}

/// A cube of side 1, centred, 12 triangles with flat normals.
pub fn cube() -> Mesh {
    let mut mesh = Mesh { name: "box".into(), ..Mesh::default() };
    for (normal, u) in [
        (Vec3::X, Vec3::NEG_Z),
        (Vec3::NEG_X, Vec3::Z),
        (Vec3::Y, Vec3::X),
        (Vec3::NEG_Y, Vec3::X),
        (Vec3::Z, Vec3::X),
        (Vec3::NEG_Z, Vec3::NEG_X),
    ] {
        let v = normal.cross(u);
        let base = mesh.positions.len() as u32;
        for (a, b) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
            mesh.positions.push(normal * 0.5 + u * a + v * b);
            mesh.normals.push(normal);
            mesh.uvs.push(Vec2::new(a + 0.5, 0.5 - b));
        }
        mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|i| base + i));
    }
    mesh
}

/// A sphere of radius 1 around Y with `columns` × `rows` cells, vertices exactly on it, the first
/// column towards +X. `columns` is at least 3 and `rows` at least 2; smaller numbers are raised.
pub fn sphere(columns: u32, rows: u32) -> Mesh {
    let rows = rows.max(2);
    let profile = (0..=rows).map(|j| {
        let (sin, cos) = (PI * f64::from(j) / f64::from(rows)).sin_cos();
        let sin = if j == rows { 0.0 } else { sin };
        (DVec2::new(sin, cos), DVec2::new(sin, cos))
    });
    revolve("sphere", columns, profile.collect())
}

/// A torus around Y with a ring of `major` and a tube of `minor` metres; `columns` around the ring,
/// `rows` around the tube, the first column towards +X.
pub fn torus(major: f64, minor: f64, columns: u32, rows: u32) -> Mesh {
    let rows = rows.max(3);
    let profile = (0..=rows).map(|j| {
        // Down the outer side first, as on the sphere, so that triangles face outwards.
        let (sin, cos) = (-TAU * f64::from(j % rows) / f64::from(rows)).sin_cos();
        (DVec2::new(major + minor * cos, minor * sin), DVec2::new(cos, sin))
    });
    revolve("torus", columns, profile.collect())
}

/// A closed cylinder of radius 1 and height 1 around Y, centred, `columns` × `rows` cells on its
/// side.
pub fn cylinder(columns: u32, rows: u32) -> Mesh {
    frustum_of_cone("cylinder", 1.0, columns, rows)
}

/// A closed cone of base radius 1 and height 1 around Y, centred, apex up, `columns` × `rows` cells
/// on its side.
pub fn cone(columns: u32, rows: u32) -> Mesh {
    frustum_of_cone("cone", 0.0, columns, rows)
}

fn frustum_of_cone(name: &str, top: f64, columns: u32, rows: u32) -> Mesh {
    let rows = rows.max(1);
    let slope = DVec2::new(1.0, 1.0 - top).normalize();
    let mut mesh = Mesh { name: name.into(), ..Mesh::default() };
    let side = (0..=rows).map(|j| {
        let t = f64::from(j) / f64::from(rows);
        (DVec2::new(top + (1.0 - top) * t, 0.5 - t), slope)
    });
    if top > 0.0 {
        mesh.append(&revolve(name, columns, vec![(DVec2::new(0.0, 0.5), DVec2::Y), (DVec2::new(top, 0.5), DVec2::Y)]));
    }
    mesh.append(&revolve(name, columns, side.collect()));
    mesh.append(&revolve(
        name,
        columns,
        vec![(DVec2::new(1.0, -0.5), DVec2::NEG_Y), (DVec2::new(0.0, -0.5), DVec2::NEG_Y)],
    ));
    mesh
}

/// Turns a profile of (radius, height) points with their normals around Y. Going along the profile
/// with the outside to the right gives triangles that face outwards; at radius 0 one triangle of a
/// cell vanishes and is left out.
fn revolve(name: &str, columns: u32, profile: Vec<(DVec2, DVec2)>) -> Mesh {
    let columns = columns.max(3);
    let mut mesh = Mesh { name: name.into(), ..Mesh::default() };
    for (j, (point, normal)) in profile.iter().enumerate() {
        for i in 0..=columns {
            // The last column repeats the first one to the last bit, so that the surface is closed.
            let (sin, cos) = (TAU * f64::from(i % columns) / f64::from(columns)).sin_cos();
            let around = |v: &DVec2| DVec3::new(v.x * cos, v.y, -v.x * sin).as_vec3();
            mesh.positions.push(around(point));
            mesh.normals.push(around(normal).normalize_or(Vec3::Y));
            mesh.uvs.push(Vec2::new(i as f32 / columns as f32, j as f32 / (profile.len() - 1) as f32));
        }
    }
    for j in 0..profile.len() as u32 - 1 {
        let (top, bottom) = (profile[j as usize].0.x, profile[j as usize + 1].0.x);
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let b = a + columns + 1;
            if bottom > 0.0 {
                mesh.indices.extend([a, b, b + 1]);
            }
            if top > 0.0 {
                mesh.indices.extend([a, b + 1, a + 1]);
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signed volume: positive where triangles face outwards.
    fn volume(m: &Mesh) -> f64 {
        let of = |t| {
            let [a, b, c] = m.corners(t).map(|p| p.as_dvec3());
            a.dot(b.cross(c)) / 6.0
        };
        m.triangles().map(of).sum()
    }

    #[test]
    fn closed_primitives_have_the_volume_of_their_shape() {
        for (mesh, want) in [
            (cube(), 1.0),
            (sphere(256, 128), 4.0 / 3.0 * PI),
            (cylinder(256, 3), PI),
            (cone(256, 3), PI / 3.0),
            (torus(0.6, 0.2, 256, 128), 2.0 * PI * PI * 0.6 * 0.04),
        ] {
            let got = volume(&mesh);
            assert!((got / want - 1.0).abs() < 1e-3, "{}: {got} instead of {want}", mesh.name);
        }
    }

    #[test]
    fn normals_point_out_of_the_triangles() {
        for mesh in [plane(), cube(), sphere(16, 8), cylinder(16, 2), cone(16, 2), torus(0.6, 0.2, 16, 8)] {
            for t in mesh.triangles() {
                let [a, b, c] = mesh.corners(t);
                let face = (b - a).cross(c - a);
                assert!(face.length() > 0.0, "{}: degenerate triangle", mesh.name);
                for i in t {
                    assert!(face.dot(mesh.normals[i as usize]) > 0.0, "{}: normal points inwards", mesh.name);
                }
            }
        }
    }

    #[test]
    fn a_sphere_has_its_vertices_on_it_and_starts_at_plus_x() {
        let m = sphere(64, 32);
        assert!(m.positions.iter().all(|p| (p.length() - 1.0).abs() < 1e-6));
        assert!(m.positions[16 * 65].x > 0.999 && m.triangle_count() == 64 * 31 * 2);
    }
}
