//! Depth maps of a light, for every technique that compares with them: fitted, culled and rendered here, looked up
//! through `lookup/map_lookup.wgsl`.

mod bounds;
mod cache;
mod extent;
mod layer;
mod lookup;
mod movers;
mod phases;
mod pipelines;
mod setup;
mod soft;
mod split_fit;
mod stage;
mod steady;
mod submission;
mod taps;
mod textures;
mod uniforms;
mod views;

use crate::{
    casters::{self, Casters},
    error::Error,
    gpu::Gpu,
    passes::Passes,
    settings::Settings,
    shader::{Shader, Shared},
    technique::{DebugView, Inside, Stats, Technique},
    view::View,
    visibility::VisibilityTarget,
};
pub(crate) use bounds::BOUNDS_SHADER;
use cache::{Frame, Work};
use layer::{Layer, Lists};
use lookup::Lookup;
use movers::Movers;
use pipelines::{Kind, Pipelines};
pub use setup::{
    Blend, Cover, Covers, Depth, Faces, Fitting, Kernel, Layout, Map, MapSetup, Softness, Splits, Storage,
};
pub(crate) use soft::TapStage;
pub(crate) use split_fit::SPLIT_FIT_SHADER;
use split_fit::SplitFitter;
pub(crate) use stage::Stage;
use submission::Submission;
pub use taps::Noise;
pub(crate) use taps::{TESTS, Taps};
use textures::Textures;
use uniforms::MapView;
pub(crate) use views::Layers;
use views::Views;

/// The shaders that render maps, for the registry's tests.
pub(crate) const SHADERS: [Shader; 3] = [pipelines::DEPTH_SHADER, pipelines::SECOND_SHADER, pipelines::MIDPOINT_SHADER];

/// What the host has to agree on with the modules of this folder.
pub(crate) const SHARED: &[Shared] = &[uniforms::SHARED[0], uniforms::SHARED[1], taps::SHARED, bounds::SHARED];

use umbrage_core::light_view::{FitScene, Focus, LightView, Omni};
use umbrage_core::{Bounds, LightKind, LightKinds, glam::DVec3, scene_tree::Sphere};

/// Most layers of a light's maps: as many as there may be splits.
pub(crate) const MOST_LAYERS: usize = umbrage_core::splits::MOST_SPLITS;

/// Names of the pictures inside, one a layer.
pub(crate) const LAYER_NAMES: [&str; MOST_LAYERS] =
    ["map-0", "map-1", "map-2", "map-3", "map-4", "map-5", "map-6", "map-7", "map-8"];

/// A technique that renders depth maps and looks them up in one full-screen pass; techniques differ in the shader.
pub(crate) struct MapTechnique {
    setup: MapSetup,
    maps: DepthMaps,
    /// For splits that are fitted on the GPU.
    fitter: Option<SplitFitter>,
    stage: Option<Box<dyn Stage>>,
    lookup: Lookup,
    draws: u32,
}

