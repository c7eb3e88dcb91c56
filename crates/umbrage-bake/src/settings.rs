//! What a bake can be asked for.

use crate::Error;
use umbrage_core::{Scene, harmonics::Order, transfer::Kind};

/// How a scene is baked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// n² functions.
    pub order: Order,
    /// What light does on its way.
    pub kind: Kind,
    /// Rays for each point and pass, 1 to 65,536: over the half of the sphere above the point, more
    /// of them where the cosine is large.
    pub rays: u32,
    /// Edges of triangles along the diagonal of the scene, 1 to 4096: longer edges are cut, so that
    /// a floor of two triangles shows shadows.
    pub detail: f64,
    /// Most vertices of the scene after cutting; edges stay longer where it would be more.
    pub most_vertices: usize,
    /// Which sides of meshes get points.
    pub sides: BakedSides,
}

/// Which sides of meshes get points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BakedSides {
    /// Both of open meshes, the front of closed ones.
    #[default]
    Seen,
    /// Both of all, for cameras inside of closed meshes.
    Both,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            order: Order::default(),
            kind: Kind::default(),
            rays: 256,
            detail: 64.0,
            most_vertices: 200_000,
            sides: BakedSides::default(),
        }
    }
}

impl Settings {
    /// Looks settings and scene over.
    ///
    /// # Errors
    /// Numbers out of range; instances that refer to what is not there; with bounces, materials
    /// that reflect more than they get.
    pub fn check(&self, scene: &Scene) -> Result<(), Error> {
        let wrong = |what: &str| Err(Error::Settings(what.into()));
        if !(1..=65_536).contains(&self.rays) {
            return wrong("rays are 1 to 65,536 for each point");
        }
        if !(1.0..=4096.0).contains(&self.detail) {
            return wrong("the detail is 1 to 4096 edges along the scene's diagonal");
        }
        if matches!(self.kind, Kind::Interreflected { bounces } if bounces > 64) {
            return wrong("bounces are 0 to 64");
        }
        for (i, instance) in scene.instances.iter().enumerate() {
            if instance.mesh >= scene.meshes.len() {
                return Err(Error::Scene(format!("instance {i} has mesh {}, which is not there", instance.mesh)));
            }
        }
        if self.kind.channels() == 3 { self.check_albedo(scene) } else { Ok(()) }
    }

    fn check_albedo(&self, scene: &Scene) -> Result<(), Error> {
        let used = |m: usize| scene.instances.iter().any(|i| i.material == m);
        for (i, material) in scene.materials.iter().enumerate().filter(|(i, _)| used(*i)) {
            let color = material.base_color.truncate();
            if !color.to_array().iter().all(|c| (0.0..=1.0).contains(c)) {
                return Err(Error::Scene(format!(
                    "material {i} has the base colour {color}, and what reflects is from 0 to 1; change it, or bake without bounces"
                )));
            }
        }
        Ok(())
    }
}
