//! How mouse and keys move cameras and lights.

use umbrage_core::glam::{DQuat, DVec2, DVec3};
use umbrage_core::{Camera, Light, LightShape};

/// Radians for each share of the window's height that the mouse goes.
const TURN: f64 = 3.0;
/// Steepest look up and down, radians.
const STEEPEST: f64 = 1.55;

/// Turns the camera about its target by a drag, in shares of the picture's height.
pub(crate) fn orbit(camera: &mut Camera, drag: DVec2) {
    let arm = turned(camera.eye - camera.target, camera.up, drag * -TURN);
    camera.eye = camera.target + arm;
}

/// Turns the camera where it is.
pub(crate) fn look(camera: &mut Camera, drag: DVec2) {
    let view = turned(camera.target - camera.eye, camera.up, drag * TURN * -0.5 * DVec2::new(1.0, -1.0));
    camera.target = camera.eye + view;
}

/// `arm` turned about `up` by the first angle and towards it by the second; never beyond.
fn turned(arm: DVec3, up: DVec3, by: DVec2) -> DVec3 {
    let up = up.normalize_or(DVec3::Y);
    let round = DQuat::from_axis_angle(up, by.x) * arm;
    let side = round.cross(up);
    let Some(side) = side.try_normalize() else { return round };
    let height = round.angle_between(up);
    let new = (height + by.y).clamp(std::f64::consts::FRAC_PI_2 - STEEPEST, std::f64::consts::FRAC_PI_2 + STEEPEST);
    DQuat::from_axis_angle(side, height - new) * round
}

/// Moves the camera with its target, in shares of its distance from it: right, up, forward.
pub(crate) fn shift(camera: &mut Camera, by: DVec3) {
    let [right, up, forward] = camera.axes();
    let by = (right * by.x + up * by.y + forward * by.z) * camera.eye.distance(camera.target);
    camera.eye += by;
    camera.target += by;
}

/// Moves the camera on level ground, metres: right, up, forward.
pub(crate) fn walk(camera: &mut Camera, by: DVec3) {
    let up = camera.up.normalize_or(DVec3::Y);
    let [right, _, forward] = camera.axes();
    let ahead = forward.reject_from_normalized(up).normalize_or(forward);
    let by = right * by.x + up * by.y + ahead * by.z;
    camera.eye += by;
    camera.target += by;
}

/// Goes nearer to the target, or away where `by` is under 0; a parallel camera shows less, or more.
pub(crate) fn zoom(camera: &mut Camera, by: f64) {
    let factor = (-by).exp().clamp(0.05, 20.0);
    match &mut camera.parallel {
        Some(parallel) => parallel.height *= factor,
        None => {
            let arm = camera.eye - camera.target;
            let length = (arm.length() * factor).clamp(camera.near * 2.0, 1e9);
            camera.eye = camera.target + arm.normalize_or(DVec3::Z) * length;
        }
    }
}

/// Moves a light by a drag, in shares of the picture's height: at constant height as seen from
/// `camera`; parallel light turns.
pub(crate) fn drag_light(light: &mut Light, camera: &Camera, drag: DVec2) {
    if let LightShape::Directional { direction, .. } = &mut light.shape {
        *direction = -turned(-*direction, DVec3::Y, drag * DVec2::new(TURN, TURN)).normalize_or(DVec3::Y);
        return;
    }
    let [right, _, forward] = camera.axes();
    let level = |v: DVec3, other: DVec3| v.reject_from_normalized(DVec3::Y).normalize_or(other);
    let distance = camera.eye.distance(light.shape.center().truncate());
    let by = level(right, DVec3::X) * drag.x - level(forward, DVec3::NEG_Z) * drag.y;
    move_light(light, by * distance);
}

/// Moves a light, metres; a parallel light stays.
fn move_light(light: &mut Light, by: DVec3) {
    light.shape.shift(by);
}

/// Raises a light by a share of the scene's radius; a parallel one climbs by as many radians.
pub(crate) fn raise_light(light: &mut Light, share: f64, radius: f64) {
    if let LightShape::Directional { .. } = light.shape {
        drag_light(light, &Camera::default(), DVec2::new(0.0, -share / TURN));
    } else {
        move_light(light, DVec3::Y * (share * radius));
    }
}

/// Where the sun stands: azimuth and height, degrees.
pub(crate) fn sun_angles(direction: DVec3) -> [f64; 2] {
    let to = -direction;
    [to.x.atan2(to.z).to_degrees().rem_euclid(360.0), to.y.clamp(-1.0, 1.0).asin().to_degrees()]
}

/// The way its light travels.
pub(crate) fn sun_direction([azimuth, height]: [f64; 2]) -> DVec3 {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let (up, level) = height.to_radians().sin_cos();
    -DVec3::new(sin * level, up, cos * level)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_camera_keeps_its_distance_and_never_looks_along_up() {
        let mut camera = Camera::default();
        let distance = camera.eye.distance(camera.target);
        for _ in 0..50 {
            orbit(&mut camera, DVec2::new(0.03, 0.2));
        }
        assert!((camera.eye.distance(camera.target) - distance).abs() < 1e-9);
        assert!((camera.eye - camera.target).normalize().cross(camera.up).length() > 0.01);
        let eye = camera.eye;
        look(&mut camera, DVec2::new(-0.4, 0.1));
        assert_eq!(camera.eye, eye);
    }

    #[test]
    fn the_mouse_takes_what_it_drags_along() {
        let mut camera = Camera::default();
        orbit(&mut camera, DVec2::new(0.1, 0.0));
        // The scene turns to the right, so the eye goes left.
        assert!(camera.eye.x < 0.0, "{}", camera.eye);
        let mut light = Light::new(LightShape::Point { position: DVec3::Y });
        drag_light(&mut light, &Camera::default(), DVec2::new(0.1, 0.1));
        let center = light.shape.center();
        assert!(center.x > 0.0 && center.z > 0.0 && center.y == 1.0, "{center}");
    }

    #[test]
    fn the_sun_stands_where_its_angles_say() {
        for angles in [[0.0, 30.0], [90.0, -10.0], [300.0, 80.0]] {
            let again = sun_angles(sun_direction(angles));
            assert!((again[0] - angles[0]).abs() < 1e-9 && (again[1] - angles[1]).abs() < 1e-9, "{again:?}");
        }
        let mut sun = Light::new(LightShape::Directional { direction: sun_direction([40.0, 20.0]), angle_deg: 0.5 });
        raise_light(&mut sun, 0.1, 7.0);
        let LightShape::Directional { direction, .. } = sun.shape else { panic!("another kind") };
        assert!((sun_angles(direction)[1] - 20.0 - 0.1f64.to_degrees()).abs() < 1e-9, "{:?}", sun_angles(direction));
    }

    #[test]
    fn nothing_becomes_infinite() {
        let mut camera = Camera { target: Camera::default().eye, ..Camera::default() };
        orbit(&mut camera, DVec2::ONE);
        zoom(&mut camera, 1e9);
        zoom(&mut camera, -1e9);
        assert!(camera.eye.is_finite());
    }
}
