//! Permalinks, and states as commands and as Rust.

use crate::state::{COMPARED, Layout, PaneState, State};
use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde::{Deserialize, Serialize};
use umbrage_core::{Camera, Scene};
use umbrage_report::{CameraPath, LIGHT_SAMPLES, Moving, RAY_TRACED};

/// The version that this program writes.
const VERSION: u32 = 1;

/// What is written: what the scene has is left out.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Written {
    scene: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    change: String,
    #[serde(skip_serializing_if = "is_default")]
    time: f64,
    #[serde(skip_serializing_if = "is_default")]
    moving: Moving,
    #[serde(skip_serializing_if = "is_default")]
    path: Option<CameraPath>,
    #[serde(skip_serializing_if = "is_default")]
    frame: u32,
    light: Option<usize>,
    panes: Vec<PaneState>,
    #[serde(skip_serializing_if = "is_default")]
    layout: Layout,
    split: Option<f32>,
    gain: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f32; 2]>,
    #[serde(skip_serializing_if = "String::is_empty")]
    observer: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    divisor: Option<u32>,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A state that was read, before its scene is open.
#[derive(Clone, Debug, PartialEq)]
pub struct Linked {
    /// The state; camera and lights are still those of no scene.
    state: State,
    change: String,
    observer: String,
}

/// The text that [`read`] makes this state of; `scene` is the one that it changes.
pub fn write(state: &State, scene: &Scene) -> String {
    let written = Written {
        scene: state.scene.clone(),
        change: change(state, scene),
        time: state.time_s,
        moving: state.moving,
        path: state.path,
        frame: state.frame,
        light: state.light,
        panes: state.panes.clone(),
        layout: state.layout,
        split: Some(state.split),
        gain: Some(state.gain),
        range: state.range,
        observer: state.observer.as_ref().map(|eye| umbrage_io::changes(Some(eye), &[])).unwrap_or_default(),
        divisor: state.divisor,
    };
    // Numbers and texts can always be written.
    let json = serde_json::to_vec(&written).unwrap_or_default();
    format!("{VERSION}.{}", BASE64_URL_SAFE_NO_PAD.encode(json))
}

/// What of the camera and the lights is not as in `scene`, in the words of the scene format.
pub fn change(state: &State, scene: &Scene) -> String {
    let camera = (state.camera != scene.camera).then_some(&state.camera);
    let differs = |(number, light): &(usize, _)| scene.lights.get(*number) != Some(*light);
    let lights: Vec<_> = state.lights.iter().enumerate().filter(differs).collect();
    umbrage_io::changes(camera, &lights)
}

/// Reads a permalink, or an address that ends in `#` and one.
///
/// # Errors
/// A sentence: what is no permalink, one of a newer version, values out of range.
pub fn read(text: &str) -> Result<Linked, String> {
    let text = text.rsplit('#').next().unwrap_or_default().trim();
    let broken = || "this is no permalink of the laboratory: copy it anew, with all of its characters".to_string();
    let (version, coded) = text.split_once('.').ok_or_else(broken)?;
    match version.parse::<u32>() {
        Ok(VERSION) => {}
        Ok(newer) if newer > VERSION => {
            return Err(format!("this permalink is of version {newer}, and this program reads {VERSION}: update it"));
        }
        _ => return Err(broken()),
    }
    let json = BASE64_URL_SAFE_NO_PAD.decode(coded).map_err(|_| broken())?;
    let written: Written = serde_json::from_slice(&json).map_err(|_| broken())?;
    let default = State::default();
    let in_range = |value: Option<f32>, range: [f32; 2], usual: f32, name: &str| match value {
        None => Ok(usual),
        Some(value) if (range[0]..=range[1]).contains(&value) => Ok(value),
        Some(value) => Err(format!("in this permalink `{name}` is {value} and not in {} to {}", range[0], range[1])),
    };
    if !(1..=4).contains(&written.panes.len()) {
        return Err(format!("this permalink has {} panes; there can be 1 to 4", written.panes.len()));
    }
    let state = State {
        scene: written.scene,
        time_s: if written.time.is_finite() { written.time } else { 0.0 },
        moving: written.moving,
        path: written.path,
        frame: written.frame,
        light: written.light,
        panes: written.panes,
        layout: written.layout,
        split: in_range(written.split, [0.0, 1.0], default.split, "split")?,
        gain: in_range(written.gain, crate::GAINS, default.gain, "gain")?,
        range: written.range.filter(|[low, high]| low < high),
        divisor: written.divisor.map(|d| d.clamp(1, crate::LARGEST_DIVISOR)),
        ..default
    };
    Ok(Linked { state, change: written.change, observer: written.observer })
}

