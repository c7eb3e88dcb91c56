//! Instances that come and go while techniques are measured.

use std::time::Instant;
use umbrage::{Casters, Error, InstanceId, Placement};
use umbrage_core::Scene;

/// So many instances of a scene are removed and inserted again in every frame.
pub(crate) struct Churn {
    /// What comes back, each with the handle that it has now.
    instances: Vec<(InstanceId, Placement)>,
    count: usize,
    next: usize,
}

/// From one instance to the next that goes: no divisor of a number of instances that is a round
/// one, so that they are spread over the scene.
const STRIDE: usize = 7919;

impl Churn {
    /// `None` for 0 of them, and for a scene without instances.
    pub(crate) fn new(count: u32, scene: &Scene, casters: &Casters) -> Option<Self> {
        let placed = scene.instances.iter().enumerate().filter_map(|(number, instance)| {
            let placement = Placement {
                casts: instance.casts,
                receives: instance.receives,
                joints: scene.joints(instance),
                model: instance.model as u32,
                ..Placement::new(
                    casters.mesh(instance.mesh)?,
                    casters.material(instance.material)?,
                    instance.world_from_mesh,
                )
            };
            Some((casters.instance(number)?, placement))
        });
        let instances: Vec<_> = placed.collect();
        let count = (count as usize).min(instances.len());
        (count > 0).then_some(Self { instances, count, next: 0 })
    }

    /// Removes some, then inserts them; the CPU's time for both, milliseconds.
    ///
    /// # Errors
    /// None but of a device that is lost.
    pub(crate) fn apply(&mut self, casters: &mut Casters) -> Result<f64, Error> {
        let all = self.instances.len();
        let stride = if all.is_multiple_of(STRIDE) { 1 } else { STRIDE % all };
        let chosen: Vec<usize> = (0..self.count).map(|i| (self.next + i * stride) % all).collect();
        self.next = (self.next + self.count * stride) % all;
        let start = Instant::now();
        for &number in &chosen {
            casters.remove(self.instances[number].0)?;
        }
        for &number in &chosen {
            let (instance, placement) = &mut self.instances[number];
            *instance = casters.insert(placement)?;
        }
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage::Gpu;
    use umbrage_core::scenes;

    #[test]
    fn all_come_back() {
        let scene = (scenes::find("tentacles").unwrap().build)(0.05);
        let mut casters = Casters::new(&Gpu::request(None).unwrap(), &scene).unwrap();
        assert!(Churn::new(0, &scene, &casters).is_none());
        for count in [1, 3, 1000] {
            let mut churn = Churn::new(count, &scene, &casters).unwrap();
            for _ in 0..7 {
                churn.apply(&mut casters).unwrap();
                assert_eq!(casters.len(), scene.instances.len());
            }
            // Handles have changed: this one's scene is another one now.
            casters = Casters::new(&Gpu::request(None).unwrap(), &scene).unwrap();
        }
    }
}
