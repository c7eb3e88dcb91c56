//! The stage that draws smoothies into the light's views.

use super::FINS;
use super::Geometry;
use super::Smoothies;
use super::VIEWS;
use super::light::SmoothieLight;
use super::targets::{DEPTH, LEAST, Layered};
use crate::area_light::{Face, Form};
use crate::casters::Casters;
use crate::depth_maps::{EdgeDraw, EdgePass, EdgeTarget, LAYER_NAMES, MapFrame, Stage};
use crate::fullscreen::{self, FLOATS, UNIFORM, bind, layer_view, layout};
use crate::technique::DebugView;
use crate::{Binding, Resource, error::Error, gpu::Gpu, passes::Passes, view::View};
use umbrage_core::Bounds;
use umbrage_core::glam::DVec3;

/// Where receivers may be, as far as is known.
const EVERYWHERE: Bounds = Bounds { min: DVec3::splat(-1e30), max: DVec3::splat(1e30) };

/// Draws smoothies of all casters: the least share of light, and the nearest of them.
pub(super) struct SmoothieStage {
    /// As wide as the light; else some texels.
    follows_light: bool,
    remap: bool,
    pass: EdgePass,
    layout: wgpu::BindGroupLayout,
    of_fins: wgpu::BindGroupLayout,
    made: Option<Made>,
    light: SmoothieLight,
    /// How its fins are drawn.
    draw: Draw,
    /// The same with all receivers that there could be, where somebody looks at fins.
    shown_light: Option<SmoothieLight>,
    /// By layer: what it was drawn for.
    drawn: Vec<Option<Drawn>>,
    /// Nothing has a fin.
    is_hard: bool,
    shown: Option<Shown>,
}

/// The version of a layer of the maps, the light, and whether anything has a fin.
type Drawn = (u64, SmoothieLight, bool);

/// What was made for one texture of maps.
struct Made {
    maps: wgpu::Texture,
    share: Layered,
    before: Layered,
    shown: Option<(Shown, Layered)>,
    light: wgpu::Buffer,
    /// By layer: what fins read.
    fins: Vec<wgpu::BindGroup>,
    /// Shares, and how far they are before the map.
    read: [wgpu::TextureView; 2],
    look_up: wgpu::BindGroup,
}

/// What is drawn to be looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    Depth,
    Alpha,
}

/// How edges are drawn, by number of [`EdgeDraw`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Draw {
    Sphere,
    Disc,
    Square,
    Line,
    Depth,
    Alpha,
}

impl Draw {
    const ALL: [Self; 6] = [Self::Sphere, Self::Disc, Self::Square, Self::Line, Self::Depth, Self::Alpha];

    /// Of fins, by the light's face.
    fn of(face: Face) -> Self {
        match face {
            Face::Sphere => Self::Sphere,
            Face::Disc => Self::Disc,
            Face::Square | Face::Picture => Self::Square,
            Face::Line => Self::Line,
        }
    }

    fn edges(self) -> EdgeDraw {
        let least = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Min,
        };
        let blend = Some(wgpu::BlendState { color: least, alpha: least });
        let target = Some(wgpu::ColorTargetState { blend, ..LEAST.into() });
        let nearest = wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        };
        let both = || vec![target.clone(), target.clone()];
        let (entry, targets, depth_stencil) = match self {
            Self::Sphere => ("fin_of_sphere", both(), None),
            Self::Disc => ("fin_of_disc", both(), None),
            Self::Square => ("fin_of_square", both(), None),
            Self::Line => ("fin_of_line", both(), None),
            Self::Depth => ("fin_depth", Vec::new(), Some(nearest)),
            Self::Alpha => ("fin_alpha", vec![target], None),
        };
        EdgeDraw { vertex: "fin", fragment: Some(entry), targets, depth_stencil }
    }
}

/// What the look-up reads, twice.
const ARRAY: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: FLOATS,
    view_dimension: wgpu::TextureViewDimension::D2Array,
    multisampled: false,
};

