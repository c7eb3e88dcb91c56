//! The silhouette map: a second texture as large as the maps of depths, its texels between theirs.

use crate::casters::Casters;
use crate::depth_maps::{EdgeDraw, EdgePass, EdgeTarget, MapFrame, Stage};
use crate::fullscreen::{bind, layer_view, layout, target_texture, texture};
use crate::{Binding, Error, Gpu, Passes, Resource, Shader, View};

/// Draws points of silhouettes, and keeps them for as long as the maps of depths stay.
pub(super) struct SilhouetteStage {
    layout: wgpu::BindGroupLayout,
    depths: wgpu::BindGroupLayout,
    plain: wgpu::Sampler,
    edges: EdgePass,
    made: Option<Made>,
}

struct Made {
    /// The maps of depths.
    of: wgpu::Texture,
    layers: Vec<Layer>,
    /// All layers of points.
    points: wgpu::TextureView,
    bind_group: wgpu::BindGroup,
    bytes: u64,
}

struct Layer {
    points: wgpu::TextureView,
    /// The map of depths.
    depths: wgpu::BindGroup,
    /// [`MapFrame::version`] of when it was drawn.
    version: u64,
}

/// The points, and a sampler that gathers depths.
const BINDINGS: [wgpu::BindingType; 2] = [
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    },
    PLAIN,
];

const PLAIN: wgpu::BindingType = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);

/// What a cell holds is a depth, see `silhouette_key.wgsl`.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl SilhouetteStage {
    pub fn new(gpu: &Gpu, points: &Shader) -> Self {
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let depths = layout(gpu, "depths", fragment, &[texture(wgpu::TextureSampleType::Depth), PLAIN]);
        let draw = EdgeDraw {
            vertex: "corner",
            fragment: Some("point_of_edge"),
            targets: Vec::new(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
        };
        Self {
            layout: layout(gpu, "silhouette map", fragment, &BINDINGS),
            edges: EdgePass::new(gpu, points, Some(&depths), &[], vec![draw]),
            depths,
            plain: gpu.sampler(&wgpu::SamplerDescriptor::default()),
            made: None,
        }
    }

    fn make(&self, gpu: &Gpu, maps: &wgpu::Texture) -> Made {
        let (size, count) = (maps.width(), maps.depth_or_array_layers());
        let points = target_texture(gpu, "silhouette map", (size, size), count, FORMAT);
        let all = points.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let layers = (0..count).map(|i| {
            let depths = layer_view(maps, i);
            let sampled = [wgpu::BindingResource::TextureView(&depths), wgpu::BindingResource::Sampler(&self.plain)];
            let depths = bind(gpu, "depths", &self.depths, &sampled);
            Layer { points: layer_view(&points, i), depths, version: 0 }
        });
        let resources = [wgpu::BindingResource::TextureView(&all), wgpu::BindingResource::Sampler(&self.plain)];
        Made {
            of: maps.clone(),
            layers: layers.collect(),
            bind_group: bind(gpu, "silhouette map", &self.layout, &resources),
            points: all.clone(),
            bytes: u64::from(size) * u64::from(size) * u64::from(count) * 4,
        }
    }
}

impl Stage for SilhouetteStage {
    fn needs_edges(&self) -> bool {
        true
    }

    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &MapFrame) -> Result<(), Error> {
        if let Some(maps) = frame.texture.as_ref().filter(|maps| self.made.as_ref().is_none_or(|m| m.of != **maps)) {
            self.made = Some(self.make(gpu, maps));
        }
        self.edges.prepare(gpu, view.casters, view.light.shape.center(), &frame.views, frame)
    }

    fn record(&mut self, passes: &mut Passes<'_>, frame: &MapFrame, casters: &Casters) -> u32 {
        let Some(made) = &mut self.made else { return 0 };
        let mut draws = 0;
        let mut has_found = false;
        for (i, view) in frame.views.iter().enumerate() {
            let layer = &mut made.layers[view.layer as usize];
            let version = frame.version(view.layer);
            if std::mem::replace(&mut layer.version, version) == version {
                continue;
            }
            if !std::mem::replace(&mut has_found, true) {
                self.edges.find(passes, casters, frame);
            }
            let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store });
            let depth = wgpu::RenderPassDepthStencilAttachment { view: &layer.points, depth_ops, stencil_ops: None };
            let target = EdgeTarget { label: "silhouette map", colors: &[], depth: Some(depth) };
            draws += self.edges.record(passes, (i, 0), Some(&layer.depths), target);
        }
        draws
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.made.as_ref().map(|made| &made.bind_group)
    }

    fn lends(&self) -> Option<Vec<Binding>> {
        let points = Resource::View(self.made.as_ref()?.points.clone());
        let lent = [points, Resource::Sampler(self.plain.clone())];
        Some((0..).zip(BINDINGS).zip(lent).map(|((i, ty), lent)| Binding::of_stage(i, ty, lent)).collect())
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        // The depths at the corners of a cell.
        (pass == "silhouette map").then_some(16)
    }

    fn bytes(&self) -> u64 {
        self.edges.bytes() + self.made.as_ref().map_or(0, |made| made.bytes)
    }
}
