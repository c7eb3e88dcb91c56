//! Casters that bend, under a sky.

use super::{SceneEntry, kit::*, tentacles};
use crate::{Environment, Scene};
use glam::{DVec3, Vec3};

pub const ENTRY: SceneEntry = SceneEntry {
    id: "seabed",
    title: "Swaying tentacles under the sea",
    about: "The tentacles again, under light that comes mostly from above: what moves shades itself and the floor. Lights: 0 \
            point, 1 sphere at the same place; the sky is that of clear water.",
    build,
};

fn build(detail: f32) -> Scene {
    let mut scene = (tentacles::ENTRY.build)(detail);
    scene.name = ENTRY.title.into();
    let up = DVec3::new(-0.3, 1.0, 0.25).normalize();
    let water = Environment { intensity: 0.9, ..Environment::new(soft_sky(up, Vec3::new(2.2, 4.4, 5.2))) };
    scene.environment = Some(water);
    scene
}