impl SmoothieStage {
    pub fn new(gpu: &Gpu, settings: &Smoothies) -> Self {
        let switch = |on: bool| f64::from(u8::from(on));
        let constants = [
            ("WIDTH", settings.width),
            ("REMAP", switch(settings.remap)),
            ("CONES", switch(settings.geometry == Geometry::Cones)),
        ];
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let map = fullscreen::texture(wgpu::TextureSampleType::Depth);
        let of_fins = layout(gpu, "fins", stages, &[UNIFORM, map]);
        Self {
            follows_light: settings.width == 0.0,
            remap: settings.remap,
            pass: EdgePass::new(gpu, &FINS, Some(&of_fins), &constants, Draw::ALL.map(Draw::edges).into()),
            layout: layout(gpu, "smoothies", wgpu::ShaderStages::FRAGMENT, &[ARRAY, ARRAY]),
            of_fins,
            made: None,
            light: SmoothieLight::default(),
            draw: Draw::Sphere,
            shown_light: None,
            drawn: Vec::new(),
            is_hard: false,
            shown: None,
        }
    }

    /// Textures for the maps, where there are none.
    fn make(&mut self, gpu: &Gpu, maps: &wgpu::Texture) {
        let is_right = |made: &Made| made.maps == *maps && made.shown.as_ref().map(|(shown, _)| *shown) == self.shown;
        if !self.made.as_ref().is_some_and(is_right) {
            self.made = Some(Made::new(gpu, maps, self.shown, [&self.of_fins, &self.layout]));
            self.drawn.clear();
            self.drawn.resize(maps.depth_or_array_layers() as usize, None);
        }
    }

    /// A box around all receivers that the maps are looked up for.
    fn receivers(&self, frame: &MapFrame) -> Bounds {
        // Without remapping, every receiver is as if it were infinitely far away.
        if !self.remap {
            return EVERYWHERE;
        }
        let around = frame.scene.receivers.iter().fold(Bounds::EMPTY, |all, one| all.union(*one));
        around.grown(1e-4 * around.largest_coordinate())
    }
}

impl Stage for SmoothieStage {
    fn needs_edges(&self) -> bool {
        true
    }

    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &MapFrame) -> Result<(), Error> {
        let Some(maps) = &frame.texture else { return Ok(()) };
        self.make(gpu, maps);
        let shape = &view.light.shape;
        let form = Form::of(shape, false, 0.0);
        self.draw = Draw::of(form.face);
        let receivers = self.receivers(frame);
        self.light = SmoothieLight::new(&form, view.casters.origin(), &receivers);
        // Who looks at fins wants to see all of them.
        self.shown_light = self.shown.map(|_| SmoothieLight::new(&form, view.casters.origin(), &EVERYWHERE));
        self.is_hard = (self.follows_light && form.is_point()) || receivers.is_empty();
        if self.is_hard {
            return Ok(());
        }
        self.pass.prepare(gpu, view.casters, shape.center(), &frame.views, frame)
    }

    fn record(&mut self, passes: &mut Passes<'_>, frame: &MapFrame, casters: &Casters) -> u32 {
        let Some(made) = &self.made else { return 0 };
        let now = |layer: u32| Some((frame.version(layer), self.light, self.is_hard));
        let is_new = |layer: u32| self.drawn.get(layer as usize) != Some(&now(layer));
        if !frame.views.iter().any(|view| is_new(view.layer)) {
            return 0;
        }
        passes.upload(&made.light, bytemuck::bytes_of(&self.light));
        if !self.is_hard {
            self.pass.find(passes, casters, frame);
        }
        let pass = Some(&self.pass).filter(|_| !self.is_hard);
        let all = |passes: &mut Passes<'_>, draw| {
            let new = frame.views.iter().enumerate().filter(|(_, view)| is_new(view.layer));
            new.map(|(i, view)| made.record(passes, pass, (i, view.layer as usize), draw)).sum::<u32>()
        };
        let mut draws = all(passes, self.draw);
        if let (Some((shown, _)), Some(light)) = (&made.shown, &self.shown_light) {
            passes.upload(&made.light, bytemuck::bytes_of(light));
            draws += all(passes, shown.draw());
        }
        for view in &frame.views {
            let now = now(view.layer);
            if let Some(drawn) = self.drawn.get_mut(view.layer as usize) {
                *drawn = now;
            }
        }
        draws
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.made.as_ref().map(|made| &made.look_up)
    }

    fn lends(&self) -> Option<Vec<Binding>> {
        let read = self.made.as_ref()?.read.clone();
        Some((0..).zip(read).map(|(i, view)| Binding::of_stage(i, ARRAY, Resource::View(view))).collect())
    }

    fn bytes(&self) -> u64 {
        self.pass.bytes() + self.made.as_ref().map_or(0, Made::bytes)
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        // A texel of the map, and both numbers that are blended over.
        (pass == "smoothies").then_some(4 + 2 + 2)
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.shown = view.and_then(|name| match name {
            _ if name.starts_with(Shown::Depth.name()) => Some(Shown::Depth),
            _ if name.starts_with(Shown::Alpha.name()) => Some(Shown::Alpha),
            _ => None,
        });
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        let Some(made) = &self.made else { return Vec::new() };
        let shown = |of: Shown| made.shown.as_ref().filter(|(shown, _)| *shown == of).map(|(_, layered)| layered);
        let of_names = [shown(Shown::Depth), shown(Shown::Alpha), Some(&made.share)];
        let mut views = Vec::new();
        for (layered, names) in of_names.into_iter().zip(VIEWS[LAYER_NAMES.len()..].chunks(LAYER_NAMES.len())) {
            let Some(texture) = layered.map(|layered| &layered.texture) else { continue };
            let layers = (0..texture.depth_or_array_layers()).zip(names);
            views.extend(layers.map(|(layer, name)| DebugView { name, texture, layer }));
        }
        views
    }
}

