//! Changes of a scene in the words of the scene format: another camera, lights in the place of
//! others.

use super::environment;
use super::light::Lights;
use super::read_camera;
use super::reader::{Source, Table};
use crate::Error;
use crate::files::Files;
use glam::{DVec2, DVec3, EulerRot, Vec3};
use std::fmt::Write;
use std::path::Path;
use toml::de::DeTable;
use umbrage_core::{Camera, Light, LightShape, Scene};

/// What errors call the text.
const NAME: &str = "the change of the scene";

/// Changes `scene` by a text with tables of the scene format: `camera` takes the place of the
/// scene's, and each table of `light` that of the light whose number stands in its key `number`. A
/// light may have one number more than the last, which adds it. The texture of a `rect` stays where
/// the light had one. A table `environment` turns the scene's, or changes its intensity.
///
/// # Errors
/// Whatever is wrong with the text; the scene is then as it was.
pub fn change(scene: &mut Scene, toml_text: &str) -> Result<(), Error> {
    let source = Source { file: Path::new(NAME), text: toml_text };
    let document = DeTable::parse(toml_text).map_err(|e| {
        let end = toml_text.len()..toml_text.len();
        source.error(e.span().unwrap_or(end), format!("is not valid TOML: {}", e.message()))
    })?;
    let root = Table::new(source, "change", 0..0, document.get_ref());
    root.check_keys(&[&["camera", "light", "environment"]])?;
    let mut changed = Scene { lights: scene.lights.clone(), ..Scene::default() };
    let camera = root.get("camera").map(|c| read_camera(&c.table()?)).transpose()?;
    if let Some(tables) = root.get("light") {
        for table in tables.tables()? {
            read_light(&mut changed, &table)?;
        }
    }
    let environment = scene.environment.as_ref();
    if let Some(table) = root.get("environment") {
        scene.environment = Some(environment::change(environment, &table.table()?)?);
    }
    scene.lights = changed.lights;
    scene.camera = camera.unwrap_or_else(|| scene.camera.clone());
    Ok(())
}

fn read_light(scene: &mut Scene, table: &Table<'_>) -> Result<(), Error> {
    let number = table.require("number")?;
    let (index, count) = (number.number()?, scene.lights.len());
    if index.fract() != 0.0 || !(0.0..=count as f64).contains(&index) {
        return Err(number.error(format!("is {index}; the scene has {count} lights, counted from 0")));
    }
    let mut light = Lights::new(Files::OnDisk, Path::new("")).read_with(scene, table, &["number"])?;
    let index = index as usize;
    match scene.lights.get_mut(index) {
        Some(old) => {
            if let (LightShape::Rect { texture: new, .. }, LightShape::Rect { texture, .. }) =
                (&mut light.shape, &old.shape)
            {
                *new = new.or(*texture);
            }
            *old = light;
        }
        None => scene.lights.push(light),
    }
    Ok(())
}

/// The text that [`change`]s a scene of this `camera` and these `lights`, each with its number; on
/// one line, every number to its last bit. An empty text where there are none.
pub fn changes(camera: Option<&Camera>, lights: &[(usize, &Light)]) -> String {
    let mut text = camera.map(|camera| format!("camera = {}", camera_table(camera))).unwrap_or_default();
    let mut tables = Vec::new();
    let mut line = |start: &str, rest: String| {
        let between = if text.is_empty() { "" } else { "\n" };
        // Writing to a text does not fail.
        let _ = write!(text, "{between}{start}{rest}");
    };
    for (number, light) in lights {
        match &light.shape {
            LightShape::Environment(e) => {
                line("environment = ", format!("{{ rotate = {:?}, intensity = {:?} }}", e.rotate_deg, e.intensity));
            }
            shape => tables.push(light_table(*number, light, shape)),
        }
    }
    if !tables.is_empty() {
        line("light = ", format!("[{}]", tables.join(", ")));
    }
    text
}

fn camera_table(camera: &Camera) -> String {
    let [eye, target, up] = [camera.eye, camera.target, camera.up].map(vec3);
    let near = camera.near;
    let rest = match camera.parallel {
        Some(parallel) => format!("height = {:?}, near = {near:?}, far = {:?}", parallel.height, parallel.far),
        None => format!("fov_y = {:?}, near = {near:?}", camera.fov_y_deg),
    };
    format!("{{ eye = {eye}, target = {target}, up = {up}, {rest} }}")
}

fn light_table(number: usize, light: &Light, shape: &LightShape) -> String {
    let default = Light::new(shape.clone());
    let mut text = format!("{{ number = {number}, {}", shape_keys(shape));
    let mut key = |name: &str, value: String, differs: bool| {
        if differs {
            text += &format!(", {name} = {value}");
        }
    };
    key("color", vec3_f32(light.color), light.color != default.color);
    key("intensity", format!("{:?}", light.intensity), light.intensity != default.intensity);
    key("attenuation", vec3_f32(light.attenuation), light.attenuation != default.attenuation);
    key("range", format!("{:?}", light.range.unwrap_or_default()), light.range.is_some());
    key("casts", light.casts.to_string(), !light.casts);
    text + " }"
}

