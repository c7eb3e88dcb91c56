//! One picture of the laboratory: a technique, or the truth, and what is known of it.

mod copy;
mod made;

use crate::later::Newest;
use crate::loupe::Maps;
use crate::observe::{self, Frozen, Observe};
use crate::show::{FORMAT, Show, upload};
use crate::slow::{self, Slow};
use crate::stage::{Moment, Stage};
use crate::state::{ERROR, PaneState, State, VISIBILITY, is_overlooked};
use crate::truth::Traced;
use copy::{extremes, truth_view};
use eframe::egui;
use std::collections::VecDeque;
use std::sync::Arc;
use umbrage::{Error, Gpu, Owner, PassTime, Registry, Stats};
use umbrage_core::{Camera, Image, Light};
use umbrage_metrics::{Comparison, Scores, score};
use umbrage_renderer::Lights;
use umbrage_report::RAY_TRACED;

/// Frames whose times are shown.
pub(crate) const HISTORY: usize = 200;

/// What a picture depends on: it is drawn again where any of this has changed.
#[derive(Clone, PartialEq)]
struct Drawn {
    pane: PaneState,
    camera: Camera,
    /// The camera that stands still while an observer looks on.
    frozen: Option<Camera>,
    lights: Vec<(usize, Light)>,
    moment: Moment,
    /// Rays can be traced, where the picture needs them.
    is_traceable: bool,
    size: (u32, u32),
    gain: f32,
    range: Option<[f32; 2]>,
    /// Of the truth, where the picture shows it.
    truth: u64,
    /// Of the scene.
    stage: u64,
}

/// What the picture was made with.
struct Made {
    technique: String,
    numbers: Vec<usize>,
    lights: Lights,
    truth: u64,
}

/// A picture and all that belongs to it.
pub(crate) struct Pane {
    pub texture: wgpu::Texture,
    view: wgpu::TextureView,
    pub id: egui::TextureId,
    made: Option<Made>,
    drawn: Option<Drawn>,
    /// The same has to be drawn again: more is known of it.
    is_stale: bool,
    /// Why there is no picture.
    pub error: Option<String>,
    pub stats: Stats,
    pub counts: Vec<(&'static str, u64)>,
    /// GPU time of the newest frame by pass.
    pub times: Vec<PassTime>,
    /// GPU time of the technique in the last frames, milliseconds.
    pub history: VecDeque<f32>,
    /// CPU time of preparing it in the last frame, milliseconds.
    pub prepare_ms: f64,
    /// Of the main light, of the frame that is shown or one shortly before.
    pub visibility: Option<Arc<Image<f32>>>,
    reading: Newest<Result<Image<f32>, Error>>,
    /// A frame was not read, since one before it still was.
    is_unread: bool,
    /// Against the truth as far as it is known.
    pub scores: Option<Scores>,
    /// What they are of: the truth's version and the picture, which is kept so that no other one
    /// takes its address.
    scored: Option<(u64, Arc<Image<f32>>)>,
    /// Smallest and largest value of the view that is shown.
    pub extremes: Option<[f32; 2]>,
    looking: Newest<Result<Image<f32>, Error>>,
    slow: Slow,
    /// The maps of the main light, of the frame that is shown.
    pub maps: Arc<Maps>,
    /// While an observer looks on.
    frozen: Option<Frozen>,
}

/// What all panes share in a frame.
pub(crate) struct Shared<'a> {
    pub gpu: &'a Gpu,
    pub registry: &'a Registry,
    pub show: &'a Show,
    pub observe: &'a Observe,
    pub state: &'a State,
    pub truth: &'a [Arc<Traced>],
    pub truth_version: u64,
    pub stage_version: u64,
}

impl Shared<'_> {
    /// The truth about the light that pictures of one light show.
    pub fn main_truth(&self) -> Option<&Arc<Traced>> {
        let number = self.state.light.unwrap_or_default();
        self.truth.iter().find(|traced| traced.light == number)
    }
}

impl Pane {
    /// An empty one.
    pub fn new(gpu: &Gpu, paint: &eframe::egui_wgpu::RenderState, size: (u32, u32)) -> Self {
        let (texture, view) = target(gpu, size);
        let id = paint.renderer.write().register_native_texture(&gpu.device, &view, wgpu::FilterMode::Nearest);
        Self {
            texture,
            view,
            id,
            made: None,
            drawn: None,
            is_stale: false,
            error: None,
            stats: Stats::default(),
            counts: Vec::new(),
            times: Vec::new(),
            history: VecDeque::new(),
            prepare_ms: 0.0,
            visibility: None,
            reading: Newest::default(),
            is_unread: false,
            scores: None,
            scored: None,
            extremes: None,
            looking: Newest::default(),
            slow: Slow::default(),
            maps: Arc::default(),
            frozen: None,
        }
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        (self.texture.width(), self.texture.height())
    }

