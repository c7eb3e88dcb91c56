//! One picture of the laboratory: a technique, or the truth, and what is known of it.

use crate::later::Newest;
use crate::loupe::Maps;
use crate::observe::{self, Frozen, Observe};
use crate::show::{FORMAT, Show, Way, truth_texture, upload};
use crate::slow::{self, Slow};
use crate::stage::{Moment, Stage};
use crate::state::{COLOR, ERROR, PaneState, State, VISIBILITY, is_overlooked};
use crate::truth::Traced;
use eframe::egui;
use std::collections::VecDeque;
use std::sync::Arc;
use umbrage::{Error, Gpu, Owner, PassTime, Registry, Stats, read};
use umbrage_core::{Camera, Image, Light};
use umbrage_metrics::{Comparison, Scores, score};
use umbrage_renderer::{LightPass, Lights};
use umbrage_report::{Choice, Given, RAY_TRACED};

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
    scored: Option<(u64, *const Image<f32>)>,
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

    /// Makes the techniques where others are asked for; settings that can be taken over are.
    fn make(&mut self, shared: &Shared<'_>, stage: &mut Stage, drawn: &Drawn) -> Result<(), String> {
        let numbers: Vec<usize> = drawn.lights.iter().map(|(number, _)| *number).collect();
        if let Some(made) = &self.made
            && (&made.technique, &made.numbers, made.truth) == (&drawn.pane.technique, &numbers, truth_of(drawn))
        {
            return Ok(());
        }
        let text = |e: &dyn std::fmt::Display| e.to_string();
        let mut passes = Vec::new();
        if drawn.pane.technique == RAY_TRACED {
            for &number in &numbers {
                let traced = shared.truth.iter().find(|t| t.light == number && t.visibility.size() == drawn.size);
                let nothing = Image::filled(drawn.size.0, drawn.size.1, 0.0);
                let picture = traced.map_or(&nothing, |traced| &traced.visibility);
                let technique = Box::new(Given::new(shared.gpu, picture).map_err(|e| text(&e))?);
                passes.push(LightPass { light: number, technique });
            }
        } else {
            let choice = Choice::parse(shared.registry, &drawn.pane.technique, &[]).map_err(|e| text(&e))?;
            for (number, light) in &drawn.lights {
                choice.supports(light.shape.kind()).map_err(|e| text(&e))?;
                if self.took_over(&choice, stage, &numbers)? {
                    break;
                }
                passes.push(LightPass { light: *number, technique: choice.make(shared.gpu).map_err(|e| text(&e))? });
            }
            if let (Some(made), true) = (&mut self.made, passes.is_empty()) {
                made.technique.clone_from(&drawn.pane.technique);
                return Ok(());
            }
        }
        let lights = stage.renderer.make_lights(passes).map_err(|e| text(&e))?;
        let technique = drawn.pane.technique.clone();
        if self.made.as_ref().is_none_or(|made| made.technique != technique) {
            self.history.clear();
        }
        self.made = Some(Made { technique, numbers, lights, truth: truth_of(drawn) });
        Ok(())
    }

    /// True where the techniques that are there took the settings over.
    fn took_over(&mut self, choice: &Choice, stage: &mut Stage, numbers: &[usize]) -> Result<bool, String> {
        let Some(made) = self.made.as_mut().filter(|made| made.numbers == numbers) else { return Ok(false) };
        let is_same = made.technique.split(':').next() == Some(choice.info.id);
        if !is_same || choice.light_samples.is_some() || made.technique.contains(umbrage_report::LIGHT_SAMPLES) {
            return Ok(false);
        }
        stage.renderer.exchange_lights(&mut made.lights).map_err(|e| e.to_string())?;
        let taken =
            (0..numbers.len()).try_for_each(|pass| stage.renderer.set_settings(pass, &choice.settings).map(|_| ()));
        stage.renderer.exchange_lights(&mut made.lights).map_err(|e| e.to_string())?;
        taken.map_err(|e| e.to_string())?;
        Ok(true)
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

    /// Brings what the frame has left into the pane's own picture.
    fn copy(
        &mut self,
        shared: &Shared<'_>,
        stage: &Stage,
        drawn: &Drawn,
        main: usize,
        camera: &Camera,
    ) -> Result<(), String> {
        let gpu = shared.gpu;
        let renderer = &stage.renderer;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let visibility = || renderer.visibility_texture(main).map(view).map_err(|e| e.to_string());
        match drawn.pane.picture.as_str() {
            COLOR => {
                // They differ in how the same bytes are read alone.
                let (from, to) = (renderer.picture().as_image_copy(), self.texture.as_image_copy());
                encoder.copy_texture_to_texture(from, to, self.texture.size());
            }
            VISIBILITY => shared.show.draw(&mut encoder, &visibility()?, None, &self.view, Way::Numbers([0.0, 1.0])),
            ERROR => {
                let truth = truth_view(gpu, shared.main_truth().map(|t| &**t), drawn.size);
                let way = Way::Difference(drawn.gain);
                shared.show.draw(&mut encoder, &visibility()?, Some(&truth), &self.view, way);
            }
            "depth" => {
                let depth =
                    wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() };
                let depth = renderer.depth_texture().create_view(&depth);
                let high = self.extremes.map_or(1.0, |[_, high]| high);
                shared.show.draw(
                    &mut encoder,
                    &depth,
                    None,
                    &self.view,
                    Way::Numbers(drawn.range.unwrap_or([0.0, high])),
                );
                self.look(gpu, renderer.depth_texture(), 0);
            }
            other if slow::is_slow(other) => {
                self.slow.ask(other, shared, stage, main, drawn.size, camera)?;
            }
            other => {
                let technique = renderer.technique(main).ok_or("no light shines")?;
                let views = technique.inside().debug_views();
                let view = views.iter().find(|v| v.name == other).ok_or_else(|| {
                    let names: Vec<_> = views.iter().map(|v| v.name).collect();
                    let names = if names.is_empty() { "no views at all".into() } else { names.join(", ") };
                    format!("there is no `{other}` of this light; its views: {names}")
                })?;
                let is_color = view.texture.format().components() == 4;
                let has_depth = view.texture.format().has_depth_aspect();
                let source = view.texture.create_view(&wgpu::TextureViewDescriptor {
                    dimension: Some(wgpu::TextureViewDimension::D2),
                    aspect: if has_depth { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All },
                    base_array_layer: view.layer,
                    array_layer_count: Some(1),
                    base_mip_level: 0,
                    mip_level_count: Some(1),
                    ..Default::default()
                });
                let way = if is_color {
                    Way::Colors
                } else {
                    Way::Numbers(drawn.range.unwrap_or([0.0, self.extremes.map_or(1.0, |[_, high]| high)]))
                };
                shared.show.draw(&mut encoder, &source, None, &self.view, way);
                if !is_color {
                    self.look(gpu, view.texture, view.layer);
                }
            }
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Asks for the numbers of a view, once, to stretch them.
    fn look(&mut self, gpu: &Gpu, texture: &wgpu::Texture, layer: u32) {
        if self.extremes.is_none() && !self.looking.is_under_way() {
            let (gpu, texture) = (gpu.clone(), texture.clone());
            let found = self.looking.ask(async move { read::later::one_channel(&gpu, &texture, layer).await });
            self.is_stale |= found.is_some();
            self.extremes = found.and_then(Result::ok).map(|image| extremes(&image));
        }
    }

    /// Asks for the visibility, unless it is under way.
    fn read(&mut self, shared: &Shared<'_>, stage: &Stage, main: usize) {
        self.is_unread = self.reading.is_under_way();
        if self.is_unread {
            return;
        }
        if let Ok(texture) = stage.renderer.visibility_texture(main) {
            let (gpu, texture) = (shared.gpu.clone(), texture.clone());
            let found = self.reading.ask(async move { read::later::one_channel(&gpu, &texture, 0).await });
            self.visibility = found.and_then(Result::ok).map(Arc::new).or(self.visibility.take());
        }
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
        let of = Some((shared.truth_version, Arc::as_ptr(visibility)));
        if of == self.scored || truth.samples == 0 || visibility.size() != truth.visibility.size() {
            return;
        }
        self.scored = of;
        let comparison = Comparison {
            produced: visibility,
            reference: &truth.visibility,
            mask: &truth.scored,
            hard: None,
            reach: None,
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

fn extremes(image: &Image<f32>) -> [f32; 2] {
    let finite = image.data.iter().copied().filter(|v| v.is_finite());
    let [low, high] = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    if low < high { [low, high] } else { [0.0, if high > 0.0 { high } else { 1.0 }] }
}

fn truth_view(gpu: &Gpu, truth: Option<&Traced>, size: (u32, u32)) -> wgpu::TextureView {
    let texture = truth_texture(gpu, size);
    let picture = match truth.filter(|truth| truth.visibility.size() == size) {
        None => Image::filled(size.0, size.1, -1.0),
        Some(truth) => {
            let pairs = truth.visibility.data.iter().zip(&truth.scored.data);
            Image { width: size.0, height: size.1, data: pairs.map(|(v, s)| if *s { *v } else { -1.0 }).collect() }
        }
    };
    upload(gpu, &texture, &picture);
    texture.create_view(&Default::default())
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
