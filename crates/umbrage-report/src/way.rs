//! What moves along a path while flicker is measured: the camera, or the light.

use crate::{error::Error, path::CameraPath};
use serde::{Serialize, Serializer};
use std::str::FromStr;
use umbrage_core::glam::{DQuat, DVec3};
use umbrage_core::{Camera, Light, LightShape};

/// A path of the camera, or of the light before a camera that stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The camera moves.
    Camera(CameraPath),
    /// The light moves level and across the view, by a thousandth of the distance from the light to
    /// what the camera looks at; parallel light turns by as much of a radian.
    Light,
    /// Parallel light turns by 0.0042° a frame: the sun in a second.
    Sun,
}

/// By how much of its distance a light moves in a frame.
const LIGHT_STEP: f64 = 1e-3;

/// 15° an hour.
const SUN_STEP_DEG: f64 = 0.0042;

impl Way {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Camera(CameraPath::Walk),
        Self::Camera(CameraPath::Strafe),
        Self::Camera(CameraPath::Turn),
        Self::Camera(CameraPath::Fly),
        Self::Light,
        Self::Sun,
    ];

    /// The name users see.
    pub fn name(self) -> &'static str {
        match self {
            Self::Camera(path) => path.name(),
            Self::Light => "light",
            Self::Sun => "sun",
        }
    }

    /// Where the camera that stands as `start` does is in frame `frame`, for pictures `height`
    /// pixels high.
    pub fn camera(self, start: &Camera, frame: u32, height: u32) -> Camera {
        match self {
            Self::Camera(path) => path.camera(start, frame, height),
            Self::Light | Self::Sun => start.clone(),
        }
    }

    /// Where the light that stands as `start` does, before `camera`, is in frame `frame`.
    pub fn light(self, start: &Light, camera: &Camera, frame: u32) -> Light {
        let steps = f64::from(frame);
        let shape = match self {
            Self::Camera(_) => start.shape.clone(),
            Self::Light => across(&start.shape, camera, steps * LIGHT_STEP),
            Self::Sun => turned(&start.shape, camera, steps * SUN_STEP_DEG.to_radians()),
        };
        Light { shape, ..start.clone() }
    }

    /// Whether it moves this light, or the camera before it.
    pub fn moves(self, light: &Light) -> bool {
        self != Self::Sun || matches!(light.shape, LightShape::Directional { .. })
    }
}

/// The light moved along the camera's horizon by a share of its distance.
fn across(shape: &LightShape, camera: &Camera, share: f64) -> LightShape {
    let center = shape.center();
    if center.w == 0.0 {
        return turned(shape, camera, share);
    }
    let by = camera.axes()[0] * (share * center.truncate().distance(camera.target));
    let mut shape = shape.clone();
    shape.shift(by);
    shape
}

/// Parallel light turned by an angle in the plane that it and the camera's horizon span, the sky
/// around the vertical; other lights as they are.
fn turned(shape: &LightShape, camera: &Camera, angle: f64) -> LightShape {
    let mut shape = shape.clone();
    if let LightShape::Environment(environment) = &mut shape {
        environment.rotate_deg += angle.to_degrees();
    }
    if let LightShape::Directional { direction, .. } = &mut shape {
        let axis = direction.cross(camera.axes()[0]).try_normalize();
        let axis = axis.unwrap_or_else(|| direction.try_normalize().unwrap_or(DVec3::Y).any_orthonormal_vector());
        *direction = DQuat::from_axis_angle(axis, angle) * *direction;
    }
    shape
}

impl FromStr for Way {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let found = Self::ALL.into_iter().find(|way| way.name() == text);
        found.ok_or_else(|| Error::one_of(text, &Self::ALL.map(Self::name)))
    }
}

impl Serialize for Way {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::scenes;

    #[test]
    fn names_are_read_and_mistakes_named() {
        for way in Way::ALL {
            assert_eq!(way.name().parse::<Way>().unwrap(), way);
            assert_eq!(serde_json::to_value(way).unwrap(), way.name());
        }
        let wrong = "suns".parse::<Way>().unwrap_err().to_string();
        assert!(wrong.contains("did you mean `sun`") && wrong.contains("fly, light, sun"), "{wrong}");
    }

    #[test]
    fn lights_of_all_kinds_move_by_even_steps_and_the_camera_stands() {
        let scene = (scenes::find("primitives").unwrap().build)(0.1);
        let sun = (scenes::find("terrain").unwrap().build)(0.1).lights.swap_remove(0);
        for light in scene.lights.iter().chain([&sun]) {
            let center = light.shape.center();
            let place = |way: Way, frame| way.light(light, &scene.camera, frame).shape.center().truncate();
            let start = center.truncate();
            let parallel = center.w == 0.0;
            let step = if parallel { 1e-3 } else { 1e-3 * start.distance(scene.camera.target) };
            for frame in [0, 1, 40] {
                let moved = place(Way::Light, frame).distance(start);
                assert!((moved - f64::from(frame) * step).abs() < 1e-4 * step * 40.0, "{moved}");
                let turned = place(Way::Sun, frame).distance(start);
                let sun = if parallel { f64::from(frame) * 0.0042_f64.to_radians() } else { 0.0 };
                assert!((turned - sun).abs() < 1e-8 && Way::Sun.moves(light) == parallel, "{turned}");
            }
            assert_eq!(place(Way::Camera(CameraPath::Fly), 9), start);
            assert_eq!(Way::Light.camera(&scene.camera, 9, 480), scene.camera);
        }
        assert_eq!(sun.shape.center().w, 0.0, "no sun was looked at");
    }
}
