//! Lights: Bevy's components as umbrage and the shader see them.

use crate::convert;
use bevy::ecs::entity::EntityHashSet;
use bevy::ecs::lifecycle::Remove;
use bevy::light::SunDisk;
use bevy::pbr::{ExtractedDirectionalLight, ExtractedPointLight};
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::sync_world::MainEntity;
use std::f32::consts::{FRAC_PI_2, PI};
use umbrage::core::{Light, LightShape};
use umbrage::techniques::pcf::Pcf;
use umbrage::{Configure, Settings};

/// The technique that finds the shadows of the `DirectionalLight`, `PointLight` or `SpotLight` of
/// the same entity. What that component says of shadow maps does not count.
///
/// A `SunDisk` gives a directional light its angle, `radius` makes a point light a sphere and a
/// spot light a disc: techniques for soft shadows go by these, others take the middle.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct UmbrageLight {
    /// The technique with its settings.
    pub technique: Settings,
}

impl Default for UmbrageLight {
    fn default() -> Self {
        Pcf::default().into()
    }
}

impl<T: Configure> From<T> for UmbrageLight {
    fn from(technique: T) -> Self {
        Self { technique: technique.into() }
    }
}

impl UmbrageLight {
    /// From a technique's id and settings, such as `pcss:samples=32`.
    ///
    /// # Errors
    /// As [`umbrage::parse`]: names what is unknown and the nearest that there is.
    pub fn parse(text: &str) -> Result<Self, umbrage::Error> {
        Ok(Self { technique: umbrage::parse(text)? })
    }
}

/// What light a light gives off, as the shader needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Lux of a directional light, candela of others, linear RGB.
    pub color: Vec3,
    /// Of the sphere that highlights show.
    pub radius: f32,
    /// Metres; beyond there is no light.
    pub range: f32,
    /// Factor and summand that make the strength of the cosine to a spot's axis; 0 and 1 for
    /// others.
    pub cone: [f32; 2],
}

/// A light that umbrage does.
#[derive(Clone, Debug)]
pub struct UmbrageLightInWorld {
    /// In the main world.
    pub entity: Entity,
    pub technique: Settings,
    pub light: Light,
    pub emission: Emission,
}

/// The lights of this frame, and who sees them.
#[derive(Resource, Default)]
pub struct Lights {
    pub lights: Vec<UmbrageLightInWorld>,
    pub cameras: EntityHashSet,
}

impl Lights {
    /// Where in the list a light of the main world is.
    pub fn position(&self, entity: Entity) -> Option<usize> {
        self.lights.binary_search_by_key(&entity, |light| light.entity).ok()
    }
}

type Kinds<'a> = (Option<(&'a DirectionalLight, Option<&'a SunDisk>)>, Option<&'a PointLight>, Option<&'a SpotLight>);

/// Copies all of them, which are few.
pub fn extract(
    mut found: ResMut<Lights>,
    lights: Extract<Query<(Entity, &UmbrageLight, &GlobalTransform, &InheritedVisibility, Kinds)>>,
    cameras: Extract<Query<Entity, With<crate::UmbrageCamera>>>,
) {
    found.cameras = cameras.iter().collect();
    found.lights.clear();
    for (entity, UmbrageLight { technique }, transform, visible, (sun, point, spot)) in &lights {
        if !visible.get() {
            continue;
        }
        let seen = match (sun, point, spot) {
            (Some((light, disk)), ..) => directional(light, disk, transform),
            (_, Some(light), _) => of_point(light, transform),
            (.., Some(light)) => of_spot(light, transform),
            _ => continue,
        };
        let (light, emission) = seen;
        let technique = technique.clone();
        found.lights.push(UmbrageLightInWorld { entity, technique, light, emission });
    }
    found.lights.sort_by_key(|light| light.entity);
}

fn directional(light: &DirectionalLight, disk: Option<&SunDisk>, place: &GlobalTransform) -> (Light, Emission) {
    let direction = convert::vector(place.forward().as_vec3());
    let angle_deg = disk.map_or(0.0, |disk| f64::from(disk.angular_size).to_degrees());
    let color = rgb(light.color, light.illuminance);
    let emission = Emission { color, radius: 0.0, range: f32::INFINITY, cone: [0.0, 1.0] };
    (Light::new(LightShape::Directional { direction, angle_deg }), emission)
}

fn of_point(light: &PointLight, place: &GlobalTransform) -> (Light, Emission) {
    let PointLight { color, intensity, range, radius, .. } = *light;
    let position = convert::vector(place.translation());
    let shape = match radius {
        0.0 => LightShape::Point { position },
        _ => LightShape::Sphere { position, radius: radius.into() },
    };
    let emission = Emission { color: candela(color, intensity), radius, range, cone: [0.0, 1.0] };
    (Light { range: Some(range.into()), ..Light::new(shape) }, emission)
}

fn of_spot(light: &SpotLight, place: &GlobalTransform) -> (Light, Emission) {
    let SpotLight { color, intensity, range, radius, .. } = *light;
    let position = convert::vector(place.translation());
    let direction = convert::vector(place.forward().as_vec3());
    // As Bevy clamps them.
    let outer = light.outer_angle.min(FRAC_PI_2 - 1e-4);
    let inner = light.inner_angle.min(outer);
    let shape = match radius {
        0.0 => LightShape::Spot {
            position,
            direction,
            inner_angle_deg: f64::from(inner).to_degrees(),
            outer_angle_deg: f64::from(outer).to_degrees(),
        },
        _ => LightShape::Disc { position, direction, radius: radius.into() },
    };
    let factor = 1.0 / (inner.cos() - outer.cos()).max(1e-4);
    let cone = [factor, -outer.cos() * factor];
    let emission = Emission { color: candela(color, intensity), radius, range, cone };
    (Light { range: Some(range.into()), ..Light::new(shape) }, emission)
}

/// Bevy gives lumens over the whole sphere, for spots too.
fn candela(color: Color, lumen: f32) -> Vec3 {
    rgb(color, lumen / (4.0 * PI))
}

fn rgb(color: Color, strength: f32) -> Vec3 {
    color.to_linear().to_vec3() * strength
}

/// Has Bevy do nothing with the lights that umbrage does: in the render world alone, so that
/// whoever reads the components finds what was written there.
pub fn take_over(
    lights: Res<Lights>,
    mut points: Query<(&MainEntity, &mut ExtractedPointLight)>,
    mut suns: Query<(&MainEntity, &mut ExtractedDirectionalLight)>,
) {
    let ours = |entity: &MainEntity| lights.position(entity.id()).is_some();
    for (entity, mut light) in &mut points {
        if ours(entity) && (light.intensity != 0.0 || light.shadow_maps_enabled) {
            (light.intensity, light.shadow_maps_enabled) = (0.0, false);
        }
    }
    for (entity, mut light) in &mut suns {
        if ours(entity) && (light.illuminance != 0.0 || light.shadow_maps_enabled) {
            (light.illuminance, light.shadow_maps_enabled) = (0.0, false);
        }
    }
}

/// Has Bevy look at a light again that umbrage no longer does.
pub fn give_back(
    removed: On<Remove<UmbrageLight>>,
    mut lights: Query<AnyOf<(&mut DirectionalLight, &mut PointLight, &mut SpotLight)>>,
) {
    let Ok((sun, point, spot)) = lights.get_mut(removed.entity) else { return };
    sun.into_iter().for_each(|mut light| light.set_changed());
    point.into_iter().for_each(|mut light| light.set_changed());
    spot.into_iter().for_each(|mut light| light.set_changed());
}
