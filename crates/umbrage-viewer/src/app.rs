//! The laboratory, frame by frame.

use crate::MOST_PANES;
use crate::link::{self, Linked};
use crate::observe::Observe;
use crate::pace::Pace;
use crate::pane::{Pane, Shared};
use crate::show::Show;
use crate::stage::{Opened, Opening, Stage};
use crate::state::{PaneState, State};
use crate::truth::{Truth, Wanted};
use crate::ui::Face;
use crate::undo::Undo;
use crate::yardstick::{Of, Ratios, Yardstick};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use std::sync::{Arc, Mutex, PoisonError};
use umbrage::{Gpu, Owner, Registry};
use umbrage_report::{RAY_TRACED, Source};
use web_time::{Duration, Instant};

/// After which pictures are drawn as fine as one frame can be.
const REST: Duration = Duration::from_millis(600);
/// How names of files end that are scenes.
const SCENE_FILES: [&str; 4] = [".toml", ".gltf", ".glb", ".obj"];

/// What a laboratory starts with.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The scene: a built-in one or a file; the first built-in one where none is named.
    pub scene: Option<String>,
    /// The techniques of the panes, with their settings.
    pub techniques: Vec<String>,
    /// A permalink, in the place of all other options.
    pub state: Option<String>,
    /// The graphics adapter: a part of its name, or `software`.
    pub adapter: Option<String>,
    /// Where snapshots are written; the working directory where none is named.
    pub folder: Option<std::path::PathBuf>,
}

/// The laboratory without a window.
pub struct Lab {
    pub(crate) gpu: Gpu,
    paint: RenderState,
    pub(crate) registry: Registry,
    show: Show,
    observe: Observe,
    pub(crate) state: State,
    pub(crate) undo: Undo,
    pub(crate) stage: Option<Stage>,
    pub(crate) stage_version: u64,
    pub(crate) opening: Option<Opening>,
    /// To be taken over when its scene is open.
    linked: Option<Linked>,
    pub(crate) panes: Vec<Pane>,
    pub(crate) truth: Truth,
    pub(crate) pace: Pace,
    /// What is measured when asked for.
    pub(crate) yardstick: Option<Yardstick>,
    /// What came of it.
    pub(crate) ratios: Option<(Of, Ratios)>,
    /// What is not part of the state: what is chosen, what is open.
    pub(crate) face: Face,
    last_frame: Instant,
    /// The state of the last frame, and since when it is so.
    changed: (Option<State>, Instant),
    /// What the driver has said that nobody asked for.
    trouble: Arc<Mutex<Option<String>>>,
    is_lost: bool,
    #[cfg(target_family = "wasm")]
    dropped: crate::later::Newest<Result<(String, umbrage_io::Bytes), String>>,
    #[cfg(not(target_family = "wasm"))]
    keeping: Option<crate::keep::Keeping>,
    /// Where snapshots go.
    #[cfg(not(target_family = "wasm"))]
    folder: std::path::PathBuf,
}

