//! The full-screen pass that compares receivers with the maps.

use super::phases::{OpenPixels, Phase};
use super::uniforms::MapLookup;
use super::{DepthMaps, Layers};
use crate::{
    fullscreen::{Fullscreen, UNIFORM, bind, layout},
    gpu::Gpu,
    passes::Passes,
    receivers::Receivers,
    shader::Shader,
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::LightShape;

/// Pipelines (one for each combination that came up) and the uniforms of the pass.
pub(crate) struct Lookup {
    module: wgpu::ShaderModule,
    constants: Vec<(&'static str, f64)>,
    bias: f64,
    layout: wgpu::BindGroupLayout,
    /// Layout of what the technique binds besides, as group 2.
    more: Option<wgpu::BindGroupLayout>,
    /// One for each phase; one alone where there are no phases.
    pipelines: Vec<(Variant, Vec<wgpu::RenderPipeline>)>,
    /// For a technique with a quick phase.
    open: Option<OpenPixels>,
    uniforms: wgpu::Buffer,
    data: MapLookup,
    sampler: wgpu::Sampler,
    bind_group: Option<(wgpu::Texture, wgpu::BindGroup)>,
    current: Option<usize>,
}

/// What a pipeline is made for.
#[derive(Clone, Copy, PartialEq)]
struct Variant {
    /// The light is a ball of some kind, which turns the same side to all.
    round: bool,
    perspective: bool,
    warped: bool,
    layout: Layers,
    linear: bool,
    has_normals: bool,
}

impl Lookup {
    pub(crate) fn new(
        gpu: &Gpu,
        shader: &Shader,
        bias: f64,
        constants: Vec<(&'static str, f64)>,
        more: Option<wgpu::BindGroupLayout>,
    ) -> Self {
        Self {
            module: shader.module(gpu),
            constants,
            bias,
            layout: lookup_layout(gpu),
            more,
            pipelines: Vec::new(),
            open: None,
            uniforms: gpu.buffer(
                "map lookup",
                &[MapLookup::default()],
                wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            ),
            data: MapLookup::default(),
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("map compare"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                compare: Some(wgpu::CompareFunction::GreaterEqual),
                ..Default::default()
            }),
            bind_group: None,
            current: None,
        }
    }

    /// Looks up in two phases; the shader has a `quick_share`, see `wgsl/map_quick.wgsl`.
    pub(super) fn in_phases(&mut self) {
        self.open = Some(OpenPixels::default());
    }

    pub(crate) fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &DepthMaps) {
        self.current = None;
        let Some(textures) = maps.textures.as_ref().filter(|_| !maps.views.is_empty()) else { return };
        self.data = MapLookup::new(view, maps, self.bias);
        let perspective = maps.is_from_a_point();
        let linear = maps.linear && perspective;
        let round = matches!(view.light.shape, LightShape::Sphere { .. } | LightShape::Ellipsoid { .. });
        let has_normals = view.receivers.has_normals;
        let warped = maps.is_warped();
        let variant = Variant { round, perspective, warped, layout: maps.layout, linear, has_normals };
        let known = self.pipelines.iter().position(|(v, _)| *v == variant);
        self.current = Some(known.unwrap_or_else(|| {
            self.pipelines.push((variant, self.pipelines_of(gpu, variant)));
            self.pipelines.len() - 1
        }));
        if let Some(open) = &mut self.open {
            open.prepare(gpu, view.receivers.size);
        }
        if self.bind_group.as_ref().is_none_or(|(t, _)| t != textures.result()) {
            self.bind_group = Some((textures.result().clone(), self.bind(gpu, textures.result())));
        }
    }

    /// The uniforms of [`MapLookup`].
    pub(super) fn uniforms(&self) -> &wgpu::Buffer {
        &self.uniforms
    }

    /// Before [`Lookup::record`].
    pub(super) fn upload(&self, passes: &mut Passes<'_>) {
        passes.upload(&self.uniforms, bytemuck::bytes_of(&self.data));
    }

    /// Writes 1 everywhere where there is nothing to look up. `more` is what the technique binds as group 2.
    pub(crate) fn record(
        &self,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        more: Option<&wgpu::BindGroup>,
        visibility: &VisibilityTarget,
    ) {
        let open = self.open.as_ref().filter(|_| self.current.is_some()).and_then(OpenPixels::attachment);
        let mut pass = passes.render("visibility", &[visibility.overwrite()], open);
        if let (Some(current), Some((_, bind_group))) = (self.current, &self.bind_group) {
            pass.set_bind_group(0, &receivers.bind_group, &[]);
            pass.set_bind_group(1, bind_group, &[]);
            if more.is_some() {
                pass.set_bind_group(2, more, &[]);
            }
            for (pipeline, phase) in self.pipelines[current].1.iter().zip(Phase::BOTH) {
                pass.set_pipeline(pipeline);
                pass.set_stencil_reference(phase.reference());
                pass.draw(0..3, 0..1);
            }
        }
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.uniforms.size() + self.open.as_ref().map_or(0, OpenPixels::bytes)
    }

    fn pipelines_of(&self, gpu: &Gpu, variant: Variant) -> Vec<wgpu::RenderPipeline> {
        match self.open {
            Some(_) => Phase::BOTH.map(|phase| self.pipeline(gpu, variant, Some(phase))).into(),
            None => vec![self.pipeline(gpu, variant, None)],
        }
    }

    fn pipeline(&self, gpu: &Gpu, variant: Variant, phase: Option<Phase>) -> wgpu::RenderPipeline {
        let mut constants = self.constants.clone();
        let on = |switch: bool| if switch { 1.0 } else { 0.0 };
        constants.push(("ROUND", on(variant.round)));
        constants.push(("PERSPECTIVE", on(variant.perspective)));
        constants.push(("WARPED", on(variant.warped)));
        constants.push(("LAYOUT", variant.layout.number()));
        constants.push(("LINEAR", on(variant.linear)));
        constants.push(("HAS_NORMALS", on(variant.has_normals)));
        let receivers = Receivers::layout(gpu);
        let groups: Vec<_> = [&receivers, &self.layout].into_iter().chain(&self.more).collect();
        Fullscreen {
            label: "map lookup",
            module: &self.module,
            entry: phase.map_or("visibility", Phase::entry),
            groups: &groups,
            target: VisibilityTarget::FORMAT.into(),
            constants: &constants,
        }
        .with_stencil(gpu, phase.map(Phase::state))
    }

    fn bind(&self, gpu: &Gpu, maps: &wgpu::Texture) -> wgpu::BindGroup {
        let view = maps.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let resources = [
            self.uniforms.as_entire_binding(),
            wgpu::BindingResource::TextureView(&view),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        bind(gpu, "map lookup", &self.layout, &resources)
    }
}

fn lookup_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let maps = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let compare = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    layout(gpu, "map lookup", wgpu::ShaderStages::FRAGMENT, &[UNIFORM, maps, compare])
}