impl Linked {
    /// The scene that it is of.
    pub fn scene(&self) -> &str {
        &self.state.scene
    }

    /// The state, now that its scene is open.
    ///
    /// # Errors
    /// A light that the scene does not have, a camera or lights that can't be.
    pub fn of(self, scene: &Scene) -> Result<State, String> {
        let mut changed = Scene { camera: scene.camera.clone(), lights: scene.lights.clone(), ..Scene::default() };
        umbrage_io::change(&mut changed, &self.change).map_err(|e| e.to_string())?;
        let count = changed.lights.len();
        if let Some(light) = self.state.light.filter(|light| *light >= count) {
            return Err(format!("this permalink shows light {light}, and the scene has {count}, counted from 0"));
        }
        let observer = camera_of(&self.observer)?;
        Ok(State { camera: changed.camera, lights: changed.lights, observer, ..self.state })
    }
}

fn camera_of(text: &str) -> Result<Option<Camera>, String> {
    if text.is_empty() {
        return Ok(None);
    }
    let mut scene = Scene::default();
    umbrage_io::change(&mut scene, text).map_err(|e| e.to_string())?;
    Ok(Some(scene.camera))
}

/// The command that takes the picture of a pane, `size` pixels across and down; for pictures of a
/// comparison the command that compares.
pub fn command(state: &State, pane: &PaneState, scene: &Scene, size: (u32, u32), samples: Option<u32>) -> String {
    let is_compared = COMPARED.contains(&pane.picture.as_str());
    let mut words =
        vec![if is_compared { "umbrage compare" } else { "umbrage render" }.to_string(), quoted(&state.scene)];
    if is_compared {
        words.push(format!("--techniques {}", quoted(&pane.technique)));
    } else {
        words.extend(technique(pane));
    }
    if let (true, Some(samples)) = (pane.id() == RAY_TRACED || is_compared, samples) {
        words.push(format!("--samples {samples}"));
    }
    words.extend(state.light.map(|light| format!("--light {light}")));
    words.push(format!("--size {}x{}", size.0, size.1));
    let change = change(state, scene);
    if !change.is_empty() {
        words.push(format!("--change {}", quoted(&change)));
    }
    if state.time_s != 0.0 {
        words.push(format!("--time {:?}", state.time_s));
    }
    if state.moving != Moving::None {
        words.push(format!("--moving {}", state.moving.name()));
    }
    words.extend(state.path.map(|path| format!("--path {}", path.name())));
    if state.frame != 0 {
        words.push(format!("--frame {}", state.frame));
    }
    words.push(match is_compared {
        true => "-o out".into(),
        false => format!("--aov {} -o {}", pane.picture, quoted(&format!("{}.png", name(pane)))),
    });
    words.join(" ")
}

/// The options of `umbrage render` that choose the technique of a pane.
fn technique(pane: &PaneState) -> Vec<String> {
    let mut parts = pane.technique.split(':');
    let id = parts.next().unwrap_or_default();
    let option = |part: &str| match part.split_once('=') {
        Some((LIGHT_SAMPLES, count)) => format!("--light-samples {count}"),
        _ => format!("--set {}", quoted(part)),
    };
    std::iter::once(format!("--technique {id}")).chain(parts.map(option)).collect()
}

/// A name for a file of what a pane shows.
pub fn name(pane: &PaneState) -> String {
    format!("{}-{}", pane.id(), pane.picture)
}

