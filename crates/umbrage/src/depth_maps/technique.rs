//! The technique that all of this family are: it fits, draws, runs its stage and looks up.

use super::draw::Drawer;
use super::fit::{Fitter, Views};
use super::frame::MapFrame;
use super::layers::{LAYER_NAMES, Layers};
use super::lookup::{Lookup, LookupInput};
use super::setup::{Depth, Faces, MapSetup};
use super::stages::{SplitFitter, Stage};
use crate::{
    casters::refuse_host_casters,
    error::Error,
    gpu::Gpu,
    inline::Lent,
    passes::Passes,
    settings::Settings,
    shader::Shader,
    technique::{DebugView, InOrder, Inside, Stats, Technique},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::light_view::LightView;

/// A technique that draws depth maps and looks them up in one full-screen pass. Techniques differ
/// in the shader, which needs the module `map_visibility` and says which share of a point is lit,
/// and in the stage between the two, if they have one.
pub struct MapTechnique {
    setup: MapSetup,
    frame: MapFrame,
    fit: Fitter,
    draw: Drawer,
    /// For splits that are fitted on the GPU.
    fitter: Option<SplitFitter>,
    stage: Option<Box<dyn Stage>>,
    lookup: Lookup,
    input: LookupInput,
    draws: u32,
    /// Bytes of the maps that a look-up reads, where the technique has said.
    texel_bytes: Option<u64>,
}

/// Bytes of depth and packed normal that every look-up reads of a receiver.
pub(crate) const RECEIVER_BYTES: u64 = 8;

impl MapTechnique {
    /// `reach_texels`: how far the shader looks around a receiver in the map. `constants` override
    /// the shader's.
    pub fn new(
        gpu: &Gpu,
        setup: &MapSetup,
        shader: &Shader,
        reach_texels: f64,
        constants: &[(&'static str, f64)],
    ) -> Result<Self, Error> {
        Self::staged(gpu, setup, shader, reach_texels, constants, None)
    }

    /// With a stage between the maps and the look-up, whose bind group is group 2 of the shader.
    pub fn staged(
        gpu: &Gpu,
        setup: &MapSetup,
        shader: &Shader,
        reach_texels: f64,
        constants: &[(&'static str, f64)],
        stage: Option<Box<dyn Stage>>,
    ) -> Result<Self, Error> {
        let MapSetup { size, faces, bias, .. } = *setup;
        gpu.check_size("a shadow map", size, size)?;
        let fit = Fitter::new(Views::of(setup));
        let more = stage.as_ref().map(|s| s.layout().clone());
        let classic = ("CLASSIC", f64::from(u8::from(bias.offsets().is_some())));
        let constants = [constants, &[classic]].concat();
        let lookup = Lookup::new(gpu, shader, fit.choice.blend(), &constants, more);
        let mut input = LookupInput::new(gpu, bias);
        let fitter = fit.choice.is_fitted_to_depth().then(|| SplitFitter::new(gpu, &mut input));
        Ok(Self {
            setup: *setup,
            frame: MapFrame { size, border_texels: reach_texels + 1.0, held: setup.held, ..MapFrame::default() },
            fitter,
            draw: Drawer::new(gpu, faces == Faces::Back, faces == Faces::Midpoint, caches(setup, &fit.choice)),
            fit,
            stage,
            lookup,
            input,
            draws: 0,
            texel_bytes: None,
        })
    }

    /// Whether the pipelines and the stage are right for `new`, too.
    fn can_take(&self, new: &MapSetup) -> bool {
        let fixed = |setup: &MapSetup| {
            let views = Views::of(setup);
            (
                setup.faces,
                setup.softness,
                setup.held,
                views.blend(),
                views.is_fitted_to_depth(),
                setup.bias.offsets().is_some(),
            )
        };
        let any_size = self.stage.as_ref().is_none_or(|stage| stage.takes_any_size());
        fixed(&self.setup) == fixed(new) && (any_size || self.setup.size == new.size)
    }

    /// Looks up in two phases, see `map_quick.wgsl`.
    pub fn in_phases(mut self) -> Self {
        self.lookup.in_phases();
        self
    }

    /// All of a frame but the look-up.
    fn draw_maps(&mut self, passes: &mut Passes<'_>, view: &View<'_>) {
        self.input.upload(passes);
        if let Some(fitter) = self.fitter.as_ref().filter(|_| self.frame.matrices.is_some()) {
            fitter.record(passes, view.receivers);
        }
        self.draws = self.draw.record(passes, view.casters, &self.frame);
        if let Some(stage) = &mut self.stage {
            self.draws += stage.record(passes, &self.frame, view.casters);
        }
    }

    /// With pictures over the scene, see `map_picture.wgsl`, by their names among
    /// [`crate::TechniqueInfo::views`]. The shader's constants are those of the look-up.
    pub fn with_pictures(mut self, gpu: &Gpu, shader: &Shader, names: &'static [&'static str]) -> Self {
        self.lookup.with_pictures(gpu, shader, names);
        self
    }

    /// Keeps room around the maps for what hides the light's rim from receivers at their border.
    pub fn soft(mut self) -> Self {
        self.fit.soft = true;
        self
    }

    /// Says how many bytes of the maps a look-up reads at most, four for each texel of depth.
    pub fn reading(mut self, bytes: u64) -> Self {
        self.texel_bytes = Some(bytes);
        self
    }

    /// Draws the back faces of all casters.
    pub fn with_back_faces(mut self) -> Self {
        self.draw.draw_back_faces();
        self
    }

    /// Also draws casters into the maps that can shadow nothing.
    pub fn with_every_caster(mut self) -> Self {
        self.draw.every_caster = true;
        self
    }
}

impl MapTechnique {
    /// Hosts draw by a matrix, and depth as the rasteriser has it, once.
    fn check_host_casters(&self) -> Result<(), Error> {
        if self.stage.as_ref().is_some_and(|stage| stage.needs_edges()) {
            return refuse_host_casters("it draws their edges");
        }
        if self.setup.faces == Faces::Midpoint {
            return refuse_host_casters("`faces = midpoint` draws casters twice");
        }
        if self.frame.is_linear {
            return refuse_host_casters("`depth = linear` has shaders write depth");
        }
        if self.frame.views.iter().any(|view| view.paraboloid.is_some()) {
            return refuse_host_casters("`omni = dual-paraboloid` bends them");
        }
        Ok(())
    }
}

impl Technique for MapTechnique {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        self.fit.prepare(view, self.setup.depth == Depth::Linear, &mut self.frame);
        if view.casters.has_host_casters() {
            self.check_host_casters()?;
        }
        let fitter = self.fitter.as_ref().filter(|_| matches!(self.frame.layers, Layers::Splits(_)));
        self.frame.matrices = fitter.map(|fitter| fitter.matrices().clone());
        self.draw.prepare(gpu, view, &mut self.frame);
        if let Some(stage) = &mut self.stage {
            stage.prepare(gpu, view, &self.frame)?;
        }
        self.lookup.prepare(gpu, view, &self.frame, &mut self.input);
        if let (Some(fitter), Some(cascades)) = (&mut self.fitter, self.fit.choice.cascades()) {
            fitter.prepare(view, &self.frame, cascades);
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
        self.draw_maps(passes, view);
        let more = self.stage.as_ref().and_then(|stage| stage.bind_group());
        self.draws += self.lookup.record(passes, view.receivers, &self.input, more, visibility);
        Ok(())
    }

    fn record_maps(&mut self, passes: &mut Passes<'_>, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        self.draw_maps(passes, view);
        Ok(())
    }

    fn set_frame(&mut self, frame: u32) {
        self.input.set_frame(frame);
    }

    fn draws_host_casters(&self) -> bool {
        true
    }

    fn lend(&mut self, gpu: &Gpu) -> Result<Lent, Error> {
        let bindings = match &self.stage {
            None => Vec::new(),
            Some(stage) if stage.bind_group().is_some() => stage.lends().ok_or_else(|| Error::Unsupported {
                technique: "this technique".into(),
                what: "shaders of hosts, since its stage lends nothing".into(),
            })?,
            Some(_) => Vec::new(),
        };
        Ok(self.lookup.lend(gpu, self.frame.texture.as_ref(), &mut self.input, bindings))
    }

    fn set(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, Error> {
        let Some(setup) = settings.maps().filter(|new| self.can_take(new)) else { return Ok(false) };
        gpu.check_size("a shadow map", setup.size, setup.size)?;
        self.fit.choice = Views::of(&setup);
        self.draw.set_cache(caches(&setup, &self.fit.choice));
        self.input.set_bias(setup.bias);
        self.frame.size = setup.size;
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
        self.draw.forget();
    }

    fn stats(&self) -> Stats {
        let mut stats = self.draw.stats(&self.frame);
        stats.draws = self.draws;
        stats.triangles += 1;
        stats.bytes += self.fitter.as_ref().map_or(0, SplitFitter::bytes);
        stats.bytes += self.lookup.bytes() + self.input.bytes() + self.stage.as_ref().map_or(0, |s| s.bytes());
        stats
    }

    fn light_views(&self) -> &[LightView] {
        &self.frame.views
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        match pass {
            "map" => Some(0),
            "second surface" => Some(4),
            "midpoint" => Some(8),
            "visibility" => self.texel_bytes.map(|bytes| RECEIVER_BYTES + bytes),
            _ => self.stage.as_ref()?.reads(pass),
        }
    }

    fn split_distances(&self) -> &[f64] {
        self.frame.borders.get(1..self.frame.borders.len().saturating_sub(1)).unwrap_or_default()
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.lookup.inspect(view);
        if let Some(stage) = &mut self.stage {
            stage.inspect(view);
        }
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        let Some(texture) = &self.frame.texture else { return Vec::new() };
        let layers = self.frame.views.iter();
        let maps = layers.map(|v| DebugView {
            name: LAYER_NAMES[v.layer as usize % LAYER_NAMES.len()],
            texture,
            layer: v.layer,
        });
        maps.chain(self.stage.iter().flat_map(|s| s.debug_views())).chain(self.lookup.picture()).collect()
    }
}

/// Whether maps are kept. What is fitted on the GPU is another view in every frame.
fn caches(setup: &MapSetup, choice: &Views) -> bool {
    setup.cache && !choice.is_fitted_to_depth()
}