impl Shown {
    /// What its views are called, before the number of the layer.
    fn name(self) -> &'static str {
        match self {
            Self::Depth => "smoothie-depth-",
            Self::Alpha => "alpha-before-",
        }
    }

    fn draw(self) -> Draw {
        if self == Self::Depth { Draw::Depth } else { Draw::Alpha }
    }
}

impl Made {
    fn new(
        gpu: &Gpu,
        maps: &wgpu::Texture,
        shown: Option<Shown>,
        [of_fins, look_up]: [&wgpu::BindGroupLayout; 2],
    ) -> Self {
        let texture = |label, format| Layered::new(gpu, label, maps, format);
        let share = texture("smoothies", LEAST);
        let before = texture("before receivers", LEAST);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let light = gpu.buffer("light of smoothies", &[SmoothieLight::default()], usage);
        let fins = |layer: u32| {
            let map = layer_view(maps, layer);
            bind(gpu, "fins", of_fins, &[light.as_entire_binding(), wgpu::BindingResource::TextureView(&map)])
        };
        let read = [share.whole(), before.whole()];
        let format = |shown| if shown == Shown::Depth { DEPTH } else { LEAST };
        Self {
            maps: maps.clone(),
            shown: shown.map(|shown| (shown, texture("smoothies to be looked at", format(shown)))),
            fins: (0..maps.depth_or_array_layers()).map(fins).collect(),
            look_up: bind(gpu, "smoothies", look_up, &read.each_ref().map(wgpu::BindingResource::TextureView)),
            read,
            light,
            share,
            before,
        }
    }

    /// Draws into a layer of a view of the frame; clears it where nothing stands on any edge.
    fn record(
        &self,
        passes: &mut Passes<'_>,
        pass: Option<&EdgePass>,
        (view, layer): (usize, usize),
        draw: Draw,
    ) -> u32 {
        let shown = self.shown.as_ref().map(|(_, layered)| layered);
        let (mut colors, mut depth) = (Vec::new(), None);
        match (draw, shown) {
            (Draw::Depth, Some(shown)) => {
                let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store });
                let view = &shown.layers[layer];
                depth = Some(wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None });
            }
            (Draw::Alpha, Some(shown)) => colors.push(shown.cleared(layer, wgpu::Color::WHITE)),
            _ => {
                colors.push(self.share.cleared(layer, wgpu::Color::WHITE));
                colors.push(self.before.cleared(layer, wgpu::Color::TRANSPARENT));
            }
        }
        let Some(pass) = pass else {
            drop(passes.render("smoothies", &colors, depth));
            return 0;
        };
        let target = EdgeTarget { label: "smoothies", colors: &colors, depth };
        pass.record(passes, (view, draw as usize), Some(&self.fins[layer]), target)
    }

    fn bytes(&self) -> u64 {
        let shown = self.shown.as_ref().map(|(_, layered)| layered);
        let textures = [&self.share, &self.before].into_iter().chain(shown);
        self.light.size() + textures.map(Layered::bytes).sum::<u64>()
    }
}
