//! Cameras and `KHR_lights_punctual`.
//!
//! Intensities are in candela (point, spot) and lux (directional). The lighting model has no 1/π in
//! its diffuse term, so they are divided by π; point and spot lights fall off with the squared
//! distance.

use super::File;
use crate::Error;
use crate::model::Model;
use glam::{DAffine3, DVec3, Vec3};
use gltf::Node;
use gltf::camera::Projection;
use gltf::khr_lights_punctual::Kind;
use std::f32::consts::PI;
use umbrage_core::{Camera, Light, LightShape};

/// Map techniques cannot look into a half-space; wider cones end here, degrees.
const WIDEST_CONE: f64 = 89.9;

/// Takes the first perspective camera as the model's; others are noted.
pub(super) fn read_camera(file: &mut File<'_>, model: &mut Model, node: &Node<'_>, model_from_node: DAffine3) {
    let Some(camera) = node.camera() else { return };
    let Projection::Perspective(lens) = camera.projection() else {
        file.note(format!("camera {} is orthographic and was left out", camera.index()));
        return;
    };
    let (fov_y_deg, near) = (f64::from(lens.yfov()).to_degrees(), f64::from(lens.znear()));
    let (forward, up) = (direction(model_from_node, DVec3::NEG_Z), direction(model_from_node, DVec3::Y));
    let usable = 0.0 < fov_y_deg && fov_y_deg < 180.0 && near > 0.0 && near.is_finite();
    let (Some(forward), Some(up), true) = (forward, up, usable) else {
        file.note(format!("camera {} has a degenerate view and was left out", camera.index()));
        return;
    };
    if model.camera.is_some() {
        file.note(format!("camera {} is not used: the first one is", camera.index()));
        return;
    }
    let eye = model_from_node.translation;
    model.camera = Some(Camera { eye, target: eye + forward, up, fov_y_deg, near, ..Camera::default() });
}

/// Adds the light of a node, if it has one.
pub(super) fn read_light(
    file: &mut File<'_>,
    model: &mut Model,
    node: &Node<'_>,
    model_from_node: DAffine3,
) -> Result<(), Error> {
    let Some(light) = node.light() else { return Ok(()) };
    let part = format!("light {}", light.index());
    let position = model_from_node.translation;
    let aimed = || {
        direction(model_from_node, DVec3::NEG_Z).ok_or_else(|| {
            let what = format!("node {} is scaled to nothing: the light has no direction", node.index());
            file.error(&part, what).remedy("give the node a scale other than 0")
        })
    };
    let (color, intensity) = (Vec3::from(light.color()), light.intensity() / PI);
    let range = light.range().map(f64::from);
    let sensible = color.is_finite() && color.min_element() >= 0.0 && intensity.is_finite() && intensity >= 0.0;
    if !sensible || range.is_some_and(|r| !(r > 0.0 && r.is_finite())) {
        return Err(file.error(part, "its colour, intensity or range is negative or not finite"));
    }
    let shape = match light.kind() {
        Kind::Directional => LightShape::Directional { direction: aimed()?, angle_deg: 0.0 },
        Kind::Point => LightShape::Point { position },
        Kind::Spot { inner_cone_angle, outer_cone_angle } => {
            let [inner, outer] = [inner_cone_angle, outer_cone_angle].map(|a| f64::from(a).to_degrees());
            if !(0.0 <= inner && inner <= outer && outer > 0.0 && outer <= 90.1) {
                return Err(file.error(part, format!("its cone has half angles of {inner} and {outer} degrees")));
            }
            let direction = aimed()?;
            if outer > WIDEST_CONE {
                file.note(format!("{part} shines into a half-space: its cone was narrowed to {WIDEST_CONE} degrees"));
            }
            LightShape::Spot {
                position,
                direction,
                inner_angle_deg: inner.min(WIDEST_CONE),
                outer_angle_deg: outer.min(WIDEST_CONE),
            }
        }
    };
    let falls = !matches!(shape, LightShape::Directional { .. });
    let attenuation = if falls { Vec3::Z } else { Vec3::X };
    model.lights.push(Light { color, intensity, attenuation, range, ..Light::new(shape) });
    Ok(())
}

/// Where an axis of the node points.
fn direction(model_from_node: DAffine3, axis: DVec3) -> Option<DVec3> {
    model_from_node.transform_vector3(axis).try_normalize()
}