fn shape_keys(shape: &LightShape) -> String {
    let place = |position: &DVec3| format!("position = {}", vec3(*position));
    let aimed = |position: &DVec3, direction: &DVec3| format!("{}, direction = {}", place(position), vec3(*direction));
    match shape {
        LightShape::Point { position } => format!("kind = \"point\", {}", place(position)),
        LightShape::Spot { position, direction, inner_angle_deg: inner, outer_angle_deg: outer } => {
            let aimed = aimed(position, direction);
            format!("kind = \"spot\", {aimed}, inner_angle = {inner:?}, outer_angle = {outer:?}")
        }
        LightShape::Directional { direction, angle_deg } => {
            format!("kind = \"directional\", direction = {}, angle = {angle_deg:?}", vec3(*direction))
        }
        LightShape::Sphere { position, radius } => {
            format!("kind = \"sphere\", {}, radius = {radius:?}", place(position))
        }
        LightShape::Ellipsoid { position, radii, rotation } => {
            let (z, y, x) = rotation.to_euler(EulerRot::ZYX);
            let angles = DVec3::new(x, y, z).map(f64::to_degrees);
            format!("kind = \"ellipsoid\", {}, radii = {}, rotate = {}", place(position), vec3(*radii), vec3(angles))
        }
        LightShape::Disc { position, direction, radius } => {
            format!("kind = \"disc\", {}, radius = {radius:?}", aimed(position, direction))
        }
        LightShape::Rect { position, direction, up, size: DVec2 { x, y }, .. } => {
            format!("kind = \"rect\", {}, up = {}, size = [{x:?}, {y:?}]", aimed(position, direction), vec3(*up))
        }
        LightShape::Line { from, to } => format!("kind = \"line\", from = {}, to = {}", vec3(*from), vec3(*to)),
        // It has a table of its own.
        LightShape::Environment(_) => "kind = \"environment\"".to_owned(),
    }
}

fn vec3(v: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

fn vec3_f32(v: Vec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::light::rotation;
    use glam::DMat3;

    fn shapes() -> Vec<LightShape> {
        let (position, direction) = (DVec3::new(0.1, 2.0, -1e-9), DVec3::new(0.6, -0.8, 0.0));
        vec![
            LightShape::Point { position },
            LightShape::Spot { position, direction, inner_angle_deg: 12.5, outer_angle_deg: 30.1 },
            LightShape::Directional { direction, angle_deg: 0.53 },
            LightShape::Sphere { position, radius: 0.3 },
            LightShape::Ellipsoid { position, radii: DVec3::new(0.1, 0.2, 0.3), rotation: DMat3::IDENTITY },
            LightShape::Disc { position, direction, radius: 0.25 },
            LightShape::Rect { position, direction, up: DVec3::Z, size: DVec2::new(1.0, 2.5), texture: None },
            LightShape::Line { from: position, to: direction },
        ]
    }

    #[test]
    fn what_is_written_is_read_to_the_last_bit() {
        let (eye, target) = (DVec3::new(1.0 / 3.0, 2e7, -0.1), DVec3::new(7e5, 0.0, 1e-3));
        let camera = Camera { eye, target, fov_y_deg: 33.3, ..Camera::default() };
        for shape in shapes() {
            let light = Light { intensity: 0.1, range: Some(7.7), casts: false, ..Light::new(shape) };
            let mut scene =
                Scene { lights: vec![Light::new(LightShape::Point { position: DVec3::Y })], ..Scene::default() };
            change(&mut scene, &changes(Some(&camera), &[(0, &light)])).unwrap();
            assert_eq!((&scene.camera, &scene.lights), (&camera, &vec![light]));
        }
    }

    #[test]
    fn parallel_lines_of_sight_are_kept() {
        let camera = Camera::default().with_parallel(4.0, -3.0, 20.0);
        let mut scene = Scene::default();
        change(&mut scene, &changes(Some(&camera), &[])).unwrap();
        assert_eq!(scene.camera, camera);
    }

    #[test]
    fn a_turned_ellipsoid_is_turned_as_before() {
        let rotation = rotation(DVec3::new(20.0, -35.0, 70.0));
        let light = Light::new(LightShape::Ellipsoid { position: DVec3::ZERO, radii: DVec3::ONE, rotation });
        let mut scene = Scene::default();
        change(&mut scene, &changes(None, &[(0, &light)])).unwrap();
        let LightShape::Ellipsoid { rotation: read, .. } = scene.lights[0].shape else { panic!("another kind") };
        assert!(read.abs_diff_eq(rotation, 1e-15), "{read}");
    }

    #[test]
    fn a_wrong_change_changes_nothing_and_says_what_is_wrong() {
        let light = Light::new(LightShape::Point { position: DVec3::Y });
        let mut scene = Scene { lights: vec![light], ..Scene::default() };
        for (text, says) in [
            ("light = [{ number = 2, kind = \"point\", position = [0, 0, 0] }]", "has 1 lights"),
            ("light = [{ number = 0.5, kind = \"point\", position = [0, 0, 0] }]", "0.5"),
            ("light = [{ kind = \"point\", position = [0, 0, 0] }]", "number"),
            ("camera = { eye = [0, 0, 0], target = [0, 0, 0], fov_y = 45 }", "looks nowhere"),
            ("lamp = 3", "unknown key `lamp`"),
            ("camera = ", "not valid TOML"),
        ] {
            let before = scene.clone();
            let error = change(&mut scene, text).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
            assert!(scene.lights == before.lights && scene.camera == before.camera, "{text}");
        }
    }

    #[test]
    fn no_change_is_no_text() {
        assert_eq!(changes(None, &[]), "");
    }
}
