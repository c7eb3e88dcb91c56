//! Small scenes.

use umbrage_core::glam::{DAffine3, DMat3, DVec3, Vec3};
use umbrage_core::{Camera, Light, LightShape, Material, Mesh, Scene, primitive};

/// Adds a mesh in a place with the usual material.
pub fn place(scene: &mut Scene, mesh: Mesh, size: DVec3, rotation: DMat3, at: DVec3) {
    let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(Material::default()));
    scene.place(mesh, material, DAffine3 { matrix3: rotation * DMat3::from_diagonal(size), translation: at });
}

/// One triangle that faces up at the origin, so that there is a surface.
pub fn speck() -> Mesh {
    Mesh {
        positions: vec![Vec3::new(-1.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, -1.0)],
        normals: vec![Vec3::Y; 3],
        indices: vec![0, 1, 2],
        ..Mesh::default()
    }
}

/// A floor, a turned box, a torus that shadows itself, and a sphere, seen from above.
pub fn still_life() -> Scene {
    let mut scene = Scene {
        camera: Camera { eye: DVec3::new(-0.4, 5.0, 7.0), target: DVec3::Y * 0.4, ..Camera::default() },
        ..Scene::default()
    };
    place(&mut scene, primitive::plane(), DVec3::new(9.0, 1.0, 9.0), DMat3::IDENTITY, DVec3::ZERO);
    let turned = DMat3::from_rotation_y(0.6);
    place(&mut scene, primitive::cube(), DVec3::new(0.6, 1.4, 0.8), turned, DVec3::new(-1.2, 0.7, -0.3));
    let tilted = DMat3::from_rotation_x(1.1) * DMat3::from_rotation_z(0.4);
    place(&mut scene, primitive::torus(0.7, 0.2, 48, 24), DVec3::ONE, tilted, DVec3::new(1.0, 0.9, 0.3));
    place(&mut scene, primitive::sphere(32, 16), DVec3::splat(0.4), DMat3::IDENTITY, DVec3::new(-0.1, 0.5, 1.3));
    scene
}

/// A light of every kind, at the same place.
pub fn every_light() -> Vec<Light> {
    let (position, direction) = (DVec3::new(2.2, 3.6, 1.4), DVec3::new(-0.6, -0.7, -0.3).normalize());
    let up = direction.any_orthonormal_vector();
    [
        LightShape::Point { position },
        LightShape::Spot { position, direction, inner_angle_deg: 20.0, outer_angle_deg: 30.0 },
        LightShape::Directional { direction, angle_deg: 0.0 },
        LightShape::Directional { direction, angle_deg: 4.0 },
        LightShape::Sphere { position, radius: 0.4 },
        LightShape::Ellipsoid { position, radii: DVec3::new(0.6, 0.2, 0.3), rotation: DMat3::from_rotation_x(0.5) },
        LightShape::Disc { position, direction, radius: 0.5 },
        LightShape::Rect { position, direction, up, size: (1.2, 0.4).into(), texture: None },
        LightShape::Line { from: position, to: position + up * 1.5 },
    ]
    .map(Light::new)
    .to_vec()
}
