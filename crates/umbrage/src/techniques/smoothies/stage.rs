//! The stage that draws smoothies into the light's views.

use super::light::{SmoothieLight, farthest_depth};
use super::targets::{DEPTH, Layered, SHARE, layer_of};
use super::{FINS, Geometry, Smoothies, VIEWS};
use crate::area_light::Form;
use crate::casters::Casters;
use crate::depth_maps::{EdgeDraw, EdgePass, EdgeTarget, LAYER_NAMES, MapFrame, Stage};
use crate::fullscreen::{self, FLOATS, UNIFORM, attachment, bind, layout};
use crate::technique::DebugView;
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};

/// Ways to draw the edges, in the order that they are drawn in.
const DRAWS: [(&str, &str); 3] = [("fin_depth", "smoothie depth"), ("fin_share", "smoothies"), ("fin_alpha", "alpha")];
/// That of [`DRAWS`] which is only looked at.
const ALPHA: usize = 2;

/// Draws smoothies: their nearest depth, then the least share of light.
pub(super) struct SmoothieStage {
    /// As wide as the light; else some texels.
    follows_light: bool,
    remap: bool,
    pass: EdgePass,
    layout: wgpu::BindGroupLayout,
    of_fins: wgpu::BindGroupLayout,
    made: Option<Made>,
    /// By number of the view in the frame.
    lights: Vec<SmoothieLight>,
    /// By layer: what it was drawn for.
    drawn: Vec<Option<(u64, SmoothieLight)>>,
    /// Nothing has a fin.
    is_hard: bool,
    shows_alpha: bool,
}

/// What was made for one texture of maps.
struct Made {
    maps: wgpu::Texture,
    depth: Layered,
    share: Layered,
    /// When it is looked at.
    alpha: Option<Layered>,
    /// By layer: the light, and what fins read.
    lights: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
    look_up: wgpu::BindGroup,
}

impl SmoothieStage {
    pub fn new(gpu: &Gpu, settings: &Smoothies) -> Self {
        let switch = |on: bool| f64::from(u8::from(on));
        let constants = [
            ("WIDTH", settings.width),
            ("REMAP", switch(settings.remap)),
            ("CONES", switch(settings.geometry == Geometry::Cones)),
        ];
        let array = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let depth = wgpu::TextureSampleType::Depth;
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let of_fins = layout(gpu, "fins", stages, &[UNIFORM, fullscreen::texture(depth)]);
        let fragment = wgpu::ShaderStages::FRAGMENT;
        Self {
            follows_light: settings.width == 0.0,
            remap: settings.remap,
            pass: EdgePass::new(gpu, &FINS, Some(&of_fins), &constants, DRAWS.map(|(entry, _)| draw(entry)).into()),
            layout: layout(gpu, "smoothies", fragment, &[array(depth), array(FLOATS)]),
            of_fins,
            made: None,
            lights: Vec::new(),
            drawn: Vec::new(),
            is_hard: false,
            shows_alpha: false,
        }
    }

    /// Textures for the maps, where there are none.
    fn make(&mut self, gpu: &Gpu, maps: &wgpu::Texture) {
        let is_right = |made: &Made| made.maps == *maps && (made.alpha.is_some() || !self.shows_alpha);
        if self.made.as_ref().is_some_and(is_right) {
            return;
        }
        let depth = Layered::new(gpu, "smoothie depth", maps, DEPTH);
        let share = Layered::new(gpu, "smoothies", maps, SHARE);
        let resources = [depth.whole(), share.whole()];
        let resources = resources.each_ref().map(wgpu::BindingResource::TextureView);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let count = maps.depth_or_array_layers();
        let light = |layer: u32| {
            let buffer = gpu.buffer("light of smoothies", &[SmoothieLight::default()], usage);
            let map = layer_of(maps, layer);
            let resources = [buffer.as_entire_binding(), wgpu::BindingResource::TextureView(&map)];
            let group = bind(gpu, "fins", &self.of_fins, &resources);
            (buffer, group)
        };
        self.made = Some(Made {
            maps: maps.clone(),
            alpha: self.shows_alpha.then(|| Layered::new(gpu, "alpha", maps, SHARE)),
            lights: (0..count).map(light).collect(),
            look_up: bind(gpu, "smoothies", &self.layout, &resources),
            depth,
            share,
        });
        self.drawn.clear();
        self.drawn.resize(count as usize, None);
    }
}

