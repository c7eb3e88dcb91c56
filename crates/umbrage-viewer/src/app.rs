//! The laboratory, frame by frame.

mod asked;
mod scenes;

use crate::MOST_PANES;
use crate::link::Linked;
use crate::observe::Observe;
use crate::pace::Pace;
use crate::pane::{Pane, Shared};
use crate::show::Show;
use crate::stage::{Opening, Stage};
use crate::state::{PaneState, State};
use crate::truth::{Truth, Wanted};
use crate::ui::Face;
use crate::undo::Undo;
use crate::yardstick::{Of, Ratios, Yardstick};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use std::sync::{Arc, Mutex, PoisonError};
use umbrage::{Gpu, Owner, Registry};
use umbrage_report::RAY_TRACED;
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

    /// A file is being written.
    fn is_keeping(&self) -> bool {
        #[cfg(not(target_family = "wasm"))]
        return self.keeping.is_some();
        #[cfg(target_family = "wasm")]
        false
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