impl MapTechnique {
    /// `reach_texels`: how far the shader looks around a receiver in the map. `constants` override the shader's.
    pub(crate) fn new(
        gpu: &Gpu,
        setup: &MapSetup,
        shader: &Shader,
        reach_texels: f64,
        constants: &[(&'static str, f64)],
    ) -> Result<Self, Error> {
        Self::staged(gpu, setup, shader, reach_texels, constants, None)
    }

    /// With a stage between the maps and the look-up, whose bind group is group 2 of the shader.
    pub(crate) fn staged(
        gpu: &Gpu,
        setup: &MapSetup,
        shader: &Shader,
        reach_texels: f64,
        constants: &[(&'static str, f64)],
        stage: Option<Box<dyn Stage>>,
    ) -> Result<Self, Error> {
        let maps = DepthMaps::new(gpu, setup, reach_texels)?;
        let more = stage.as_ref().map(|s| s.layout().clone());
        let lookup = Lookup::new(gpu, shader, setup.bias, maps.choice.blend(), constants, more);
        let fitter = maps.choice.is_fitted_to_depth().then(|| SplitFitter::new(gpu, lookup.uniforms()));
        Ok(Self { setup: *setup, maps, fitter, stage, lookup, draws: 0 })
    }

    /// Whether the pipelines and the stage are right for `new`, too.
    fn can_take(&self, new: &MapSetup) -> bool {
        let fixed = |fitting| match fitting {
            Fitting::Splits(splits) => Some((splits.blend, splits.depth_fit)),
            Fitting::One { .. } | Fitting::Warp(_) => None,
        };
        let old = &self.setup;
        let any_size = self.stage.as_ref().is_none_or(|stage| stage.takes_any_size());
        (old.faces, old.softness, fixed(old.fitting)) == (new.faces, new.softness, fixed(new.fitting))
            && (any_size || old.size == new.size)
    }

    /// Looks up in two phases, see `lookup/map_quick.wgsl`.
    pub(crate) fn in_phases(mut self) -> Self {
        self.lookup.in_phases();
        self
    }

    /// Keeps room around the maps for what hides the light's rim from receivers at their border.
    pub(crate) fn soft(mut self) -> Self {
        self.maps.soft = true;
        self
    }

    /// Draws the back faces of all casters.
    pub(crate) fn with_back_faces(mut self) -> Self {
        self.maps.lists.backs = true;
        self
    }

    /// Also draws casters into the maps that can shadow nothing.
    pub(crate) fn with_every_caster(mut self) -> Self {
        self.maps.every_caster = true;
        self
    }
}

impl Technique for MapTechnique {
    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) -> Result<(), Error> {
        self.maps.prepare(gpu, view)?;
        if let Some(stage) = &mut self.stage {
            stage.prepare(gpu, view, &self.maps)?;
        }
        self.lookup.prepare(gpu, view, &self.maps);
        if let Some(fitter) = &mut self.fitter {
            fitter.prepare(view, &self.maps);
        }
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.lookup.upload(passes);
        let fitter = self.fitter.as_ref().filter(|_| matches!(self.maps.layout, Layers::Splits(_)));
        if let Some(fitter) = fitter {
            fitter.record(passes, view.receivers);
        }
        self.draws = self.maps.record(passes, view.casters, fitter);
        let mut more = None;
        if let Some(stage) = &mut self.stage {
            self.draws += stage.record(passes, &self.maps);
            more = stage.bind_group();
        }
        self.draws += self.lookup.record(passes, view.receivers, more, visibility);
        Ok(())
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        let Some(setup) = settings.maps().filter(|new| self.can_take(new)) else { return Ok(false) };
        gpu.check_size("a shadow map", setup.size, setup.size)?;
        self.maps.set(&setup);
        self.lookup.set_bias(setup.bias);
        self.setup = setup;
        Ok(true)
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for MapTechnique {
    fn forget(&mut self) {
        self.maps.layers.iter_mut().for_each(Layer::forget);
    }

    fn stats(&self) -> Stats {
        let mut stats = self.maps.stats();
        stats.draws = self.draws;
        stats.triangles += 1;
        stats.bytes += self.fitter.as_ref().map_or(0, SplitFitter::bytes);
        stats.bytes += self.lookup.bytes() + self.stage.as_ref().map_or(0, |s| s.bytes());
        stats
    }

    fn light_views(&self) -> &[LightView] {
        &self.maps.views
    }

    fn split_distances(&self) -> &[f64] {
        self.maps.borders.get(1..self.maps.borders.len().saturating_sub(1)).unwrap_or_default()
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        let Some(textures) = &self.maps.textures else { return Vec::new() };
        let texture = textures.result();
        let layers = self.maps.views.iter();
        let maps = layers.map(|v| DebugView {
            name: LAYER_NAMES[v.layer as usize % LAYER_NAMES.len()],
            texture,
            layer: v.layer,
        });
        maps.chain(self.stage.iter().flat_map(|s| s.debug_views())).collect()
    }
}

/// Maps of one light.
pub(crate) struct DepthMaps {
    pub(crate) size: u32,
    midpoint: bool,
    choice: Views,
    /// Maps seen from a point fall linearly with the distance.
    linear: bool,
    border_texels: f64,
    /// Kept free besides in this frame, for the light's extent.
    soft_texels: f64,
    /// Draws casters too that can shadow nothing: for the baseline.
    every_caster: bool,
    /// Keeps room for the light's extent.
    soft: bool,
    pipelines: Pipelines,
    textures: Option<Textures>,
    /// The boxes that this frame's views were fitted to.
    pub(crate) scene: FitScene,
    /// Whose boxes those of the casters are, and when: the buffer of their instances and [`casters::Moves::now`].
    scene_of: Option<(wgpu::Buffer, u64)>,
    pub(crate) views: Vec<LightView>,
    /// What the layers are.
    pub(crate) layout: Layers,
    /// Distances along the camera's view between views that split it.
    borders: Vec<f64>,
    layers: Vec<Layer>,
    lists: Lists,
    /// Keeps what did not change.
    cache: bool,
    movers: Movers,
    submission: Submission,
    /// The last frame that was prepared was recorded as well.
    recorded: bool,
    triangles: u64,
}

/// Most boxes that stand for all casters in a fit, and for all receivers that are seen.
const MOST_BOXES: usize = 256;

const EVERYWHERE: Sphere = Sphere { center: DVec3::ZERO, radius: f64::INFINITY };

/// Whether maps are kept. What is fitted on the GPU is another view in every frame.
fn caches(setup: &MapSetup, choice: &Views) -> bool {
    setup.cache && !choice.is_fitted_to_depth()
}

impl DepthMaps {
    fn new(gpu: &Gpu, setup: &MapSetup, reach_texels: f64) -> Result<Self, Error> {
        let MapSetup { size, faces, .. } = *setup;
        gpu.check_size("a shadow map", size, size)?;
        let (choice, midpoint) = (Views::of(setup), faces == Faces::Midpoint);
        Ok(Self {
            size,
            midpoint,
            cache: caches(setup, &choice),
            choice,
            linear: setup.depth == Depth::Linear,
            border_texels: reach_texels + 1.0,
            soft_texels: 0.0,
            every_caster: false,
            soft: false,
            pipelines: Pipelines::new(gpu, faces == Faces::Back, midpoint),
            textures: None,
            scene: FitScene::default(),
            scene_of: None,
            views: Vec::new(),
            layout: Layers::Single,
            borders: Vec::new(),
            layers: Vec::new(),
            lists: Lists::new(midpoint),
            movers: Movers::default(),
            submission: Submission::default(),
            recorded: false,
            triangles: 0,
        })
    }

    /// Takes other settings over, where all pipelines stay right.
    fn set(&mut self, setup: &MapSetup) {
        if setup.size != self.size {
            self.textures = None;
        }
        self.size = setup.size;
        self.choice = Views::of(setup);
        self.linear = setup.depth == Depth::Linear;
        self.cache = caches(setup, &self.choice);
        self.layers.iter_mut().for_each(Layer::forget);
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) -> Result<(), Error> {
        let known = self.cache && self.movers.update(view.casters);
        if !known || !std::mem::take(&mut self.recorded) || self.submission.was_dropped() {
            self.layers.iter_mut().for_each(Layer::forget);
        }
        self.gather(view);
        self.views.clear();
        self.borders.clear();
        if !view.light.casts || self.scene.casters.is_empty() {
            self.forget_unseen();
            return Ok(());
        }
        self.fit(view, self.border_texels);
        self.soft_texels = 0.0;
        if self.soft && !self.views.is_empty() {
            self.soft_texels = extent::light_border(&view.light.shape, self);
            self.fit(view, self.border_texels + self.soft_texels);
        }
        self.forget_unseen();
        if !self.views.is_empty() {
            self.make_room(gpu);
            self.choose(gpu, view);
        }
        Ok(())
    }

    /// Forgets layers without a view.
    fn forget_unseen(&mut self) {
        let unseen = (0..).zip(&mut self.layers).filter(|(i, _)| !self.views.iter().any(|view| view.layer == *i));
        unseen.for_each(|(_, layer)| layer.forget());
    }

    /// Chooses what the layers draw.
    fn choose(&mut self, gpu: &Gpu, view: &View<'_>) {
        let casters = view.casters;
        let light = casters::Light { center: view.light.shape.center(), receivers: casters.receivers_bounds() };
        let light = Some(light).filter(|_| !self.every_caster);
        let frame = Frame { casters, movers: &self.movers, can_store: !self.midpoint };
        let frame = Some(&frame).filter(|_| self.cache);
        self.lists.numbers.clear(gpu, casters, self.layers.len() as u32);
        for light_view in &self.views {
            let layer = &mut self.layers[light_view.layer as usize];
            layer.prepare(casters, frame, light_view, light, &mut self.lists);
            layer.uniform = MapView::new(light_view, casters.origin(), self.linear);
            if let (Work::Over { .. }, Some(textures)) = (layer.work, &mut self.textures) {
                textures.make_store(gpu);
            }
        }
    }

    /// The boxes that views are fitted to.
    fn gather(&mut self, view: &View<'_>) {
        let FitScene { casters, receivers, around } = &mut self.scene;
        *around = view.casters.all_bounds();
        let now = view.casters.moves().now();
        if self.scene_of.as_ref().is_none_or(|(of, then)| (of, *then) != (&view.casters.instances, now)) {
            casters.clear();
            view.casters.casting().cut(&EVERYWHERE, MOST_BOXES, casters);
            self.scene_of = Some((view.casters.instances.clone(), now));
        }
        receivers.clear();
        let receiving = view.casters.receiving();
        match self.choice.focus() {
            Focus::Light => receiving.cut(&EVERYWHERE, MOST_BOXES, receivers),
            Focus::Visible => receiving.cut(&view.camera.frustum(), MOST_BOXES, receivers),
        }
    }

    /// Pipelines, layers and textures for the views.
    fn make_room(&mut self, gpu: &Gpu) {
        self.pipelines.prepare(gpu, self.kind());
        let count = self.layout.count();
        self.layers.resize_with(self.layers.len().max(count as usize), Layer::default);
        if self.textures.as_ref().is_none_or(|t| t.layers() < count) {
            self.textures = Some(Textures::new(gpu, &self.pipelines, self.size, count, self.midpoint));
            self.layers.iter_mut().for_each(Layer::forget);
        }
    }

    /// Renders the maps; returns the number of draws.
    fn record(&mut self, passes: &mut Passes<'_>, casters: &Casters, fitter: Option<&SplitFitter>) -> u32 {
        self.recorded = true;
        let Some(textures) = &self.textures else { return 0 };
        let (mut draws, mut triangles) = (0, 0);
        let numbers = &self.lists.numbers;
        let worked = |view: &&LightView| self.layers[view.layer as usize].work != Work::Keep;
        if self.cache {
            self.submission.watch(passes.encoder());
        }
        numbers.upload(passes);
        for view in self.views.iter().filter(worked) {
            let i = view.layer as usize;
            let layer = &self.layers[i];
            passes.upload(&textures.uniforms[i].0, bytemuck::bytes_of(&layer.uniform));
            if let Some(fitter) = fitter {
                fitter.copy_matrix(passes, view.layer, &textures.uniforms[i].0);
            }
            let rounds = self.pipelines.record(passes, casters, (numbers, layer), textures, i, self.kind());
            draws += rounds * layer.list.draws() + layer.rest.draws();
            triangles += u64::from(rounds) * layer.list.triangles(casters) + layer.rest.triangles(casters);
        }
        self.triangles = triangles;
        draws
    }

    /// Largest coordinate that the vertex shader computes with, metres: what rounding goes by.
    fn largest_coordinate(&self, view: &View<'_>) -> f64 {
        let origin = view.casters.origin();
        let casters = view.casters.casting().content();
        let casters = Bounds { min: casters.min - origin, max: casters.max - origin };
        let center = view.light.shape.center();
        let light = (center.truncate() - origin).abs().max_element() * center.w;
        light.max(casters.largest_coordinate())
    }

    /// Changes whenever this layer of the maps does.
    pub(crate) fn version(&self, layer: u32) -> u64 {
        self.layers.get(layer as usize).map_or(0, |layer| layer.version)
    }

    /// The texture that is looked up, once there is one.
    pub(crate) fn result(&self) -> Option<&wgpu::Texture> {
        self.textures.as_ref().map(Textures::result)
    }

    /// True where this frame's views are from a point.
    pub(crate) fn is_from_a_point(&self) -> bool {
        self.views.first().is_some_and(LightView::is_perspective)
    }

    /// True where this frame's views are of parallel light, in texels that need not be of one size.
    fn is_warped(&self) -> bool {
        self.choice.is_warped() && !self.is_from_a_point()
    }

    /// What this frame's views need: all of a light are alike.
    fn kind(&self) -> Kind {
        let perspective = self.is_from_a_point();
        let paraboloid = self.layout == Layers::Omni(Omni::DualParaboloid);
        Kind { perspective, paraboloid, linear: self.linear && perspective }
    }

    fn stats(&self) -> Stats {
        let layers = self.views.iter().map(|v| &self.layers[v.layer as usize]);
        Stats {
            draws: 0,
            triangles: self.triangles,
            casters_drawn: layers.clone().map(|l| l.list.drawn() + l.rest.drawn()).sum(),
            casters_culled: layers.map(|l| l.culled).sum(),
            bytes: self.lists.numbers.bytes() + self.textures.as_ref().map_or(0, Textures::bytes),
        }
    }
}

/// Bytes and kinds common to the techniques of this family: every kind of light, soft ones hard from their centre.
pub(crate) const LIGHTS: LightKinds = LightKinds::of(&LightKind::ALL);