/// The nearest is kept of depth, and the least of what is a share of light.
fn draw(entry: &'static str) -> EdgeDraw {
    let least = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Min,
    };
    let blend = Some(wgpu::BlendState { color: least, alpha: least });
    let nearest = wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Greater),
        stencil: Default::default(),
        bias: Default::default(),
    };
    let is_depth = entry == DRAWS[0].0;
    EdgeDraw {
        vertex: "fin",
        fragment: Some(entry),
        targets: if is_depth { Vec::new() } else { vec![Some(wgpu::ColorTargetState { blend, ..SHARE.into() })] },
        depth_stencil: is_depth.then_some(nearest),
    }
}

impl Stage for SmoothieStage {
    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &MapFrame) -> Result<(), Error> {
        let Some(maps) = &frame.texture else { return Ok(()) };
        self.make(gpu, maps);
        let shape = &view.light.shape;
        let form = Form::of(shape, false, 0.0);
        self.is_hard = self.follows_light && form.is_point();
        // Without remapping, every receiver is as if it were infinitely far away.
        let is_far = !self.remap || self.shows_alpha;
        self.lights.clear();
        self.lights.extend(frame.views.iter().map(|light_view| {
            let farthest = if is_far { 0.0 } else { farthest_depth(light_view, &frame.scene.receivers) };
            SmoothieLight::new(&form, view.casters.origin(), farthest)
        }));
        if self.is_hard {
            return Ok(());
        }
        self.pass.prepare(gpu, view.casters, shape.center(), &frame.views, frame)
    }

    fn record(&mut self, passes: &mut Passes<'_>, frame: &MapFrame, casters: &Casters) -> u32 {
        let Some(made) = &self.made else { return 0 };
        let is_new = |(i, light): (usize, &SmoothieLight)| {
            let layer = frame.views[i].layer;
            let now = Some((frame.version(layer), *light));
            let is_new = self.drawn.get(layer as usize) != Some(&now);
            is_new.then_some((i, layer as usize))
        };
        let new: Vec<_> = self.lights.iter().enumerate().filter_map(is_new).collect();
        if new.is_empty() {
            return 0;
        }
        if !self.is_hard {
            self.pass.find(passes, casters, frame);
        }
        let mut draws = 0;
        for (i, layer) in new {
            let light = self.lights[i];
            passes.upload(&made.lights[layer].0, bytemuck::bytes_of(&light));
            for (number, (_, label)) in DRAWS.iter().enumerate() {
                draws += made.record(passes, casters, (&self.pass, self.is_hard), (i, layer), (number, *label));
            }
            self.drawn[layer] = Some((frame.version(frame.views[i].layer), light));
        }
        draws
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.made.as_ref().map(|made| &made.look_up)
    }

    fn bytes(&self) -> u64 {
        let made = self.made.as_ref().map_or(0, |made| {
            let textures = [&made.depth, &made.share].into_iter().chain(&made.alpha);
            let lights = made.lights.iter().map(|(buffer, _)| buffer.size());
            textures.map(Layered::bytes).sum::<u64>() + lights.sum::<u64>()
        });
        self.pass.bytes() + made
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.shows_alpha = view.is_some_and(|name| name.starts_with("alpha-before"));
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        let Some(made) = &self.made else { return Vec::new() };
        let mut views = Vec::new();
        let shown = [Some(&made.depth), made.alpha.as_ref(), Some(&made.share)];
        for (layered, names) in shown.into_iter().zip(VIEWS[LAYER_NAMES.len()..].chunks(LAYER_NAMES.len())) {
            let Some(texture) = layered.map(|layered| &layered.texture) else { continue };
            let layers = (0..texture.depth_or_array_layers()).zip(names);
            views.extend(layers.map(|(layer, name)| DebugView { name, texture, layer }));
        }
        views
    }
}

impl Made {
    /// Draws one of [`DRAWS`] into a layer; nothing stands on any edge where all is hard.
    fn record(
        &self,
        passes: &mut Passes<'_>,
        casters: &Casters,
        (pass, is_hard): (&EdgePass, bool),
        (view, layer): (usize, usize),
        (number, label): (usize, &str),
    ) -> u32 {
        let share = if number == ALPHA { self.alpha.as_ref() } else { Some(&self.share) };
        let (colors, depth) = if number == 0 {
            let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store });
            let view = &self.depth.layers[layer];
            (None, Some(wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }))
        } else {
            let Some(share) = share else { return 0 };
            (attachment(&share.layers[layer], wgpu::LoadOp::Clear(wgpu::Color::WHITE)), None)
        };
        let colors = if number == 0 { Vec::new() } else { vec![colors] };
        if is_hard {
            drop(passes.render(label, &colors, depth));
            return 0;
        }
        let own = Some(&self.lights[layer].1);
        pass.record(passes, casters, (view, number), own, EdgeTarget { label, colors: &colors, depth })
    }
}
