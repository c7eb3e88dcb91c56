//! Checks of a whole scene: that everything is where numbers can say it is. Vertices and transforms
//! may each be in range, and what comes of them not.

use crate::error::{Error, Place, line};
use crate::limits::LARGEST;
use glam::DVec3;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use umbrage_core::{Bounds, Instance, Scene};

/// What helps.
const REMEDY: &str = "look at the scales of the models and of the nodes in them";

/// Finds an instance, a light or a camera that is not finite or too far away.
///
/// # Errors
/// The first of them.
pub(crate) fn check(path: &Path, scene: &Scene) -> Result<(), Error> {
    let error = |part: String, at: DVec3| {
        let what = match at.is_finite() {
            true => format!("reaches to {:.0e} m; what can be drawn lies within {LARGEST:e} m", at.abs().max_element()),
            false => "is placed where numbers do not reach".to_owned(),
        };
        Error::new(path, what).at(Place::Part(part)).remedy(REMEDY)
    };
    let mut bounds: HashMap<usize, Bounds> = HashMap::new();
    let mut seen = HashSet::new();
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        let of_mesh = match key(instance) {
            None => *bounds.entry(instance.mesh).or_insert_with(|| mesh.bounds()),
            Some(pose) if seen.insert((instance.mesh, pose)) => scene.posed_mesh(instance).bounds(),
            Some(_) => continue,
        };
        if of_mesh.is_empty() {
            continue;
        }
        let corners = (0..8).map(|i| DVec3::select(mask(i), of_mesh.max, of_mesh.min));
        let mut placed = corners.map(|corner| instance.world_from_mesh.transform_point3(corner));
        if let Some(far) = placed.find(|p| !is_in_range(*p)) {
            return Err(error(format!("mesh `{}`", line(&mesh.name)), far));
        }
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let center = light.shape.center().truncate();
        if !is_in_range(center) || !is_in_range(DVec3::splat(light.shape.radius())) {
            return Err(error(format!("light {index}"), center));
        }
    }
    match is_in_range(scene.camera.eye) {
        true => Ok(()),
        false => Err(error("the camera".to_owned(), scene.camera.eye)),
    }
}

/// What the shape and the place of a posed instance depend on, besides its mesh.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct PoseKey {
    rig: usize,
    skin: usize,
    /// Animation, and the bits of the time.
    moment: Option<(usize, u64)>,
    /// The bits of the transform.
    world_from_mesh: [u64; 12],
}

fn key(instance: &Instance) -> Option<PoseKey> {
    let pose = instance.pose.as_ref()?;
    Some(PoseKey {
        rig: pose.rig,
        skin: pose.skin,
        moment: pose.moment.map(|m| (m.animation, m.time_s.to_bits())),
        world_from_mesh: instance.world_from_mesh.to_cols_array().map(f64::to_bits),
    })
}

fn mask(corner: usize) -> glam::BVec3 {
    glam::BVec3::new(corner & 1 == 1, corner & 2 == 2, corner & 4 == 4)
}

fn is_in_range(at: DVec3) -> bool {
    at.is_finite() && at.abs().max_element() <= LARGEST
}
