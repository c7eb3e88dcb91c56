//! Ways of the camera through a scene, in steps of about a pixel: shadow edges that crawl or jump
//! on the way are seen there.

use crate::error::Error;
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use umbrage_core::Camera;
use umbrage_core::glam::DQuat;

/// How the camera moves. What is as far away as the middle of the picture moves by about a pixel a
/// frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CameraPath {
    /// Forward.
    Walk,
    /// To the right.
    Strafe,
    /// Turns to the right where it is.
    Turn,
    /// Forward, to the side, up and round at once.
    Fly,
}

/// Forward, to the right, up, and round.
type Share = [f64; 4];

/// Where the camera turns back, steps, at the latest; it has then gone a quarter of the way to what
/// it looks at.
const MOST_STEPS: u32 = 48;

impl CameraPath {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Walk, Self::Strafe, Self::Turn, Self::Fly];

    /// The name users see.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Strafe => "strafe",
            Self::Turn => "turn",
            Self::Fly => "fly",
        }
    }

    fn share(self) -> Share {
        match self {
            Self::Walk => [1.0, 0.0, 0.0, 0.0],
            Self::Strafe => [0.0, 1.0, 0.0, 0.0],
            Self::Turn => [0.0, 0.0, 0.0, 1.0],
            Self::Fly => [0.6, 0.5, 0.3, 0.3],
        }
    }

    /// Frames until the camera is back, for pictures `height` pixels high.
    pub fn period(height: u32) -> u32 {
        2 * (height / 16).clamp(2, MOST_STEPS)
    }

    /// Where `start` is in frame `frame`, for pictures `height` pixels high.
    pub fn camera(self, start: &Camera, frame: u32, height: u32) -> Camera {
        let steps = steps(frame, height);
        let distance = start.eye.distance(start.target);
        let pixel = 2.0 * (start.fov_y_deg.to_radians() * 0.5).tan() / f64::from(height);
        let [right, up, forward] = start.axes();
        let [walk, strafe, rise, turn] = self.share().map(|share| share * steps);
        // Half way to the upper edge of the picture things move by a pixel when the way ahead gets
        // shorter by this.
        let ahead = 4.0 / f64::from(height);
        let by = (forward * walk * ahead + (right * strafe + up * rise) * pixel) * distance;
        let round = DQuat::from_axis_angle(up, -turn * pixel);
        Camera { eye: start.eye + by, target: start.eye + by + round * (forward * distance), ..start.clone() }
    }
}

/// How far along the way frame `frame` is: there and back, in steps of 0.6 to 1.4, no two alike, so
/// that no grid keeps pace.
fn steps(frame: u32, height: u32) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let period = CameraPath::period(height);
    let phase = frame % period;
    let along = phase.min(period - phase);
    (0..along).map(|step| 0.6 + 0.8 * (f64::from(step) * GOLDEN).fract()).sum()
}

impl FromStr for CameraPath {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let found = Self::ALL.into_iter().find(|path| path.name() == text);
        found.ok_or_else(|| Error::one_of(text, &Self::ALL.map(Self::name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::{DVec2, DVec3};

    #[test]
    fn names_are_read_and_mistakes_named() {
        for path in CameraPath::ALL {
            assert_eq!(path.name().parse::<CameraPath>().unwrap(), path);
            assert_eq!(serde_json::to_value(path).unwrap(), path.name());
        }
        let wrong = "stafe".parse::<CameraPath>().unwrap_err().to_string();
        assert!(wrong.contains("did you mean `strafe`") && wrong.contains("walk, strafe, turn, fly"), "{wrong}");
    }

    /// Where the picture shows `point`, pixels.
    fn place(camera: &Camera, point: DVec3, size: (u32, u32)) -> DVec2 {
        let clip = camera.view(size.0, size.1).clip_from_world() * point.extend(1.0);
        DVec2::new(clip.x, -clip.y) / clip.w * 0.5 * DVec2::new(size.0.into(), size.1.into())
    }

    #[test]
    fn a_step_is_about_a_pixel_and_the_way_leads_back() {
        let start = Camera { eye: DVec3::new(3.0, 4.0, 9.0), target: DVec3::new(1.0, 1.0, 0.0), ..Camera::default() };
        for (path, size) in CameraPath::ALL.into_iter().flat_map(|path| [(path, (1024, 768)), (path, (96, 72))]) {
            // Half way between the middle and the upper edge, as far away as the middle.
            let point = start.eye
                + start.ray(DVec2::new(f64::from(size.0) / 2.0, f64::from(size.1) / 4.0), size.0, size.1)
                    * start.eye.distance(start.target);
            let at = |frame| place(&path.camera(&start, frame, size.1), point, size);
            let turn = (size.1 / 16).min(MOST_STEPS);
            // Steps forward grow as what is ahead comes nearer.
            for frame in 0..turn {
                let step = at(frame).distance(at(frame + 1));
                assert!((0.4..2.3).contains(&step), "{} from frame {frame}: {step}", path.name());
            }
            assert_eq!(path.camera(&start, 0, size.1).eye, start.eye);
            assert_eq!(path.camera(&start, 2 * turn, size.1), path.camera(&start, 0, size.1));
            assert_eq!(path.camera(&start, turn + 1, size.1), path.camera(&start, turn - 1, size.1));
            let far = path.camera(&start, turn, size.1).eye.distance(start.eye);
            assert!(far < 0.3 * start.eye.distance(start.target), "{}: {far}", path.name());
        }
    }

    #[test]
    fn pictures_of_one_row_have_a_way_too() {
        for frame in 0..9 {
            assert!(CameraPath::Fly.camera(&Camera::default(), frame, 1).eye.is_finite());
        }
    }
}