impl Lab {
    /// Starts in the window, or the test, that `context` is of.
    ///
    /// # Errors
    /// A sentence: there is no device, or the options are wrong.
    pub fn new(context: &eframe::CreationContext<'_>, registry: &Registry, options: &Options) -> Result<Self, String> {
        let paint = context.wgpu_render_state.clone().ok_or("there is no graphics device to draw with")?;
        let gpu = Gpu::new(paint.device.clone(), paint.queue.clone());
        let trouble = Arc::new(Mutex::new(None));
        let reported = trouble.clone();
        paint.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            reported.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.to_string());
        }));
        let mut lab = Self {
            show: Show::new(&gpu),
            observe: Observe::new(&gpu),
            gpu,
            paint,
            registry: registry.clone(),
            state: State::default(),
            undo: Undo::default(),
            stage: None,
            stage_version: 0,
            opening: None,
            linked: None,
            panes: Vec::new(),
            truth: Truth::new(),
            pace: Pace::default(),
            yardstick: None,
            ratios: None,
            face: Face::new(&context.egui_ctx),
            last_frame: Instant::now(),
            changed: (None, Instant::now()),
            trouble,
            is_lost: false,
            #[cfg(target_family = "wasm")]
            dropped: Default::default(),
            #[cfg(not(target_family = "wasm"))]
            keeping: None,
            #[cfg(not(target_family = "wasm"))]
            folder: options.folder.clone().unwrap_or_default(),
        };
        if let Some(link) = &options.state {
            lab.follow(link)?;
        } else {
            let panes = options.techniques.iter().take(MOST_PANES).map(|t| PaneState::new(t));
            let panes: Vec<PaneState> = panes.collect();
            if !panes.is_empty() {
                lab.state.panes = panes;
            }
            let scene = options.scene.clone().unwrap_or_else(|| lab.state.scene.clone());
            lab.open(&scene);
        }
        Ok(lab)
    }

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

    /// One frame: takes over what has come, shows and asks, and draws what has changed.
    pub(crate) fn frame(&mut self, ui: &mut egui::Ui) {
        let now = Instant::now();
        let passed = now.duration_since(self.last_frame).min(Duration::from_millis(250));
        self.last_frame = now;
        self.check(ui.ctx());
        self.poll();
        self.take();
        crate::ui::show(self, ui, passed.as_secs_f64());
        if self.changed.0.as_ref() != Some(&self.state) {
            self.changed = (Some(self.state.clone()), Instant::now());
        }
        self.draw();
        self.measure();
        self.want_truth();
        #[cfg(not(target_family = "wasm"))]
        self.keep();
        if !ui.ctx().input(|i| i.pointer.any_down()) && self.stage.is_some() && !self.face.is_moving() {
            self.undo.keep(&self.state);
        }
        self.last_to_do(ui.ctx());
    }

    /// Says what the driver reports, and opens what was dropped on the window.
    fn check(&mut self, context: &egui::Context) {
        if let Err(error) = self.gpu.check() {
            self.is_lost |= matches!(error, umbrage::Error::DeviceLost(_));
            self.face.say(error.to_string());
        }
        if let Some(error) = self.trouble.lock().unwrap_or_else(PoisonError::into_inner).take() {
            self.face.say(format!("the graphics driver reports: {error}"));
        }
        let dropped = context.input_mut(|i| std::mem::take(&mut i.raw.dropped_files));
        if !dropped.is_empty() {
            self.open_dropped(dropped);
        }
        #[cfg(target_family = "wasm")]
        self.take_dropped();
    }

    /// Opens the scene among files that were dropped together.
    fn open_dropped(&mut self, files: Vec<egui::DroppedFileHandle>) {
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
    fn take_dropped(&mut self) {
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

    /// Has the device say what is done; browsers do so by themselves.
    fn poll(&self) {
        // What it returns is news of the queue, which nobody asked for.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
    }

    fn take(&mut self) {
        self.take_opened();
        self.truth.take();
        let (truth, state) = (self.traced(), &self.state);
        let shared = Shared {
            gpu: &self.gpu,
            registry: &self.registry,
            show: &self.show,
            observe: &self.observe,
            state,
            truth: &truth,
            truth_version: self.truth.version(),
            stage_version: self.stage_version,
        };
        for pane in &mut self.panes {
            pane.take(&shared);
        }
    }

    fn traced(&self) -> Vec<Arc<crate::truth::Traced>> {
        self.state.shining().into_iter().filter_map(|light| self.truth.of(light).cloned()).collect()
    }

    fn take_opened(&mut self) {
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
        source.light(0).map_err(|e| e.to_string())?;
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

    /// Draws the panes that have changed.
    fn draw(&mut self) {
        let Some(size) = self.face.picture_size(self.divisor()) else { return };
        while self.panes.len() < self.state.panes.len() {
            self.panes.push(Pane::new(&self.gpu, &self.paint, size));
        }
        for pane in self.panes.drain(self.state.panes.len()..) {
            self.paint.renderer.write().free_texture(&pane.id);
        }
        let truth = self.traced();
        let Some(stage) = &mut self.stage else { return };
        if let Err(error) = stage.renderer.resize(size.0, size.1) {
            self.face.say(error.to_string());
            return;
        }
        if let Err(error) = stage.move_to(&self.state) {
            self.face.say(error);
        }
        let seen = stage.seen(&self.state);
        let shared = Shared {
            gpu: &self.gpu,
            registry: &self.registry,
            show: &self.show,
            observe: &self.observe,
            state: &seen,
            truth: &truth,
            truth_version: self.truth.version(),
            stage_version: self.stage_version,
        };
        let mut took = 0.0;
        let mut all = true;
        for (pane, wanted) in self.panes.iter_mut().zip(&self.state.panes) {
            pane.resize(&self.gpu, &self.paint, size);
            if pane.draw(&shared, stage, wanted, self.face.draws_always) {
                took += pane.times.iter().map(|t| t.time_ms).sum::<f64>();
            } else {
                all = false;
            }
        }
        if all && !self.is_at_rest() {
            self.pace.took(took);
        }
    }

    /// Pixels of the window for each pixel of pictures, now.
    pub(crate) fn divisor(&self) -> u32 {
        let paced = if self.is_at_rest() { self.pace.at_rest() } else { self.pace.divisor() };
        self.state.divisor.unwrap_or(paced)
    }

    /// Nothing has changed for a while.
    fn is_at_rest(&self) -> bool {
        !self.face.is_moving() && !self.face.draws_always && self.changed.1.elapsed() >= REST
    }

    /// Has the truth traced that panes show or are compared with.
    fn want_truth(&mut self) {
        let waits = self.truth_waits();
        let Some(stage) = &mut self.stage else { return };
        if self.face.traces && self.opening.is_none() && !waits {
            stage.trace();
        }
        let Some(tracer) = stage.tracer.clone().filter(|_| self.face.traces && !waits) else {
            self.truth.want(None);
            return;
        };
        let state = stage.seen(&self.state);
        let all = state.panes.iter().any(|pane| pane.technique == RAY_TRACED);
        let mut numbers = state.shining();
        if !all {
            // Errors are those of one light.
            numbers.truncate(1);
        }
        let lights = numbers.into_iter().filter_map(|n| Some((n, state.lights.get(n)?.clone()))).collect();
        let size = stage.renderer.size();
        let camera = state.eye().clone();
        self.truth.want(Some(Wanted { tracer, camera, size, lights, textures: stage.textures.clone() }));
    }

    /// Starts what was asked to be kept, and says what came of it.
    #[cfg(not(target_family = "wasm"))]
    fn keep(&mut self) {
        if let Some(kept) = self.keeping.as_ref().and_then(crate::keep::Keeping::take) {
            self.keeping = None;
            self.face.say(kept.map_or_else(|error| error, |path| format!("written: {}", path.display())));
        }
        let Some(stage) = self.stage.as_ref().filter(|_| self.keeping.is_none()) else { return };
        if let Some(kind) = self.face.keep.take() {
            let what = crate::keep::What {
                gpu: self.gpu.clone(),
                registry: self.registry.clone(),
                source: stage.source.clone(),
                state: self.state.clone(),
                size: stage.renderer.size(),
                samples: self.truth_samples().max(1),
                folder: self.folder.clone(),
            };
            self.keeping = Some(crate::keep::Keeping::start(kind, what, self.face.active));
        }
    }

    /// Asks for the next frame where something moves by itself.
    fn last_to_do(&self, context: &egui::Context) {
        if self.face.is_moving()
            || self.face.draws_always
            || self.yardstick.is_some()
            || self.panes.iter().any(Pane::is_waiting)
        {
            context.request_repaint();
            return;
        }
        if !self.is_at_rest() {
            context.request_repaint_after(REST.saturating_sub(self.changed.1.elapsed()));
        }
        if self.opening.is_some()
            || self.truth.is_under_way()
            || self.is_keeping()
            || self.stage.as_ref().is_some_and(Stage::is_tracing)
        {
            context.request_repaint_after(Duration::from_millis(60));
        }
    }

    /// Messages that are shown.
    pub fn messages(&self) -> Vec<String> {
        self.face.all_messages()
    }

    /// Shows another picture in a pane.
    pub fn set_picture(&mut self, pane: usize, picture: &str) {
        if let Some(pane) = self.state.panes.get_mut(pane) {
            pane.picture = picture.into();
        }
    }

    /// Has another technique work for a pane, written with its settings as on the command line.
    pub fn set_technique(&mut self, pane: usize, technique: &str) {
        if let Some(pane) = self.state.panes.get_mut(pane) {
            pane.technique = technique.into();
        }
    }

    /// The device that everything is drawn with.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Pixels of each pane's picture across and down.
    pub fn picture_size(&self) -> (u32, u32) {
        self.panes.first().map_or((0, 0), Pane::size)
    }

    /// GPU time of the newest frame, all panes together, milliseconds; 0 where the adapter keeps no
    /// time.
    pub fn frame_ms(&self) -> f64 {
        self.panes.iter().flat_map(|pane| &pane.times).map(|time| time.time_ms).sum()
    }

    /// Pixels of the window for each pixel of pictures; `None`: as the adapter can.
    pub fn set_divisor(&mut self, divisor: Option<u32>) {
        self.state.divisor = divisor.map(|divisor| divisor.clamp(1, crate::LARGEST_DIVISOR));
    }

    /// The device is gone: a window has to be opened anew.
    pub fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// All that is seen, as [`Options::state`] takes it; `None` while no scene is open.
    pub fn permalink(&self) -> Option<String> {
        Some(link::write(&self.state, &self.stage.as_ref()?.source.scene))
    }

    /// The command that takes the picture of a pane; `None` while no scene is open.
    pub fn command(&self, pane: usize) -> Option<String> {
        let stage = self.stage.as_ref()?;
        let samples = Some(self.truth_samples().max(1));
        Some(link::command(
            &self.state,
            self.state.panes.get(pane)?,
            &stage.source.scene,
            stage.renderer.size(),
            samples,
        ))
    }

    /// The picture of a pane as it is seen; waits for the device.
    ///
    /// # Errors
    /// [`umbrage::Error::Scene`] where there is no such pane, and what reading gives.
    #[cfg(not(target_family = "wasm"))]
    pub fn picture(&self, pane: usize) -> Result<umbrage_core::Image<[u8; 4]>, umbrage::Error> {
        let none = || umbrage::Error::Scene(format!("there is no pane {pane}"));
        umbrage::read::rgba8(&self.gpu, &self.panes.get(pane).ok_or_else(none)?.texture)
    }

    /// A file is being written.
    fn is_keeping(&self) -> bool {
        #[cfg(not(target_family = "wasm"))]
        return self.keeping.is_some();
        #[cfg(target_family = "wasm")]
        false
    }

    /// A scene is open, and the panes show it.
    pub fn is_shown(&self) -> bool {
        let is_drawn = |pane: &Pane| pane.error.is_some() || pane.visibility.is_some();
        self.opening.is_none() && self.panes.len() == self.state.panes.len() && self.panes.iter().all(is_drawn)
    }

    /// Rays for each pixel of the truth about the light that is shown, so far.
    pub fn truth_samples(&self) -> u32 {
        self.truth.of(self.state.light.unwrap_or_default()).map_or(0, |truth| truth.samples)
    }

    /// The mean absolute error of a pane against the truth as far as it is known.
    pub fn mae(&self, pane: usize) -> Option<f64> {
        self.panes.get(pane)?.scores.map(|scores| scores.mae)
    }

    /// Why a pane shows no picture.
    pub fn error(&self, pane: usize) -> Option<&str> {
        self.panes.get(pane)?.error.as_deref()
    }

    /// What the laboratory shows.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// GPU time of a part of the host in the newest frame of a pane, milliseconds.
    pub(crate) fn host_ms(pane: &Pane) -> f64 {
        pane.times.iter().filter(|t| matches!(t.owner, Owner::Host(_))).map(|t| t.time_ms).sum()
    }
}

impl eframe::App for Lab {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.frame(ui);
    }
}
