//! Depth maps of a light, for every technique that compares with them: fitted, culled and rendered here, looked up
//! through `wgsl/map_lookup.wgsl`.

mod bounds;
mod lookup;
mod phases;
mod pipelines;
mod soft;
mod stage;
mod taps;
mod uniforms;

use crate::{
    casters::{self, Casters, DrawList, Which},
    error::Error,
    fullscreen::target_texture,
    gpu::Gpu,
    params::{Param, ParamKind, Settings},
    passes::Passes,
    shader::{Shader, shader_struct},
    technique::{DebugView, Stats, Technique},
    view::View,
    visibility::VisibilityTarget,
};
pub(crate) use bounds::BOUNDS_SHADER;
use lookup::Lookup;
use pipelines::Pipelines;
pub(crate) use soft::TapStage;
pub(crate) use stage::Stage;
pub(crate) use taps::{GRADIENT_NOISE, NOISE, TESTS, TILE, Taps};
pub(crate) use uniforms::{Eye, LOOKUP_LAYOUTS, TAP_LAYOUTS};

/// The shaders that render maps, for the registry's tests.
pub(crate) const SHADERS: [Shader; 3] = [pipelines::DEPTH_SHADER, pipelines::SECOND_SHADER, pipelines::MIDPOINT_SHADER];

use umbrage_core::glam::DMat4;
use umbrage_core::light_view::{Fit, FitScene, Focus, LightView, fit};
use umbrage_core::{Bounds, Frustum, LightKind, LightKinds};

/// Names of the pictures inside, one a layer.
pub(crate) const LAYER_NAMES: [&str; 6] = ["map-0", "map-1", "map-2", "map-3", "map-4", "map-5"];

/// The format of maps: floats, since reversed depth needs their precision far away.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// `size`: shared by all techniques with maps.
pub(crate) const SIZE: Param = Param {
    name: "size",
    help: "Width and height of a map; a light to all sides has one for each of six faces.",
    unit: "texels",
    kind: ParamKind::Int { min: 1, max: 16384, default: 1024 },
};

/// `faces`: shared by all techniques with maps.
pub(crate) const FACES: Param = Param {
    name: "faces",
    help: "Which surface the map holds: the nearest one, the nearest that faces away (closed meshes only), or the \
           middle between the nearest two.",
    unit: "",
    kind: ParamKind::Choice { values: &["front", "back", "midpoint"] },
};

/// `focus`: shared by all techniques with maps.
pub(crate) const FOCUS: Param = Param {
    name: "focus",
    help: "What the map covers: what the camera sees of the receivers, or all that the light reaches (steady under a \
           moving camera).",
    unit: "",
    kind: ParamKind::Choice { values: &["visible", "light"] },
};

/// `bias`: shared by all techniques with maps.
pub(crate) const BIAS: Param = Param {
    name: "bias",
    help: "Multiplies the automatic depth bias; for experiments, 1 is right.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 100.0, default: 1.0 },
};

shader_struct! {
    /// What the vertex shader of a map needs.
    pub(crate) struct MapView {
        clip_from_world: [[f32; 4]; 4],
        same: [f32; 2],
        pad: [f32; 2],
    }
}

/// A technique that renders depth maps and looks them up in one full-screen pass; techniques differ in the shader.
pub(crate) struct MapTechnique {
    maps: DepthMaps,
    stage: Option<Box<dyn Stage>>,
    lookup: Lookup,
    draws: u32,
}