    /// Takes over a new size.
    pub fn resize(&mut self, gpu: &Gpu, paint: &eframe::egui_wgpu::RenderState, size: (u32, u32)) {
        if size != self.size() {
            (self.texture, self.view) = target(gpu, size);
            let mut renderer = paint.renderer.write();
            let filter = wgpu::FilterMode::Nearest;
            renderer.update_egui_texture_from_wgpu_texture(&gpu.device, &self.view, filter, self.id);
            self.drawn = None;
        }
    }

    /// Drops what belongs to a scene that is no more.
    pub fn forget(&mut self) {
        (self.made, self.drawn, self.visibility, self.scores) = (None, None, None, None);
        self.scored = None;
        self.frozen = None;
        (self.stats, self.extremes) = (Stats::default(), None);
        self.counts.clear();
        self.times.clear();
        self.history.clear();
    }

    /// Draws the picture where something has changed; true where it did.
    pub fn draw(&mut self, shared: &Shared<'_>, stage: &mut Stage, wanted: &PaneState, always: bool) -> bool {
        let state = shared.state;
        let lights = state.shining().into_iter().filter_map(|n| Some((n, state.lights.get(n)?.clone()))).collect();
        let shows_truth =
            wanted.technique == RAY_TRACED || wanted.picture == ERROR || slow::needs_truth(&wanted.picture);
        let drawn = Drawn {
            pane: wanted.clone(),
            camera: state.eye().clone(),
            // The truth is traced for who looks.
            frozen: (state.observer.is_some() && wanted.technique != RAY_TRACED).then(|| state.camera.clone()),
            lights,
            moment: stage.moment(),
            is_traceable: slow::is_slow(&wanted.picture) && stage.tracer.is_some(),
            size: self.size(),
            gain: state.gain,
            range: state.range,
            truth: if shows_truth { shared.truth_version } else { 0 },
            stage: shared.stage_version,
        };
        let is_stale = std::mem::take(&mut self.is_stale);
        if self.drawn.as_ref() == Some(&drawn) && !always && !is_stale {
            return false;
        }
        let is_new = self
            .drawn
            .as_ref()
            .is_none_or(|old| old.pane != drawn.pane || old.lights != drawn.lights || old.camera != drawn.camera);
        if is_new {
            self.extremes = None;
        }
        self.error = self.make_and_draw(shared, stage, &drawn).err();
        self.drawn = Some(drawn);
        true
    }

    fn make_and_draw(&mut self, shared: &Shared<'_>, stage: &mut Stage, drawn: &Drawn) -> Result<(), String> {
        self.make(shared, stage, drawn)?;
        let Some(made) = &mut self.made else { return Ok(()) };
        stage.renderer.exchange_lights(&mut made.lights).map_err(|e| e.to_string())?;
        let result = self.draw_made(shared, stage, drawn);
        if let Some(made) = &mut self.made {
            stage.renderer.exchange_lights(&mut made.lights).map_err(|e| e.to_string())?;
        }
        if result.is_err() {
            self.made = None;
        }
        result
    }

    /// Draws with the lights that are in the renderer.
    fn draw_made(&mut self, shared: &Shared<'_>, stage: &mut Stage, drawn: &Drawn) -> Result<(), String> {
        let text = |e: Error| e.to_string();
        let renderer = &mut stage.renderer;
        for (pass, (_, light)) in drawn.lights.iter().enumerate() {
            if let Some(of_pass) = renderer.light_mut(pass) {
                of_pass.clone_from(light);
            }
        }
        let picture = drawn.pane.picture.as_str();
        let main = self.main_pass(shared.state);
        let is_inside = is_inside(shared.registry, &drawn.pane);
        renderer.inspect(main, is_inside.then_some(picture));
        renderer.set_clipping(!is_inside);
        let fitted = drawn.frozen.as_ref().unwrap_or(&drawn.camera);
        renderer.frame(fitted).map_err(text)?;
        self.stats = renderer.stats(main);
        self.counts = renderer.counts(main);
        self.keep_maps(stage, main, fitted);
        let renderer = &mut stage.renderer;
        self.prepare_ms = renderer.prepare_ms();
        self.times = renderer.times();
        if !self.times.is_empty() {
            let of_lights = self.times.iter().filter(|t| matches!(t.owner, Owner::Light(_)));
            self.history.push_back(of_lights.map(|t| t.time_ms as f32).sum());
            self.history.drain(..self.history.len().saturating_sub(HISTORY));
        }
        if let Some(frozen) = drawn.frozen.as_ref().filter(|_| is_overlooked(picture)) {
            return self.overlook(shared, stage, drawn, main, frozen);
        }
        self.frozen = None;
        self.copy(shared, stage, drawn, main, fitted)?;
        self.read(shared, stage, main);
        Ok(())
    }

