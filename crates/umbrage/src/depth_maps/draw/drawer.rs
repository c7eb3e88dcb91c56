//! Draws the maps of a light, frame by frame.

use super::cache::{Frame, Work};
use super::layer::{Layer, Lists};
use super::movers::Movers;
use super::pipelines::{Kind, Pipelines};
use super::textures::Textures;
use super::view::MapView;
use crate::casters::{self, CasterView, Casters};
use crate::depth_maps::frame::MapFrame;
use crate::depth_maps::layers::Layers;
use crate::{
    gpu::Gpu,
    passes::{Kept, Passes},
    technique::Stats,
    view::View,
};
use umbrage_core::light_view::{LightView, Omni};

/// Textures, pipelines and what is known of the layers.
pub(in crate::depth_maps) struct Drawer {
    midpoint: bool,
    /// Draws casters too that can shadow nothing: for the baseline.
    pub every_caster: bool,
    pipelines: Pipelines,
    textures: Option<Textures>,
    layers: Vec<Layer>,
    lists: Lists,
    /// Keeps what did not change.
    cache: bool,
    movers: Movers,
    kept: Kept,
    /// The last frame that was prepared was recorded as well.
    recorded: bool,
    triangles: u64,
}

impl Drawer {
    pub fn new(gpu: &Gpu, back_faces: bool, midpoint: bool, cache: bool) -> Self {
        Self {
            midpoint,
            every_caster: false,
            pipelines: Pipelines::new(gpu, back_faces, midpoint),
            textures: None,
            layers: Vec::new(),
            lists: Lists::new(midpoint),
            cache,
            movers: Movers::default(),
            kept: Kept::default(),
            recorded: false,
            triangles: 0,
        }
    }

    /// Draws the back faces of all casters.
    pub fn draw_back_faces(&mut self) {
        self.lists.backs = true;
    }

    /// Keeps what did not change, or draws everything in every frame.
    pub fn set_cache(&mut self, cache: bool) {
        self.cache = cache;
        self.forget();
    }

    /// Nothing that was drawn is kept.
    pub fn forget(&mut self) {
        self.layers.iter_mut().for_each(Layer::forget);
    }

    /// Chooses what the layers draw, and makes room for it.
    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &mut MapFrame) {
        let known = self.cache && self.movers.update(view.casters);
        // None of them is to be asked in vain.
        if [known, std::mem::take(&mut self.recorded), self.kept.holds()].contains(&false) {
            self.forget();
        }
        let unseen = (0..).zip(&mut self.layers).filter(|(i, _)| !frame.views.iter().any(|view| view.layer == *i));
        unseen.for_each(|(_, layer)| layer.forget());
        if !frame.views.is_empty() {
            self.pipelines.prepare(gpu, kind(frame), view.casters.forms());
            self.make_room(gpu, frame);
            self.choose(gpu, view, frame);
        }
        frame.texture = self.textures.as_ref().map(|textures| textures.result().clone());
        frame.versions.clear();
        frame.versions.extend(self.layers.iter().map(|layer| layer.version));
    }

    /// Layers and textures for the views.
    fn make_room(&mut self, gpu: &Gpu, frame: &MapFrame) {
        let count = frame.layers.count();
        self.layers.resize_with(self.layers.len().max(count as usize), Layer::default);
        if self.textures.as_ref().is_none_or(|t| t.layers() < count || t.size() != frame.size) {
            self.textures = Some(Textures::new(gpu, self.pipelines.layouts(), frame.size, count, self.midpoint));
            self.forget();
        }
    }

    fn choose(&mut self, gpu: &Gpu, view: &View<'_>, map_frame: &MapFrame) {
        let casters = view.casters;
        let light = casters::Light { center: view.light.shape.center(), receivers: casters.receivers_bounds() };
        let light = Some(light).filter(|_| !self.every_caster);
        let frame = Frame { casters, movers: &self.movers, can_store: !self.midpoint };
        let frame = Some(&frame).filter(|_| self.cache);
        self.lists.numbers.clear(gpu, casters, self.layers.len() as u32);
        for light_view in &map_frame.views {
            let layer = &mut self.layers[light_view.layer as usize];
            layer.prepare(casters, frame, (map_frame, light_view), light, &mut self.lists);
            layer.uniform = MapView::new(light_view, casters.origin(), map_frame.is_linear);
            if let (Work::Over { .. }, Some(textures)) = (layer.work, &mut self.textures) {
                textures.make_store(gpu);
            }
        }
    }

    /// Renders the maps; returns the number of draws.
    pub fn record(&mut self, passes: &mut Passes<'_>, casters: &Casters, frame: &MapFrame) -> u32 {
        self.recorded = true;
        let Some(textures) = &self.textures else { return 0 };
        let (mut draws, mut triangles) = (0, 0);
        let numbers = &self.lists.numbers;
        let worked = |view: &&LightView| self.layers[view.layer as usize].work != Work::Keep;
        if self.cache {
            self.kept.note(passes);
        }
        numbers.upload(passes);
        for view in frame.views.iter().filter(worked) {
            let i = view.layer as usize;
            let layer = &self.layers[i];
            let uniform = &textures.uniforms[i].0;
            passes.upload(uniform, bytemuck::bytes_of(&layer.uniform));
            frame.take_matrix(passes, view.layer, uniform);
            let is_cropped_on_gpu = frame.matrices.is_some();
            let seen = CasterView { light_view: view, origin: casters.origin(), is_cropped_on_gpu };
            let rounds = self.pipelines.record(passes, casters, (numbers, layer), textures, &seen, kind(frame));
            draws += rounds * layer.list.draws() + layer.rest.draws();
            triangles += u64::from(rounds) * layer.list.triangles(casters) + layer.rest.triangles(casters);
        }
        self.triangles = triangles;
        draws
    }

    /// All but the number of draws.
    pub fn stats(&self, frame: &MapFrame) -> Stats {
        let layers = frame.views.iter().map(|v| &self.layers[v.layer as usize]);
        Stats {
            draws: 0,
            triangles: self.triangles,
            casters_drawn: layers.clone().map(|l| l.list.drawn() + l.rest.drawn()).sum(),
            casters_culled: layers.map(|l| l.culled).sum(),
            bytes: self.lists.numbers.bytes() + self.textures.as_ref().map_or(0, Textures::bytes),
        }
    }
}

/// What a frame's views need: all of a light are alike.
fn kind(frame: &MapFrame) -> Kind {
    let paraboloid = frame.layers == Layers::Omni(Omni::DualParaboloid);
    Kind { perspective: frame.is_from_a_point(), paraboloid, linear: frame.is_linear }
}
