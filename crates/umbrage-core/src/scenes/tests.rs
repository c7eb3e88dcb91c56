use super::*;
use crate::light::LightShape;
use crate::mesh_check::check_scene;
use glam::DVec3;

const DETAILS: [f32; 4] = [0.0, 0.3, 1.0, 2.0];

/// Every scene at several details, with what to call it in messages.
fn scenes() -> impl Iterator<Item = (String, Scene)> {
    SCENES.iter().flat_map(|entry| DETAILS.map(|d| (format!("{} at detail {d}", entry.id), (entry.build)(d))))
}

#[test]
fn ids_are_unique_and_found() {
    for (i, entry) in SCENES.iter().enumerate() {
        assert!(SCENES[..i].iter().all(|other| other.id != entry.id), "{} comes twice", entry.id);
        assert_eq!(find(entry.id).map(|e| e.title), Some(entry.title));
    }
    assert!(find("no such scene").is_none());
}

#[test]
fn meshes_are_sound() {
    for (what, scene) in scenes() {
        let report = check_scene(&scene);
        let faults = [
            report.degenerate_triangles,
            report.duplicate_triangles,
            report.non_finite_vertices,
            report.out_of_range_triangles,
            report.inconsistent_edges,
        ];
        assert_eq!(faults, [0; 5], "{what}: {report:?}");
        for mesh in &scene.meshes {
            assert_eq!(mesh.normals.len(), mesh.positions.len(), "{what}: {}", mesh.name);
            assert!(mesh.uvs.is_empty() || mesh.uvs.len() == mesh.positions.len(), "{what}: {}", mesh.name);
            let unit = mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4);
            assert!(unit, "{what}: a normal of {} is not of unit length", mesh.name);
        }
    }
}

#[test]
fn normals_are_on_the_side_of_the_triangles_front() {
    for entry in SCENES {
        for mesh in (entry.build)(1.0).meshes {
            let against = |t: &[u32; 3]| {
                let [a, b, c] = mesh.corners(*t);
                let face = (b - a).cross(c - a);
                t.iter().any(|&i| face.dot(mesh.normals[i as usize]) <= 0.0)
            };
            let count = mesh.triangles().filter(against).count();
            assert_eq!(count, 0, "{}: triangles of {} against their normals", entry.id, mesh.name);
        }
    }
}

/// Only what is meant to be a surface without thickness has a rim.
#[test]
fn solids_are_closed() {
    for entry in SCENES {
        for mesh in (entry.build)(0.3).meshes {
            let sheet = ["plane", "floor", "hills", "tree cards"].contains(&mesh.name.as_str());
            let report = crate::mesh_check::check(&mesh);
            assert_eq!(report.is_closed(), !sheet, "{}: {}: {report:?}", entry.id, mesh.name);
        }
    }
}

#[test]
fn indices_are_in_range() {
    for (what, scene) in scenes() {
        for i in &scene.instances {
            assert!(i.mesh < scene.meshes.len() && i.material < scene.materials.len(), "{what}: {i:?}");
            assert!(i.world_from_mesh.is_finite() && i.world_from_mesh.matrix3.determinant() > 0.0, "{what}: {i:?}");
            let material = &scene.materials[i.material];
            assert!(material.texture.is_none_or(|t| t < scene.textures.len()), "{what}: {material:?}");
            let has_uvs = !scene.meshes[i.mesh].uvs.is_empty();
            assert!(material.texture.is_none() || has_uvs, "{what}: a texture without coordinates");
        }
        for t in &scene.textures {
            assert_eq!(t.rgba.len(), (t.width * t.height) as usize, "{what}: {}", t.name);
        }
        assert!(scene.bounds().min.is_finite() && scene.bounds().max.is_finite(), "{what}");
    }
}

#[test]
fn triangle_counts_are_as_promised() {
    let count = |id: &str, detail: f32| find(id).map_or(0, |e| (e.build)(detail).triangle_count());
    assert!((1_200..1_400).contains(&count("primitives", 1.0)), "{}", count("primitives", 1.0));
    assert!((300_000..400_000).contains(&count("atrium", 1.0)), "{}", count("atrium", 1.0));
    assert!(count("atrium", 0.05) < 50_000, "{}", count("atrium", 0.05));
    for entry in SCENES {
        let counts = [0.05, 0.3, 1.0, 4.0].map(|d| count(entry.id, d));
        assert!(counts.is_sorted(), "{}: {counts:?}", entry.id);
        assert_eq!(count(entry.id, f32::NAN), counts[2], "{}: NaN is not the normal detail", entry.id);
    }
}