    /// Draws what the frame for the frozen camera has found as the observer sees it.
    fn overlook(
        &mut self,
        shared: &Shared<'_>,
        stage: &mut Stage,
        drawn: &Drawn,
        main: usize,
        frozen: &Camera,
    ) -> Result<(), String> {
        // What pixels hold is of no picture that is shown.
        (self.visibility, self.scores) = (None, None);
        let gpu = shared.gpu;
        let numbers: Vec<usize> = drawn.lights.iter().map(|(number, _)| *number).collect();
        if self.frozen.as_ref().is_none_or(|frozen| !frozen.fits(&numbers, drawn.size)) {
            let like = stage.renderer.visibility_texture(main).map_err(|e| e.to_string())?;
            self.frozen = Some(Frozen::new(gpu, &stage.renderer, &numbers, like)?);
        }
        let Some(kept) = &mut self.frozen else { return Ok(()) };
        let is_error = drawn.pane.picture == ERROR;
        let truth = shared.main_truth().filter(|_| is_error).map(|truth| &**truth);
        let view = observe::View {
            observer: &drawn.camera,
            frozen,
            picture: if is_error { 2.0 } else { f32::from(u8::from(drawn.pane.picture == VISIBILITY)) },
            gain: drawn.gain,
            truth: &truth_view(gpu, truth, drawn.size),
            pane: &self.view,
        };
        shared.observe.draw(gpu, &mut stage.renderer, main, kept, &view)
    }

    /// Remembers where the maps of the frame lie; another memory only where they do elsewhere.
    fn keep_maps(&mut self, stage: &Stage, main: usize, camera: &Camera) {
        let Some(inside) = stage.renderer.technique(main).map(|technique| technique.inside()) else { return };
        let (views, splits) = (inside.light_views(), inside.split_distances());
        let is_same = self.maps.views == views && self.maps.splits == splits && self.maps.camera == *camera;
        if !is_same {
            self.maps = Arc::new(Maps { views: views.into(), splits: splits.into(), camera: camera.clone() });
        }
    }

    /// The pass of the light that pictures of one light show.
    fn main_pass(&self, state: &State) -> usize {
        let number = state.light.unwrap_or_default();
        let made = self.made.as_ref();
        made.and_then(|made| made.numbers.iter().position(|n| *n == number)).unwrap_or_default()
    }

    /// Takes over what has come since the last frame; true where it has to be drawn again.
    pub fn take(&mut self, shared: &Shared<'_>) -> bool {
        let mut changed = false;
        if let Some(found) = self.reading.take() {
            self.visibility = found.ok().map(Arc::new);
            changed = std::mem::take(&mut self.is_unread);
        }
        if let Some(Ok(found)) = self.looking.take() {
            self.extremes = Some(extremes(&found));
            changed = true;
        }
        if let Some(picture) = self.slow.take() {
            match picture {
                Ok(picture) if picture.size() == self.size() => upload(shared.gpu, &self.texture, &picture),
                Ok(_) => {}
                Err(error) => self.error = Some(error),
            }
            changed |= self.slow.was_stale();
        }
        self.score(shared);
        self.is_stale |= changed;
        changed
    }

    /// Something is still to come.
    pub fn is_waiting(&self) -> bool {
        self.reading.is_under_way() || self.looking.is_under_way() || self.slow.is_under_way()
    }

    /// Compares the visibility that has come with the truth that is known.
    fn score(&mut self, shared: &Shared<'_>) {
        let (Some(visibility), Some(truth)) = (&self.visibility, shared.main_truth()) else {
            self.scores = None;
            return;
        };
        let of = (shared.truth_version, visibility.clone());
        let is_of = |scored: &(u64, Arc<Image<f32>>)| scored.0 == of.0 && Arc::ptr_eq(&scored.1, &of.1);
        if truth.samples == 0 || visibility.size() != truth.visibility.size() {
            // What was scored before was another picture.
            (self.scores, self.scored) = (None, None);
            return;
        }
        if self.scored.as_ref().is_some_and(is_of) {
            return;
        }
        self.scored = Some(of);
        let comparison = Comparison {
            produced: visibility,
            reference: &truth.visibility,
            mask: &truth.scored,
            hard: None,
            reach: None,
            contacts: None,
        };
        self.scores = score(&comparison).ok();
    }
}

/// The version of the truth that techniques are made of: that of the truth's own alone.
fn truth_of(drawn: &Drawn) -> u64 {
    if drawn.pane.technique == RAY_TRACED { drawn.truth } else { 0 }
}

/// The picture is a view into the technique.
fn is_inside(registry: &Registry, pane: &PaneState) -> bool {
    registry.find(pane.id()).is_ok_and(|info| info.views.contains(&pane.picture.as_str()))
}

fn target(gpu: &Gpu, (width, height): (u32, u32)) -> (wgpu::Texture, wgpu::TextureView) {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("pane"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    (texture, view)
}
