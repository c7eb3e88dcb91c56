//! Which scene is shown: opened by name, by permalink, or dropped on the window.

use super::{Lab, SCENE_FILES};
use crate::link;
use crate::pace::Pace;
use crate::pane::Pane;
use crate::stage::{Opened, Opening, Stage};
use crate::state::State;
use eframe::egui;
use umbrage_report::Source;

impl Lab {
    /// Opens a scene, as users name it.
    pub fn open(&mut self, name: &str) {
        let asked = name.to_string();
        self.opening = Some(Opening::start(name, move || Source::open(&asked).map_err(|e| e.to_string())));
    }

    /// Goes where a permalink leads.
    ///
    /// # Errors
    /// A sentence: it is none.
    pub fn follow(&mut self, link: &str) -> Result<(), String> {
        let linked = link::read(link)?;
        let scene = linked.scene().to_string();
        self.linked = Some(linked);
        match &self.stage {
            Some(stage) if stage.source.asked == scene => self.take_link(),
            _ => self.open(&scene),
        }
        Ok(())
    }

    fn take_link(&mut self) {
        let (Some(linked), Some(stage)) = (self.linked.take(), &self.stage) else { return };
        match linked.of(&stage.source.scene) {
            Ok(state) => self.state = state,
            Err(error) => self.face.say(error),
        }
    }

    /// Opens the scene among files that were dropped together.
    pub(super) fn open_dropped(&mut self, files: Vec<egui::DroppedFileHandle>) {
        let name = |file: &egui::DroppedFileHandle| file.path().display().to_string();
        let is_scene = |name: &String| SCENE_FILES.iter().any(|end| name.to_lowercase().ends_with(end));
        let names: Vec<String> = files.iter().map(name).collect();
        let Some(scene) = names.iter().find(|name| is_scene(name)) else {
            let known = SCENE_FILES.join(", ");
            self.face.say(format!("{}: not a scene; scenes are files of {known}", names.join(", ")));
            return;
        };
        #[cfg(not(target_family = "wasm"))]
        self.open(scene);
        #[cfg(target_family = "wasm")]
        {
            let scene = scene.clone();
            let read = async move {
                let mut bytes = umbrage_io::Bytes::new();
                for (name, file) in names.into_iter().zip(files) {
                    bytes.insert(name, file.bytes_async().await?);
                }
                Ok((scene, bytes))
            };
            // What is there at once comes with the next frame, too.
            let _ = self.dropped.ask(read);
        }
    }

    /// Opens what was dropped, now that it is read.
    #[cfg(target_family = "wasm")]
    pub(super) fn take_dropped(&mut self) {
        match self.dropped.take() {
            Some(Ok((name, bytes))) => {
                let asked = name.clone();
                let open = move || Source::open_bytes(&name, &bytes).map_err(|e| e.to_string());
                self.opening = Some(Opening::start(&asked, open));
            }
            Some(Err(error)) => self.face.say(error),
            None => {}
        }
    }

    pub(super) fn take_opened(&mut self) {
        loop {
            match self.opening.as_ref().map(Opening::take) {
                None | Some(Ok(None)) => return,
                Some(Err(())) => self.opening = None,
                Some(Ok(Some(Opened::Tracer(tracer)))) => {
                    if let Some(stage) = &mut self.stage {
                        stage.take_tracer(tracer);
                    }
                }
                Some(Ok(Some(Opened::Scene(source)))) => {
                    if let Err(error) = source.and_then(|source| self.enter(source)) {
                        self.face.say(error);
                        self.opening = None;
                        self.linked = None;
                    }
                }
            }
        }
    }

    /// Shows another scene from now on.
    fn enter(&mut self, source: Source) -> Result<(), String> {
        source.lights(None, &[umbrage::Answer::Visibility]).map_err(|e| e.to_string())?;
        let size = self.panes.first().map_or((64, 48), Pane::size);
        source.notes.iter().for_each(|note| self.face.say(note.clone()));
        let stage = Stage::new(&self.gpu, source, size)?;
        self.panes.iter_mut().for_each(Pane::forget);
        self.stage_version += 1;
        self.face.see.mark = None;
        self.pace = Pace::default();
        self.truth.want(None);
        let scene = &stage.source.scene;
        self.state = State {
            scene: stage.source.asked.clone(),
            camera: scene.camera.clone(),
            lights: scene.lights.clone(),
            time_s: 0.0,
            frame: 0,
            light: Some(0),
            observer: None,
            ..self.state.clone()
        };
        self.stage = Some(stage);
        self.take_link();
        Ok(())
    }
}