/// For a shell: in single quotes where it has to be.
fn quoted(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=+,".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.into();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// A line of a program that makes the technique of a pane; none makes the truth.
pub fn rust(pane: &PaneState) -> Option<String> {
    let (samples, parts): (Vec<&str>, Vec<&str>) =
        pane.technique.split(':').partition(|part| part.starts_with("light-samples="));
    let parsed = format!("umbrage::parse({:?})?", parts.join(":"));
    let count = samples.last().and_then(|part| part.split_once('=')).map(|(_, count)| count);
    let made = match count {
        Some(count) => format!("umbrage::light_samples(&gpu, &{parsed}, {count})?"),
        None => format!("{parsed}.make(&gpu)?"),
    };
    (pane.id() != RAY_TRACED).then(|| format!("let mut technique = {made};"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::DVec3;
    use umbrage_core::{Light, LightShape};

    fn scene() -> Scene {
        let light = Light::new(LightShape::Point { position: DVec3::Y });
        Scene { lights: vec![light.clone(), light], ..Scene::default() }
    }

    fn state() -> State {
        let Scene { camera, lights, .. } = scene();
        State { camera, lights, ..State::default() }
    }

    fn coded(json: &str) -> String {
        format!("1.{}", BASE64_URL_SAFE_NO_PAD.encode(json))
    }

    #[test]
    fn a_state_comes_back_as_it_was() {
        let mut state = state();
        let again =
            |state: &State| read(&format!("https://a.example/#{}", write(state, &scene()))).unwrap().of(&scene());
        assert_eq!(again(&state).as_ref(), Ok(&state));
        state.camera.eye.x = 1.0 / 3.0;
        state.lights[1].shape = LightShape::Sphere { position: DVec3::ONE, radius: 0.1 };
        state.observer = Some(Camera::default());
        state.panes = vec![PaneState::new("ray-traced"), PaneState::new("pcf:kernel=7")];
        state = State { light: None, layout: Layout::Blink, range: Some([0.0, 2.0]), time_s: 0.5, ..state };
        state = State { moving: Moving::Casters, path: Some(CameraPath::Fly), frame: 17, ..state };
        assert_eq!(again(&state).as_ref(), Ok(&state));
    }

    #[test]
    fn what_is_no_permalink_is_named() {
        let says = |text: &str, says: &str| {
            let error = read(text).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        };
        says("", "no permalink");
        says("1.@@", "no permalink");
        says("99.abc", "version 99");
        says(&coded("{\"panes\": []}"), "0 panes");
        says(&coded(r#"{"gain": -1, "panes": [{"technique": "pcf", "picture": "color"}]}"#), "`gain` is -1");
        let missing = coded(r#"{"light": 7, "panes": [{"technique": "pcf", "picture": "color"}]}"#);
        assert!(read(&missing).unwrap().of(&scene()).unwrap_err().contains("light 7"));
    }

    #[test]
    fn a_command_names_all_that_is_not_as_the_scene_has_it() {
        let mut state = state();
        state.scene = "a room.glb".into();
        state.camera.eye = DVec3::new(0.5, 1.0, 5.0);
        state.time_s = 0.25;
        (state.moving, state.path, state.frame) = (Moving::Lights, Some(CameraPath::Walk), 12);
        let pane = PaneState { technique: "shadow-map:size=512:light-samples=4".into(), picture: "visibility".into() };
        assert_eq!(
            command(&state, &pane, &scene(), (64, 48), None),
            "umbrage render 'a room.glb' --technique shadow-map --set size=512 --light-samples 4 --light 0 --size 64x48 \
             --change 'camera = { eye = [0.5, 1.0, 5.0], target = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0], \
             fov_y = 45.0, near = 0.05 }' --time 0.25 --moving lights --path walk --frame 12 --aov visibility \
             -o shadow-map-visibility.png"
        );
        let error = PaneState { picture: "error".into(), ..PaneState::new("pcf:kernel=7") };
        let expected =
            "umbrage compare 'a room.glb' --techniques pcf:kernel=7 --samples 64 --light 0 --size 64x48 --change";
        assert!(command(&state, &error, &scene(), (64, 48), Some(64)).starts_with(expected));
        assert_eq!(quoted("it's"), r"'it'\''s'");
        let made = "let mut technique = umbrage::light_samples(&gpu, &umbrage::parse(\"shadow-map:size=512\")?, 4)?;";
        assert_eq!(rust(&pane).as_deref(), Some(made));
        assert_eq!(
            rust(&PaneState::new("pcf")).as_deref(),
            Some("let mut technique = umbrage::parse(\"pcf\")?.make(&gpu)?;")
        );
        assert_eq!(rust(&PaneState::new("ray-traced")), None);
    }
}
