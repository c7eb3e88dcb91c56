//! How far pictures are from one whose visibility was traced.

use crate::stage::{Picture, Shadows, Source, Stage};
use bevy::prelude::*;
use bevy_umbrage::umbrage::core::glam::DVec3;
use bevy_umbrage::umbrage::core::{Camera, Light, LightShape};
use bevy_umbrage::{convert, export};
use std::path::Path;
use umbrage_reference::{Options, Tracer};

/// Prints, for each picture, the root of the mean square of its difference in luminance from the
/// true picture, which is written too: all light but that of sun and lamp, and what each of these
/// adds without shadows, times the share of it that rays find visible.
pub fn compare(stage: &mut Stage, samples: u32, pictures: &[(Shadows, Picture)], out: &Path) -> Result {
    let truth = picture(stage, samples)?;
    truth.save(&out.with_file_name("fox-truth.png"))?;
    for (kind, picture) in pictures {
        println!("{kind}: error of luminance {:.5}", error(picture, &truth));
    }
    Ok(())
}

/// The root of the mean square of the difference in luminance.
pub fn error(picture: &Picture, truth: &Picture) -> f32 {
    let (a, b) = (picture.luminance(), truth.luminance());
    let sum: f32 = a.iter().zip(&b).map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / a.len() as f32).sqrt()
}

/// The present moment with traced shadows.
pub fn picture(stage: &mut Stage, samples: u32) -> Result<Picture> {
    stage.choose(Shadows::None);
    stage.light_only(&[]);
    let mut truth = stage.look()?;
    let dark = truth.clone();
    let scene = export::scene(stage.world())?;
    let camera = camera(stage)?;
    let (width, height) = stage.size;
    let tracer = Tracer::new(&scene);
    let geometry = tracer.geometry(&camera, width, height);
    let options = Options { samples, ..Default::default() };
    for (source, light) in [(Source::Sun, sun(stage)?), (Source::Lamp, lamp(stage)?)] {
        stage.light_only(&[source]);
        let lit = stage.look()?;
        let seen = tracer.visibility(&geometry, &light, &[], &options, &|_, _| ()).visibility;
        for (i, sum) in truth.pixels.iter_mut().enumerate() {
            let visible = if geometry.receives.data[i] { seen.data[i] } else { 1.0 };
            *sum += (lit.pixels[i] - dark.pixels[i]) * visible;
        }
    }
    stage.light_only(&[Source::Sun, Source::Lamp]);
    Ok(truth)
}

fn camera(stage: &mut Stage) -> Result<Camera> {
    let camera = stage.camera;
    let world = stage.world();
    let place = world.get::<GlobalTransform>(camera).ok_or("the camera has no place")?;
    let Some(Projection::Perspective(lens)) = world.get::<Projection>(camera) else {
        return Err("the camera has no perspective".into());
    };
    let eye = convert::vector(place.translation());
    Ok(Camera {
        eye,
        target: eye + convert::vector(place.forward().as_vec3()),
        up: DVec3::Y,
        fov_y_deg: f64::from(lens.fov).to_degrees(),
        near: lens.near.into(),
        ..Default::default()
    })
}

fn sun(stage: &mut Stage) -> Result<Light> {
    let sun = stage.sun;
    let place = stage.world().get::<GlobalTransform>(sun).ok_or("the sun has no place")?;
    let direction = convert::vector(place.forward().as_vec3());
    let disk = stage.world().get::<bevy::light::SunDisk>(sun).map_or(0.0, |disk| disk.angular_size);
    Ok(Light::new(LightShape::Directional { direction, angle_deg: f64::from(disk).to_degrees() }))
}

fn lamp(stage: &mut Stage) -> Result<Light> {
    let lamp = stage.lamp;
    let position = stage.world().get::<GlobalTransform>(lamp).ok_or("the lamp has no place")?.translation();
    let radius = stage.world().get::<PointLight>(lamp).map_or(0.0, |lamp| lamp.radius);
    Ok(Light::new(LightShape::Sphere { position: convert::vector(position), radius: radius.into() }))
}
