//! A frame: choose casters, find silhouettes, count, resolve.

use super::counter::Counter;
use super::depth::Projection;
use super::options;
use super::options::{Count, CounterKind, ID, Options};
use super::pipelines::{Key, Pipelines, Test};
use super::select::{Fate, Selection};
use super::views::{self, Views};
use crate::casters::Edges;
use crate::silhouettes::{Part, Silhouettes, Style};
use crate::technique::{DebugView, InOrder, Inside, Stats, Technique};
use crate::{
    error::Error, gpu::Gpu, inline::Lent, passes::Passes, receivers::Receivers, view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::glam::DVec4;

pub(super) struct Volume {
    options: Options,
    silhouettes: Silhouettes,
    pipelines: Pipelines,
    counter: Counter,
    selection: Selection,
    kind: CounterKind,
    casting: u32,
    draws: u32,
    gpu: Gpu,
    /// Depth is clamped at the near and far planes, not clipped.
    clamps: bool,
    views: Option<Views>,
}

/// Stencil wraps at this many shadows.
const STENCIL_LAYERS: u32 = 256;

impl Volume {
    pub fn new(gpu: &Gpu, settings: &options::Volume) -> Self {
        let options = Options::of(settings);
        let silhouettes = Silhouettes::new(gpu, options.extrude);
        Self {
            pipelines: Pipelines::new(gpu, &silhouettes),
            options,
            silhouettes,
            counter: Counter::new(),
            selection: Selection::default(),
            kind: CounterKind::Float,
            casting: 0,
            draws: 0,
            gpu: gpu.clone(),
            clamps: gpu.has(wgpu::Features::DEPTH_CLIP_CONTROL),
            views: None,
        }
    }

    /// Stencil where it surely does not wrap and there is one to use; elsewhere floats, which need
    /// no copy of the depth.
    fn choose_counter(&self, gpu: &Gpu, receivers: &Receivers, layers: u32) -> Result<CounterKind, Error> {
        let has_stencil = gpu.has(wgpu::Features::DEPTH32FLOAT_STENCIL8);
        match self.options.counter {
            _ if self.views.as_ref().is_some_and(Views::needs_counts) => Ok(CounterKind::Float),
            Some(CounterKind::Stencil) if !has_stencil => Err(Error::Unsupported {
                technique: ID.into(),
                what: "this adapter with a stencil counter, since it lacks DEPTH32FLOAT_STENCIL8; set counter=float"
                    .into(),
            }),
            Some(kind) => Ok(kind),
            None if receivers.stencil.is_some() && layers < STENCIL_LAYERS => Ok(CounterKind::Stencil),
            None => Ok(CounterKind::Float),
        }
    }

    /// The sides that each round of drawing leaves out: one round for both, or fronts and then
    /// backs.
    fn rounds(&self) -> &'static [Option<wgpu::Face>] {
        if self.options.two_pass && self.kind == CounterKind::Stencil {
            &[Some(wgpu::Face::Back), Some(wgpu::Face::Front)]
        } else {
            &[None]
        }
    }

    /// How a part is drawn in a round.
    fn key(&self, part: Part, cull: Option<wgpu::Face>) -> Key {
        let from_eye = if self.options.count == Count::Xor { Test::Parity } else { Test::Pass };
        let test = if part == Part::PassSides { from_eye } else { Test::Fail };
        Key { target: self.counter.key, weighted: self.kind == CounterKind::Float, test, part, cull }
    }

    /// Counts one light's shadows from `start`, or on top of what was counted; returns the number
    /// of draws.
    fn count_volumes(&self, passes: &mut Passes<'_>, view: &View<'_>, edges: &Edges, start: Option<i32>) -> u32 {
        let silhouettes = &self.silhouettes;
        silhouettes.record(passes, edges);
        let mut draws = 0;
        let Some(mut pass) = self.counter.begin(passes, view.receivers, start) else { return 0 };
        if let Some([x, y, width, height]) = self.selection.scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        for &cull in self.rounds() {
            for part in Part::ALL.into_iter().filter(|part| !silhouettes.is_empty(*part)) {
                if let Some(pipeline) = self.pipelines.counting(self.key(part, cull)) {
                    pass.set_pipeline(pipeline);
                    silhouettes.draw(&mut pass, edges, part);
                    draws += 1;
                }
            }
        }
        draws
    }

    fn resolve(&self, passes: &mut Passes<'_>, visibility: &VisibilityTarget) {
        let parity = self.options.count == Count::Xor;
        let pipeline = self.pipelines.resolving(self.counter.key, parity);
        let mut pass = passes.render("visibility", &[visibility.overwrite()], self.counter.read_only());
        let Some(pipeline) = pipeline else { return };
        if let Some([x, y, width, height]) = self.selection.scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_pipeline(pipeline);
        if let Some(counts) = self.counter.read_counts() {
            pass.set_bind_group(0, counts, &[]);
        }
        pass.draw(0..3, 0..1);
    }

    fn choose(&mut self, gpu: &Gpu, view: &View<'_>) -> Result<DVec4, Error> {
        if !self.clamps && view.camera.is_parallel() {
            let what = "parallel projections on this adapter, which lacks DEPTH_CLIP_CONTROL".into();
            return Err(Error::Unsupported { technique: ID.into(), what });
        }
        self.casting = view.casters.casting().len() as u32;
        self.selection.choose(gpu, view, &self.options, self.clamps)
    }

    /// Makes room and pipelines for what was chosen.
    fn make_ready(&mut self, gpu: &Gpu, view: &View<'_>, light: DVec4) -> Result<(), Error> {
        let has_dark_caps = self.options.quads || view.camera.is_parallel();
        let quads = has_dark_caps || self.views.as_ref().is_some_and(Views::needs_quads);
        let style = Style { weighted: self.kind == CounterKind::Float, quads };
        let own = Projection::of(&view.camera, self.clamps);
        let camera = view.camera.clip_from_world();
        let clip_from_world = own.as_ref().map_or(&camera, |own| &own.clip_from_world);
        let reversed = own.is_some() || view.camera.background_depth() == 0.0;
        let projection = (clip_from_world, reversed);
        self.silhouettes.prepare(gpu, view.casters, projection, light, &self.selection.throws, style)?;
        let bounded = self.options.depth_bounds && self.options.is_finite() && light.w != 0.0;
        let range = view.light.range.filter(|_| bounded);
        self.counter.prepare(gpu, view, self.kind, range, own.as_ref(), &self.pipelines.read_counts);
        self.pipelines.prepare_resolve(gpu, self.counter.key, self.options.count == Count::Xor);
        // All that the way of counting may need, so that none is made when the eye comes into a
        // shadow.
        for &cull in self.rounds() {
            for &part in self.options.count.parts() {
                self.pipelines.prepare(gpu, self.key(part, cull));
            }
        }
        Ok(())
    }

    /// See [`super::record_overlay`].
    pub(super) fn overlay(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        views: &[View<'_>],
        visibility: &VisibilityTarget,
    ) -> Result<(), Error> {
        // All counts start with all the shadows that the eye is in.
        let mut eye_count = 0;
        for view in views {
            visibility.check(view.receivers)?;
            self.choose(gpu, view)?;
            eye_count += self.selection.eye_count;
        }
        let mut start = Some(eye_count);
        self.draws = 0;
        for view in views {
            let light = self.choose(gpu, view)?;
            let Some(edges) = view.casters.made_edges().filter(|_| !self.selection.throws.is_empty()) else { continue };
            let layers = view.casters.layers(edges).saturating_mul(views.len() as u32);
            self.kind = self.choose_counter(gpu, view.receivers, layers)?;
            self.make_ready(gpu, view, light)?;
            self.draws += self.count_volumes(passes, view, edges, start.take());
        }
        self.selection.scissor = None;
        if start.is_some() {
            passes.render("visibility", &[visibility.overwrite()], None);
        } else {
            self.draws += 1;
            self.resolve(passes, visibility);
        }
        Ok(())
    }
}

impl Technique for Volume {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        let light = self.choose(gpu, view)?;
        let is_lit = self.selection.throws.is_empty();
        if let Some(edges) = view.casters.made_edges().filter(|_| !is_lit) {
            self.kind = self.choose_counter(gpu, view.receivers, view.casters.layers(edges))?;
            self.make_ready(gpu, view, light)?;
        }
        if let Some(views) = &mut self.views {
            views.prepare(gpu, view, &self.silhouettes, self.counter.counts().filter(|_| !is_lit));
        }
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.draws = 0;
        let edges = view.casters.made_edges();
        match edges.filter(|_| !self.selection.throws.is_empty()) {
            Some(edges) => {
                self.draws = self.count_volumes(passes, view, edges, Some(self.selection.eye_count)) + 1;
                self.resolve(passes, visibility);
            }
            None => drop(passes.render("visibility", &[visibility.overwrite()], None)),
        }
        if let Some(views) = &mut self.views {
            views.record(&self.gpu, passes, view, &self.silhouettes, edges, &self.selection);
        }
        Ok(())
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("volume")
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Volume {
    fn stats(&self) -> Stats {
        let drawn = self.selection.throws.len() as u32;
        let (edges, triangles) = self.silhouettes.looked_at();
        Stats {
            draws: self.draws,
            triangles: 2 * edges + triangles,
            casters_drawn: drawn,
            casters_culled: self.casting.saturating_sub(drawn),
            bytes: self.counter.bytes() + self.silhouettes.bytes(),
        }
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        match pass {
            // A count in floats is blended over; the stencil is an attachment.
            "volumes" => Some(self.counter.blended_bytes()),
            "depth for volumes" => Some(4),
            "visibility" => Some(4 + self.counter.blended_bytes()),
            _ => None,
        }
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        let s = &self.selection;
        let fate = |fate| u64::from(s.count(fate));
        let (edges, triangles) = self.silhouettes.looked_at();
        let kept = s.throws.len() as u64;
        let elsewhere: u64 =
            [Fate::OutOfLight, Fate::ShadowsNothing, Fate::OverBudget, Fate::InMaps].map(fate).iter().sum();
        let mut counts = vec![
            ("casters", self.casting.into()),
            ("from the eye", fate(Fate::FromEye)),
            ("from infinity", fate(Fate::FromInfinity)),
            ("out of view", u64::from(self.casting).saturating_sub(kept + elsewhere)),
            ("out of light", fate(Fate::OutOfLight)),
            ("shadow nothing", fate(Fate::ShadowsNothing)),
            ("over budget", fate(Fate::OverBudget)),
            ("in maps", fate(Fate::InMaps)),
            ("light caps", s.caps[0].into()),
            ("light caps culled", s.caps_culled[0].into()),
            ("dark caps", s.caps[1].into()),
            ("dark caps culled", s.caps_culled[1].into()),
            ("searched for the eye", s.eye_counted.into()),
            ("too close to tell", s.eye_undecided.into()),
            ("edges", edges),
            ("cap triangles", triangles),
        ];
        if let Some([from_eye, from_infinity, caps]) = self.silhouettes.found() {
            let sides = u64::from(from_eye) + u64::from(from_infinity);
            counts.extend([("sides", sides), ("caps", caps.into())]);
        }
        counts
    }

    fn inspect(&mut self, view: Option<&str>) {
        let name = view.and_then(|v| views::NAMES.iter().find(|name| **name == v));
        self.views = name.map(|name| Views::new(&self.gpu, name));
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        self.views.iter().filter_map(Views::picture).collect()
    }
}
