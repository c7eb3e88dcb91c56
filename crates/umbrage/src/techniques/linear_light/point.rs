//! One point of the light: its maps, the steps in them and its channels.

use super::borders::{Borders, neighbours};
use super::channel::{Channel, channels};
use super::lookup::Pipelines;
use super::steps::StepList;
use super::uniform::{LightPoint, PointLookup};
use crate::depth_maps::{EdgePass, MapSetup, PointMaps};
use crate::gpu::Gpu;

/// Texels that are looked at around a receiver's place.
const REACH_TEXELS: f64 = 0.5;

/// A point of the light.
pub(super) struct Point {
    pub maps: PointMaps,
    pub uniform: wgpu::Buffer,
    pub data: LightPoint,
    pub look_up_uniform: wgpu::Buffer,
    pub look_up_data: PointLookup,
    /// For each neighbour the edges that it sees, with `edges = silhouettes`.
    pub edges: Vec<EdgePass>,
    made: Option<Made>,
    /// Whether it had maps when steps were last found in them, and their versions.
    taken: (bool, Vec<u64>),
}

/// What goes with the textures of the maps.
pub(super) struct Made {
    pub maps: wgpu::Texture,
    /// For `edges = map`: the steps in them, and what skins are made of.
    pub steps: Option<(StepList, wgpu::BindGroup)>,
    /// To the next point, if there is one, and to the one before.
    pub channels: Vec<Channel>,
    pub shares: wgpu::Texture,
    /// What the point before sees.
    before: Option<wgpu::TextureView>,
    pub look_up: wgpu::BindGroup,
}

impl Point {
    pub fn new(gpu: &Gpu, setup: &MapSetup) -> Self {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            maps: PointMaps::new(gpu, setup, REACH_TEXELS),
            uniform: gpu.buffer("point of a light", &[LightPoint::default()], usage),
            data: LightPoint::default(),
            look_up_uniform: gpu.buffer("shares of a point", &[PointLookup::default()], usage),
            look_up_data: PointLookup::default(),
            edges: Vec::new(),
            made: None,
            taken: (false, Vec::new()),
        }
    }

    /// Makes room for channels to the neighbours that point `i` of `count` has.
    pub fn make_room(&mut self, gpu: &Gpu, borders: &Borders, pipelines: &Pipelines, (i, count): (usize, usize)) {
        let (neighbours, before) = (neighbours(i, count).count(), pipelines.before(i).filter(|_| count > 1));
        let frame = self.maps.frame();
        let Some(maps) = frame.texture.as_ref().filter(|_| !frame.views.is_empty()) else { return };
        let fits =
            |made: &Made| made.maps == *maps && made.channels.len() == neighbours && made.before.as_ref() == before;
        if self.made.as_ref().is_some_and(fits) {
            return;
        }
        let view = maps.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let shared = [wgpu::BindingResource::TextureView(&view), self.uniform.as_entire_binding()];
        let steps = borders.steps.as_ref().filter(|_| neighbours > 0).map(|(steps, skins)| {
            let list = steps.list(gpu, &view, frame.size);
            let source = skins.bind(gpu, &list, shared.clone());
            (list, source)
        });
        let (shares, channels) = channels(gpu, &borders.into, maps, shared, neighbours as u32);
        self.made = Some(Made {
            look_up: pipelines.bind(gpu, &self.look_up_uniform, &shares, before),
            before: before.cloned(),
            maps: maps.clone(),
            steps,
            channels,
            shares,
        });
        self.taken.1.clear();
    }

    /// What was made for its maps; `None` while it has none.
    pub fn made(&self) -> Option<&Made> {
        self.made.as_ref().filter(|_| !self.maps.frame().views.is_empty())
    }

    /// The layers of its maps.
    pub fn layers(&self) -> impl Iterator<Item = u32> + '_ {
        self.maps.frame().views.iter().map(|view| view.layer)
    }

    /// Its maps are others than those that steps were found in.
    pub fn is_new(&self) -> bool {
        let (had_maps, versions) = &self.taken;
        versions.is_empty() || *had_maps != self.made().is_some() || *versions != self.maps.frame().versions
    }

    /// Steps were found in its maps, and skins drawn.
    pub fn take(&mut self) {
        self.taken.0 = self.made().is_some();
        self.taken.1.clear();
        self.taken.1.extend(&self.maps.frame().versions);
    }

    /// Nothing is kept.
    pub fn forget(&mut self) {
        self.maps.forget();
        self.taken.1.clear();
    }

    pub fn bytes(&self) -> u64 {
        let made = self.made.as_ref().map_or(0, |made| {
            let texels = u64::from(made.shares.width()) * u64::from(made.shares.height());
            let steps = made.steps.as_ref().map_or(0, |(list, _)| list.bytes());
            steps + 2 * texels * u64::from(made.shares.depth_or_array_layers())
        });
        let edges = self.edges.iter().map(EdgePass::bytes).sum::<u64>();
        self.maps.stats().bytes + self.uniform.size() + self.look_up_uniform.size() + edges + made
    }
}
