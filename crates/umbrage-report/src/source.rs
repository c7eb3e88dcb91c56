//! Scenes as users name them: a built-in one, with its detail, or a file.

use crate::error::Error;
use crate::motion::{Motion, Moving};
use crate::path::CameraPath;
use std::{borrow::Cow, path::Path};
use umbrage::Answer;
use umbrage_core::{Light, LightKind, Scene, scenes};

/// A scene and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Source {
    /// The name or path as given.
    pub asked: String,
    /// The scene, with at least one triangle and one light.
    pub scene: Scene,
    /// What the loader made up or left out, and what single precision cannot tell apart.
    pub notes: Vec<String>,
}

/// Extensions of files that are scenes.
const EXTENSIONS: [&str; 4] = ["toml", "obj", "gltf", "glb"];

impl Source {
    /// Opens the built-in scene `name`, `name:detail`, or a file.
    ///
    /// # Errors
    /// A name that is neither, with the nearest one; whatever is wrong with the file.
    pub fn open(asked: &str) -> Result<Self, Error> {
        let path = Path::new(asked);
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let is_file = path.is_file() || EXTENSIONS.contains(&extension.as_str()) || asked.contains(['/', '\\']);
        let (scene, mut notes) = if is_file {
            let opened = umbrage_io::open(path)?;
            (opened.scene, opened.notes)
        } else {
            (built_in(asked)?, Vec::new())
        };
        notes.extend(umbrage_core::precision::notes(&scene));
        Ok(Self { asked: asked.into(), scene, notes })
    }

    /// Opens the file `name`, one of `files`, which are at hand: dropped on a window or a page.
    ///
    /// # Errors
    /// As [`umbrage_io::open_bytes`].
    pub fn open_bytes(name: &str, files: &umbrage_io::Bytes) -> Result<Self, Error> {
        let umbrage_io::Opened { scene, mut notes } = umbrage_io::open_bytes(name, files)?;
        notes.extend(umbrage_core::precision::notes(&scene));
        Ok(Self { asked: name.into(), scene, notes })
    }

    /// The same with another camera or other lights, see [`umbrage_io::change`], and every
    /// animation moved on by `time_s` seconds.
    ///
    /// # Errors
    /// Whatever is wrong with the text of the change.
    pub fn changed(mut self, change: Option<&str>, time_s: f64) -> Result<Self, Error> {
        if let Some(text) = change {
            umbrage_io::change(&mut self.scene, text)?;
        }
        self.scene.advance(time_s);
        Ok(self)
    }

    /// The same in frame `frame` of a motion and of a way of the camera, for pictures `height`
    /// pixels high.
    #[must_use]
    pub fn moved(mut self, moving: Moving, path: Option<CameraPath>, frame: u32, height: u32) -> Self {
        Motion::new(moving, &self.scene).apply_to(&mut self.scene, frame);
        if let Some(path) = path {
            self.scene.camera = path.camera(&self.scene.camera, frame, height);
        }
        self
    }

    /// The light of this number, see [`Scene::numbered_lights`].
    ///
    /// # Errors
    /// A number that the scene does not have.
    pub fn light(&self, number: usize) -> Result<Cow<'_, Light>, Error> {
        self.scene.light(number).ok_or_else(|| {
            let why = match self.scene.numbered_lights().count() {
                0 => "there is no light in it; add one".to_string(),
                1 => format!("there is no light {number}; its one light is 0"),
                n => format!("there is no light {number}; its lights are 0 to {}", n - 1),
            };
            Error::scene(&self.asked, why)
        })
    }

    /// The numbers of the lights to work on: the one asked for, or all for which techniques have
    /// one of these answers.
    ///
    /// # Errors
    /// A number that the scene does not have; no light for such an answer.
    pub fn lights(&self, asked: Option<usize>, answers: &[Answer]) -> Result<Vec<usize>, Error> {
        if let Some(light) = asked {
            return self.light(light).map(|_| vec![light]);
        }
        let answer = |light: &Light| match light.shape.kind() {
            LightKind::Environment => Answer::Radiance,
            _ => Answer::Visibility,
        };
        let numbered = (0..).zip(self.scene.numbered_lights());
        let lights: Vec<usize> = numbered.filter(|(_, l)| answers.contains(&answer(l))).map(|(i, _)| i).collect();
        if lights.is_empty() {
            self.light(0)?;
            let remedy = match answers {
                [Answer::Radiance] => {
                    "it has no environment, whose answer is radiance; add [environment], such as `color = [1, 1, 1]`"
                }
                _ => {
                    "its only light is the environment, which `render --technique path-traced` and `prt` show; add a \
                     [[light]] for this"
                }
            };
            return Err(Error::scene(&self.asked, remedy));
        }
        Ok(lights)
    }

    /// A light to measure yardsticks under, which answer with visibility: this one, or the first
    /// where it is the environment.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn yardstick_light(&self, number: usize) -> usize {
        if number == self.scene.lights.len() { 0 } else { number }
    }

    /// A name for files: that of the scene file without its extensions, or of the built-in scene.
    pub fn stem(&self) -> String {
        let name = Path::new(&self.asked).file_name().unwrap_or_default().to_string_lossy();
        let end = [".scene.toml", ".toml", ".obj", ".gltf", ".glb"].iter().find_map(|e| name.strip_suffix(e));
        end.unwrap_or(&name).replace(':', "-")
    }
}

fn built_in(asked: &str) -> Result<Scene, Error> {
    let (id, detail) = asked.split_once(':').map_or((asked, None), |(id, detail)| (id, Some(detail)));
    let entry = scenes::find(id).ok_or_else(|| unknown(id))?;
    let detail = match detail {
        None => 1.0,
        Some(text) => text.parse::<f32>().ok().filter(|d| d.is_finite() && *d > 0.0).ok_or_else(|| {
            Error::scene(asked, format!("the detail `{text}` is no number over 0; 1 is normal, such as {id}:0.5"))
        })?,
    };
    Ok((entry.build)(detail))
}

fn unknown(id: &str) -> Error {
    let names = scenes::SCENES.iter().map(|s| s.id);
    Error::Name(match umbrage::nearest(id, names.clone()) {
        Some(name) => format!("unknown scene `{id}`; did you mean `{name}`?"),
        None => format!(
            "unknown scene `{id}`: neither a file (.scene.toml, .gltf, .glb, .obj) nor one of {}",
            names.collect::<Vec<_>>().join(", ")
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(asked: &str) -> String {
        Source::open(asked).map(|s| s.stem()).unwrap_or_else(|e| e.to_string())
    }

    #[test]
    fn built_in_scenes_open_with_a_detail() {
        assert_eq!(text("contact"), "contact");
        assert_eq!(text("city:0.1"), "city-0.1");
        assert!(text("city:NaN").contains("no number over 0"));
    }

    #[test]
    fn what_is_no_scene_is_named() {
        assert!(text("primitivs").contains("did you mean `primitives`"));
        assert!(text("xyzzy").contains("contact, overlap"));
        assert!(text("missing.obj").contains("missing.obj"));
    }

    #[test]
    fn files_that_are_at_hand_open() {
        let model = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec();
        let files = [("a.obj".to_string(), model)].into();
        assert_eq!(Source::open_bytes("a.obj", &files).unwrap().scene.triangle_count(), 1);
        assert!(Source::open_bytes("b.obj", &files).unwrap_err().to_string().contains("b.obj"));
    }

    #[test]
    fn a_file_lends_its_name() {
        let source = Source { asked: "a/b/bunny.scene.toml".into(), scene: Scene::default(), notes: Vec::new() };
        assert_eq!(source.stem(), "bunny");
    }
}