impl MapTechnique {
    /// `reach_texels`: how far the shader looks around a receiver in the map. `constants` override the shader's.
    pub(crate) fn new(
        gpu: &Gpu,
        settings: &Settings,
        shader: &Shader,
        reach_texels: f64,
        constants: &[(&'static str, f64)],
    ) -> Result<Self, Error> {
        Self::staged(gpu, settings, shader, reach_texels, constants, None)
    }

    /// With a stage between the maps and the look-up, whose bind group is group 2 of the shader.
    pub(crate) fn staged(
        gpu: &Gpu,
        settings: &Settings,
        shader: &Shader,
        reach_texels: f64,
        constants: &[(&'static str, f64)],
        stage: Option<Box<dyn Stage>>,
    ) -> Result<Self, Error> {
        let maps = DepthMaps::new(gpu, settings, reach_texels)?;
        let more = stage.as_ref().map(|s| s.layout().clone());
        let lookup = Lookup::new(gpu, shader, settings.float("bias"), constants, more);
        Ok(Self { maps, stage, lookup, draws: 0 })
    }

    /// Looks up in two phases, see `wgsl/map_quick.wgsl`.
    pub(crate) fn in_phases(mut self) -> Self {
        self.lookup.in_phases();
        self
    }

    /// Keeps room around the maps for what hides the light's rim from receivers at their border.
    pub(crate) fn soft(mut self) -> Self {
        self.maps.soft = true;
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
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.draws = self.maps.record(passes, view.casters) + 1;
        let mut more = None;
        if let Some(stage) = &mut self.stage {
            self.draws += stage.record(passes, &self.maps);
            more = stage.bind_group();
        }
        self.lookup.record(passes, view.receivers, more, visibility);
        Ok(())
    }

    fn stats(&self) -> Stats {
        let mut stats = self.maps.stats();
        stats.draws = self.draws;
        stats.triangles += 1;
        stats.bytes += self.lookup.bytes() + self.stage.as_ref().map_or(0, |s| s.bytes());
        stats
    }

    fn light_views(&self) -> &[LightView] {
        &self.maps.views
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        let Some(textures) = &self.maps.textures else { return Vec::new() };
        let texture = textures.result();
        let layers = self.maps.views.iter();
        let maps = layers.map(|v| DebugView { name: LAYER_NAMES[v.layer as usize % 6], texture, layer: v.layer });
        maps.chain(self.stage.iter().flat_map(|s| s.debug_views())).collect()
    }
}

/// Maps of one light.
pub(crate) struct DepthMaps {
    pub(crate) size: u32,
    midpoint: bool,
    focus: Focus,
    border_texels: f64,
    /// Draws casters too that can shadow nothing: for the baseline.
    every_caster: bool,
    /// Keeps room for the light's extent.
    soft: bool,
    pipelines: Pipelines,
    textures: Option<Textures>,
    scene: FitScene,
    pub(crate) views: Vec<LightView>,
    pub(crate) is_cube: bool,
    layers: Vec<Layer>,
    triangles: u64,
}

/// What one layer draws.
#[derive(Default)]
struct Layer {
    list: DrawList,
    uniform: MapView,
}

impl DepthMaps {
    fn new(gpu: &Gpu, settings: &Settings, reach_texels: f64) -> Result<Self, Error> {
        let size = settings.int("size").clamp(1, i64::from(u32::MAX)) as u32;
        gpu.check_size("a shadow map", size, size)?;
        let faces = settings.choice("faces");
        Ok(Self {
            size,
            midpoint: faces == "midpoint",
            focus: if settings.choice("focus") == "light" { Focus::Light } else { Focus::Visible },
            border_texels: reach_texels + 1.0,
            every_caster: false,
            soft: false,
            pipelines: Pipelines::new(gpu, faces == "back", faces == "midpoint"),
            textures: None,
            scene: FitScene::default(),
            views: Vec::new(),
            is_cube: false,
            layers: Vec::new(),
            triangles: 0,
        })
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) -> Result<(), Error> {
        self.scene.casters.clear();
        self.scene.casters.extend(view.casters.casting_bounds());
        self.scene.receivers.clear();
        self.scene.receivers.extend(view.casters.receiving_bounds());
        let mut to_fit = Fit { focus: self.focus, size: self.size, border_texels: self.border_texels };
        self.views.clear();
        if !view.light.casts || self.scene.casters.is_empty() {
            return Ok(());
        }
        self.is_cube = fit(&view.light.shape, &view.camera, &self.scene, &to_fit, &mut self.views);
        if self.soft && !self.views.is_empty() {
            to_fit.border_texels += uniforms::light_border(&view.light.shape, self);
            self.is_cube = fit(&view.light.shape, &view.camera, &self.scene, &to_fit, &mut self.views);
        }
        if self.views.is_empty() {
            return Ok(());
        }
        let layer_count = if self.is_cube { 6 } else { 1 };
        self.layers.resize_with(layer_count.max(self.layers.len()), Layer::default);
        if self.textures.as_ref().is_none_or(|t| t.layers() < layer_count as u32) {
            self.textures = Some(Textures::new(gpu, &self.pipelines, self.size, layer_count as u32, self.midpoint));
        }
        let receivers = self.scene.receivers.iter().fold(Bounds::EMPTY, |b, r| b.union(*r));
        let center = view.light.shape.center();
        let which =
            if self.every_caster { Which::Casting } else { Which::Shadowing(casters::Light { center, receivers }) };
        for light_view in &self.views {
            let perspective = self.is_perspective(light_view);
            let layer = &mut self.layers[light_view.layer as usize];
            let frustum = Frustum::of(&light_view.clip_from_world);
            layer.list.fill(gpu, view.casters, which, &frustum);
            let clip_from_world = light_view.clip_from_world * DMat4::from_translation(view.casters.origin());
            layer.uniform = MapView {
                clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
                same: if perspective { [1e-5, 0.0] } else { [0.0, 1e-7] },
                pad: [0.0; 2],
            };
        }
        Ok(())
    }

    /// Renders the maps; returns the number of draws.
    fn record(&mut self, passes: &mut Passes<'_>, casters: &Casters) -> u32 {
        let Some(textures) = &self.textures else { return 0 };
        let (mut draws, mut triangles) = (0, 0);
        for view in &self.views {
            let layer = &self.layers[view.layer as usize];
            let i = view.layer as usize;
            passes.upload(&textures.uniforms[i].0, bytemuck::bytes_of(&layer.uniform));
            layer.list.upload(passes);
            let rounds = self.pipelines.record(passes, casters, &layer.list, textures, i, self.is_perspective(view));
            draws += rounds * layer.list.draws();
            triangles += u64::from(rounds) * layer.list.triangles(casters);
        }
        self.triangles = triangles;
        draws
    }

    /// Largest coordinate that the vertex shader computes with, metres: what rounding goes by.
    fn largest_coordinate(&self, view: &View<'_>) -> f64 {
        let origin = view.casters.origin();
        let around = |b: &Bounds| (b.min - origin).abs().max((b.max - origin).abs()).max_element();
        let center = view.light.shape.center();
        let light = (center.truncate() - origin).abs().max_element() * center.w;
        self.scene.casters.iter().map(around).fold(light, f64::max)
    }

    /// The texture that is looked up, once there is one.
    pub(crate) fn result(&self) -> Option<&wgpu::Texture> {
        self.textures.as_ref().map(Textures::result)
    }

    /// True where this frame's views are from a point.
    pub(crate) fn from_a_point(&self) -> bool {
        self.views.first().is_some_and(|v| self.is_perspective(v))
    }

    /// True for views from a point.
    pub(crate) fn is_perspective(&self, view: &LightView) -> bool {
        view.clip_from_world.row(3).truncate().length_squared() > 0.0
    }

    fn stats(&self) -> Stats {
        let drawn = self.views.iter().map(|v| &self.layers[v.layer as usize].list);
        Stats {
            draws: 0,
            triangles: self.triangles,
            casters_drawn: drawn.clone().map(DrawList::drawn).sum(),
            casters_culled: drawn.map(|l| l.culled).sum(),
            bytes: self.layers.iter().map(|l| l.list.bytes()).sum::<u64>()
                + self.textures.as_ref().map_or(0, Textures::bytes),
        }
    }
}

/// The textures of a light's maps and the buffers that go with each layer.
pub(crate) struct Textures {
    first: wgpu::Texture,
    /// Second surface and midpoint, for `faces = midpoint`.
    midpoint: Option<(wgpu::Texture, wgpu::Texture)>,
    /// For each layer the view uniform and its bind group.
    uniforms: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
    layers: Vec<LayerViews>,
}

/// Views and bind groups of one layer.
struct LayerViews {
    first: wgpu::TextureView,
    second: Option<SecondViews>,
}

struct SecondViews {
    second: wgpu::TextureView,
    midpoint: wgpu::TextureView,
    /// The first map, for the pass that renders the second surface.
    read_first: wgpu::BindGroup,
    /// Both maps, for the pass that takes their mean.
    read_both: wgpu::BindGroup,
}

impl Textures {
    fn new(gpu: &Gpu, pipelines: &Pipelines, size: u32, layers: u32, midpoint: bool) -> Self {
        let texture = |label| target_texture(gpu, label, (size, size), layers, FORMAT);
        let layer_view = |texture: &wgpu::Texture, layer| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let first = texture("shadow map");
        let midpoint = midpoint.then(|| (texture("second surface"), texture("midpoint")));
        let views = (0..layers).map(|i| {
            let first = layer_view(&first, i);
            let second = midpoint.as_ref().map(|(second, mid)| {
                let (second, midpoint) = (layer_view(second, i), layer_view(mid, i));
                let read_first = pipelines.read_first(gpu, &first);
                let read_both = pipelines.read_both(gpu, &first, &second);
                SecondViews { second, midpoint, read_first, read_both }
            });
            LayerViews { first, second }
        });
        let layers = views.collect();
        let uniforms = (0..first.depth_or_array_layers()).map(|_| pipelines.view_uniform(gpu)).collect();
        Self { first, midpoint, uniforms, layers }
    }

    fn layers(&self) -> u32 {
        self.first.depth_or_array_layers()
    }

    /// The texture that is looked up.
    pub(crate) fn result(&self) -> &wgpu::Texture {
        self.midpoint.as_ref().map_or(&self.first, |(_, midpoint)| midpoint)
    }

    fn bytes(&self) -> u64 {
        let count = if self.midpoint.is_some() { 3 } else { 1 };
        let texels = u64::from(self.first.width()) * u64::from(self.first.height()) * u64::from(self.layers());
        texels * 4 * count + self.uniforms.iter().map(|(b, _)| b.size()).sum::<u64>()
    }
}

/// Bytes and kinds common to the techniques of this family: every kind of light, soft ones hard from their centre.
pub(crate) const LIGHTS: LightKinds = LightKinds::of(&LightKind::ALL);
