//! Views chosen at random, the same in every run.

use umbrage::core::glam::DVec3;
use umbrage::core::{Bounds, Camera, Light, LightShape, Scene};

/// Numbers that look random (the generator of Knuth's MMIX; its high bits).
pub struct Random(pub u64);

impl Random {
    /// 0…1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    /// A point of a box.
    pub fn within(&mut self, bounds: &Bounds) -> DVec3 {
        let share = DVec3::new(self.unit(), self.unit(), self.unit());
        bounds.min + bounds.size() * share
    }

    /// Unit vectors, evenly.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            if v.length_squared() > 1e-4 && v.length_squared() <= 1.0 {
                return v.normalize();
            }
        }
    }

    /// The light that the scene has, the same moved, and lights of every kind without extent at any
    /// place in the scene and around it.
    pub fn light(&mut self, scene: &Scene, kind: usize) -> Light {
        let bounds = scene.bounds();
        let around = Bounds { min: bounds.min - bounds.size() * 0.2, max: bounds.max + bounds.size() * 0.5 };
        let position = self.within(&around);
        let direction = (self.within(&bounds) - position).normalize_or(DVec3::NEG_Y);
        let own = scene.lights[0].clone();
        let shape = match kind % 5 {
            0 => return own,
            1 => match own.shape {
                LightShape::Directional { direction, angle_deg } => {
                    let direction = (direction + self.direction() * 0.3).normalize();
                    LightShape::Directional { direction, angle_deg }
                }
                shape => {
                    let position = shape.center().truncate() + self.direction() * bounds.radius() * 0.1;
                    LightShape::Point { position }
                }
            },
            2 => LightShape::Point { position },
            3 => LightShape::Spot { position, direction, inner_angle_deg: 20.0, outer_angle_deg: 35.0 },
            _ => LightShape::Directional { direction: (self.direction() - DVec3::Y).normalize(), angle_deg: 0.0 },
        };
        Light { shape, ..own }
    }

    /// Cameras anywhere, in the shadow of a caster, near one, in its box, towards the light and
    /// away from it.
    pub fn camera(&mut self, scene: &Scene, light: &Light, kind: usize) -> Camera {
        let bounds = scene.bounds();
        let caster = self.caster(scene);
        let mut eye = self.within(&Bounds { min: bounds.min, max: bounds.max + bounds.size() * 0.2 });
        let mut target = self.within(&bounds);
        let center = light.shape.center();
        let toward = |eye: DVec3| (center.truncate() - eye * center.w).normalize_or(DVec3::Y);
        match kind % 6 {
            0 => (),
            1 => {
                let point = self.within(&caster);
                let far = self.range(0.1, 0.7) * bounds.radius().min(10.0);
                eye = point - toward(point) * far;
            }
            2 => {
                let side = self.direction();
                eye = caster.center() + side * (caster.size() * 0.5 + self.range(0.02, 0.4)).max(DVec3::ZERO);
                target = caster.center() + self.direction() * caster.radius();
            }
            3 => eye = self.within(&caster),
            4 => target = eye + toward(eye) + self.direction() * 0.3,
            _ => target = eye - toward(eye) + self.direction() * 0.3,
        }
        Camera {
            eye,
            target,
            up: DVec3::Y,
            fov_y_deg: self.range(30.0, 80.0),
            near: scene.camera.near,
            ..Camera::default()
        }
    }

    /// The box around a caster that is not half of the scene, where there is such a one.
    fn caster(&mut self, scene: &Scene) -> Bounds {
        let most = 0.5 * scene.bounds().radius();
        let all: Vec<Bounds> = scene.instances.iter().filter(|i| i.casts).map(|i| scene.instance_bounds(i)).collect();
        let small: Vec<Bounds> = all.iter().filter(|b| b.radius() < most).copied().collect();
        let some = if small.is_empty() { &all } else { &small };
        some[self.below(some.len())]
    }
}