#[test]
fn the_city_has_its_buildings_and_its_size() {
    for (detail, want) in [(0.05, 80), (1.0, 1600), (6.25, 10_000)] {
        let scene = (city::ENTRY.build)(detail);
        let buildings = scene.instances.iter().filter(|i| scene.instance_bounds(i).size().y > 2.0);
        assert_eq!(buildings.count(), want, "detail {detail}");
        assert_eq!(scene.meshes.len(), 2, "detail {detail}: the buildings do not share one cube");
    }
    let size = (city::ENTRY.build)(1.0).bounds().size();
    assert!(size.x >= 400.0 && size.z >= 400.0, "{size}");
}

#[test]
fn cameras_stand_outside_of_casters() {
    for (what, scene) in scenes() {
        let camera = &scene.camera;
        let whole = scene.bounds().size();
        for i in scene.instances.iter().filter(|i| i.casts) {
            let bounds = scene.instance_bounds(i);
            // What spans the scene, such as hills, may have its box around the camera.
            if bounds.size().x < 0.5 * whole.x && bounds.size().z < 0.5 * whole.z {
                let inside = camera.eye.clamp(bounds.min, bounds.max) == camera.eye;
                assert!(!inside, "{what}: the eye is inside the box of {}", scene.meshes[i.mesh].name);
            }
        }
        assert!(camera.eye.distance(camera.target) > 1.0 && camera.eye.y > scene.bounds().min.y, "{what}");
    }
}

#[test]
fn lights_are_valid_and_the_first_is_hard_the_second_soft() {
    for (what, scene) in scenes() {
        let soft: Vec<bool> = scene.lights.iter().map(|l| l.shape.kind().is_soft()).collect();
        assert_eq!(soft, [false, true], "{what}");
        for light in &scene.lights {
            let valid = match light.shape {
                LightShape::Directional { direction, angle_deg } => {
                    (direction.length() - 1.0).abs() < 1e-12 && direction.y < 0.0 && angle_deg >= 0.0
                }
                LightShape::Sphere { position, radius } => position.is_finite() && radius > 0.0,
                LightShape::Point { position } => position.is_finite(),
                _ => false,
            };
            assert!(valid && light.intensity > 0.0 && light.casts, "{what}: {light:?}");
        }
    }
}

/// Light sources are in the open: a bit of every scene's floor or walls is lit by each of its
/// lights.
#[test]
fn lights_are_outside_of_boxes() {
    for entry in SCENES {
        let scene = (entry.build)(1.0);
        for light in &scene.lights {
            let center = light.shape.center();
            if center.w == 0.0 {
                continue;
            }
            let cubes = scene.instances.iter().filter(|i| i.casts && scene.meshes[i.mesh].name == "box");
            for cube in cubes {
                let local = cube.world_from_mesh.inverse().transform_point3(center.truncate());
                assert!(local.abs().max_element() > 0.5, "{}: a light is inside a box", entry.id);
            }
        }
    }
}

#[test]
fn building_is_deterministic() {
    for entry in SCENES {
        let (a, b) = ((entry.build)(0.5), (entry.build)(0.5));
        assert_eq!((&a.meshes, &a.instances, &a.textures), (&b.meshes, &b.instances, &b.textures), "{}", entry.id);
        assert_eq!((a.camera, a.lights, a.materials), (b.camera, b.lights, b.materials), "{}", entry.id);
    }
}

#[test]
fn casters_throw_their_shadows_into_the_picture() {
    // Loosely: the camera looks at the middle of what there is, not past it.
    for entry in SCENES {
        let scene = (entry.build)(1.0);
        let forward = (scene.camera.target - scene.camera.eye).normalize();
        let ahead = scene.instances.iter().filter(|i| {
            let to: DVec3 = scene.instance_bounds(i).center() - scene.camera.eye;
            to.dot(forward) > 0.0
        });
        assert!(2 * ahead.count() > scene.instances.len(), "{}: most things are behind the camera", entry.id);
    }
}
