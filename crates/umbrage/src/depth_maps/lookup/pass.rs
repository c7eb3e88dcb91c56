//! The full-screen pass that compares receivers with the maps.

use super::extent::is_round;
use super::in_eye::InEye;
use super::phases::{OpenPixels, Phase};
use super::pictures::Pictures;
use super::uniforms::{MapLookup, Space};
use super::variant::Variant;
use crate::depth_maps::frame::MapFrame;
use crate::depth_maps::setup::{Bias, Blend};
use crate::{
    fullscreen::{Fullscreen, UNIFORM, bind, layout},
    gpu::Gpu,
    passes::Passes,
    receivers::Receivers,
    shader::Shader,
    technique::DebugView,
    view::View,
    visibility::VisibilityTarget,
};

/// Pipelines, one for each combination that came up.
pub(crate) struct Lookup {
    pub(super) shader: Shader,
    module: wgpu::ShaderModule,
    constants: Vec<(&'static str, f64)>,
    layout: wgpu::BindGroupLayout,
    /// Layout of what the technique binds besides, as group 2.
    more: Option<wgpu::BindGroupLayout>,
    /// The fragment shader in place of those of the phases.
    entry: Option<&'static str>,
    target: wgpu::ColorTargetState,
    pub(super) pipelines: Vec<(Variant, Draws)>,
    /// The shader has a `quick_share`, see `map_quick.wgsl`.
    is_quick: bool,
    open: OpenPixels,
    pub(super) sampler: wgpu::Sampler,
    pictures: Option<Pictures>,
}

/// What a look-up reads: the maps of a light and the uniforms that go with them.
pub(crate) struct LookupInput {
    bias: Bias,
    uniforms: wgpu::Buffer,
    data: MapLookup,
    /// Pixels by which the noise of taps is shifted: across, and 64 times those down.
    jitter: f32,
    /// The pixels that the light can light: the first, and how many.
    pixels: [u32; 4],
    bind_group: Option<(wgpu::Texture, wgpu::BindGroup)>,
    /// Number of the pipelines; `None` where there is nothing to look up.
    pub(super) current: Option<usize>,
    /// What shaders of hosts read in place of the uniforms.
    pub(super) in_eye: InEye,
}

/// The draws of a look-up, in order.
type Draws = Vec<(Phase, wgpu::RenderPipeline)>;

impl Lookup {
    pub fn new(
        gpu: &Gpu,
        shader: &Shader,
        blend: Blend,
        constants: &[(&'static str, f64)],
        more: Option<wgpu::BindGroupLayout>,
    ) -> Self {
        Self {
            shader: *shader,
            module: shader.module(gpu),
            constants: [constants, &[("BLEND", blend.number())]].concat(),
            layout: lookup_layout(gpu),
            more,
            entry: None,
            target: VisibilityTarget::FORMAT.into(),
            pipelines: Vec::new(),
            is_quick: false,
            open: OpenPixels::default(),
            sampler: gpu.sampler(&wgpu::SamplerDescriptor {
                label: Some("map compare"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                compare: Some(wgpu::CompareFunction::GreaterEqual),
                ..Default::default()
            }),
            pictures: None,
        }
    }

    /// With pictures of what `shader` finds, see `map_picture.wgsl`.
    pub fn with_pictures(&mut self, gpu: &Gpu, shader: &Shader, names: &'static [&'static str]) {
        self.pictures = Some(Pictures::new(gpu, shader, names));
    }

    /// Shows one of the pictures from the next frame on, or none.
    pub fn inspect(&mut self, view: Option<&str>) {
        self.pictures.iter_mut().for_each(|pictures| pictures.inspect(view));
    }

    /// The picture that is shown.
    pub fn picture(&self) -> Option<DebugView<'_>> {
        self.pictures.as_ref().and_then(Pictures::view)
    }

    /// Looks up in two phases; the shader has a `quick_share`, see `map_quick.wgsl`.
    pub fn in_phases(&mut self) {
        self.is_quick = true;
    }

    /// By another fragment shader, `entry`, into another target.
    pub fn into(mut self, entry: &'static str, target: impl Into<wgpu::ColorTargetState>) -> Self {
        (self.entry, self.target) = (Some(entry), target.into());
        self
    }

    /// Makes ready for the maps of this frame.
    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &MapFrame, input: &mut LookupInput) {
        self.choose(gpu, view, maps, input);
        if let Some(mut pictures) = self.pictures.take_if(|pictures| pictures.is_shown()) {
            let variant = input.current.map(|current| self.pipelines[current].0);
            let constants = variant.map_or_else(Vec::new, |variant| self.constants_of(variant));
            let receivers = Receivers::layout(gpu);
            pictures.prepare(gpu, variant, &self.groups(&receivers), &constants, view.receivers.size);
            self.pictures = Some(pictures);
        }
    }

    /// Chooses the pipelines of this frame.
    fn choose(&mut self, gpu: &Gpu, view: &View<'_>, maps: &MapFrame, input: &mut LookupInput) {
        input.current = None;
        input.pixels = view.lit_pixels();
        input.in_eye.data = MapLookup::new(view, maps, input.bias, Space::Eye);
        input.in_eye.data.jitter = input.jitter;
        let Some(texture) = maps.texture.as_ref().filter(|_| !maps.views.is_empty()) else { return };
        input.data = MapLookup::new(view, maps, input.bias, Space::Ndc);
        input.data.jitter = input.jitter;
        let perspective = maps.is_from_a_point();
        let linear = maps.is_linear;
        let round = is_round(&view.light.shape);
        let has_normals = view.receivers.has_normals;
        let warped = maps.is_warped;
        let steady = maps.views.iter().any(|v| v.steady_border.is_some());
        let variant = Variant { round, perspective, warped, layout: maps.layers, linear, has_normals, steady };
        let known = self.pipelines.iter().position(|(v, _)| *v == variant);
        input.current = Some(known.unwrap_or_else(|| {
            self.pipelines.push((variant, self.draws_of(gpu, variant)));
            self.pipelines.len() - 1
        }));
        if self.phases().len() > 1 {
            self.open.prepare(gpu, view.receivers.size);
        }
        if input.bind_group.as_ref().is_none_or(|(t, _)| t != texture) {
            input.bind_group = Some((texture.clone(), self.bind(gpu, texture, &input.uniforms)));
        }
    }

    /// Writes 1 where the light lights nothing, and everywhere where there is nothing to look up.
    /// `more` is what the technique binds as group 2. Returns the number of draws.
    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        input: &LookupInput,
        more: Option<&wgpu::BindGroup>,
        visibility: &VisibilityTarget,
    ) -> u32 {
        let open = if self.draws(input).len() > 1 { self.open.attachment() } else { None };
        let mut pass = passes.render("visibility", &[visibility.overwrite()], open);
        let [x, y, width, height] = input.pixels;
        let lights_some = width > 0 && height > 0;
        let draws = if lights_some {
            pass.set_scissor_rect(x, y, width, height);
            self.draw(&mut pass, receivers, input, more)
        } else {
            0
        };
        drop(pass);
        if let Some(pictures) = &self.pictures {
            let own = input.bind_group.as_ref().map(|(_, bind_group)| bind_group);
            pictures.record(passes, [Some(&receivers.bind_group), own, more]);
        }
        draws
    }

    /// The draws of [`Lookup::record`] in a pass that has begun. Nothing where there is nothing to
    /// look up.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        receivers: &Receivers,
        input: &LookupInput,
        more: Option<&wgpu::BindGroup>,
    ) -> u32 {
        let draws = self.draws(input);
        let Some((_, bind_group)) = input.bind_group.as_ref().filter(|_| !draws.is_empty()) else { return 0 };
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, bind_group, &[]);
        if more.is_some() {
            pass.set_bind_group(2, more, &[]);
        }
        for (phase, pipeline) in draws {
            pass.set_pipeline(pipeline);
            pass.set_stencil_reference(phase.reference());
            pass.draw(0..3, 0..1);
        }
        draws.len() as u32
    }

    fn draws(&self, input: &LookupInput) -> &[(Phase, wgpu::RenderPipeline)] {
        input.current.and_then(|current| self.pipelines.get(current)).map_or(&[], |(_, draws)| draws)
    }

    pub fn bytes(&self) -> u64 {
        self.open.bytes() + self.pictures.as_ref().map_or(0, Pictures::bytes)
    }

    fn draws_of(&self, gpu: &Gpu, variant: Variant) -> Draws {
        self.phases().iter().map(|phase| (*phase, self.pipeline(gpu, variant, *phase))).collect()
    }

    fn phases(&self) -> &'static [Phase] {
        if self.is_quick { &[Phase::Quick, Phase::Rest] } else { &[Phase::Whole] }
    }

    /// Of the look-up's pipelines.
    fn groups<'a>(&'a self, receivers: &'a wgpu::BindGroupLayout) -> Vec<&'a wgpu::BindGroupLayout> {
        [receivers, &self.layout].into_iter().chain(&self.more).collect()
    }

    pub(super) fn constants_of(&self, variant: Variant) -> Vec<(&'static str, f64)> {
        [&self.constants[..], &variant.constants()].concat()
    }

    fn pipeline(&self, gpu: &Gpu, variant: Variant, phase: Phase) -> wgpu::RenderPipeline {
        let receivers = Receivers::layout(gpu);
        Fullscreen {
            label: "map lookup",
            module: &self.module,
            entry: self.entry.unwrap_or(phase.entry()),
            groups: &self.groups(&receivers),
            target: self.target.clone(),
            constants: &self.constants_of(variant),
        }
        .with_stencil(gpu, phase.state())
    }

    fn bind(&self, gpu: &Gpu, maps: &wgpu::Texture, uniforms: &wgpu::Buffer) -> wgpu::BindGroup {
        let view = all_layers(maps);
        let resources = [
            uniforms.as_entire_binding(),
            wgpu::BindingResource::TextureView(&view),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        bind(gpu, "map lookup", &self.layout, &resources)
    }
}

impl LookupInput {
    /// With what keeps surfaces from shadowing themselves.
    pub fn new(gpu: &Gpu, bias: Bias) -> Self {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        Self {
            bias,
            uniforms: gpu.buffer("map lookup", &[MapLookup::default()], usage),
            data: MapLookup::default(),
            jitter: 0.0,
            pixels: [0; 4],
            bind_group: None,
            current: None,
            in_eye: InEye::new(gpu),
        }
    }

    /// From the next frame on.
    pub fn set_bias(&mut self, bias: Bias) {
        self.bias = bias;
    }

    /// Whether one look-up can read the maps of both points: the same pipeline was chosen for them.
    pub fn joins(&self, other: &Self) -> bool {
        self.current.is_some() && self.current == other.current
    }

    /// Reads another point's maps, too, see [`LookupInput::joins`].
    pub fn join(&mut self, other: &Self) {
        self.data.join(&other.data);
    }

    /// Which frame the next one is: each has other taps. They are shifted by whole pixels, so that
    /// tiles of taps fit, and in an order that is evenly spread (Roberts, "The Unreasonable
    /// Effectiveness of Quasirandom Sequences", 2018).
    pub fn set_frame(&mut self, frame: u32) {
        let shift = |step: f64| (64.0 * (f64::from(frame % 4096) * step).fract()).floor() as f32;
        self.jitter = shift(0.754_877_666_246_692_7) + 64.0 * shift(0.569_840_290_998_053_2);
    }

    /// The uniforms of [`MapLookup`].
    pub fn uniforms(&self) -> &wgpu::Buffer {
        &self.uniforms
    }

    /// Before the look-up is recorded.
    pub fn upload(&self, passes: &mut Passes<'_>) {
        passes.upload(&self.uniforms, bytemuck::bytes_of(&self.data));
        self.in_eye.upload(passes);
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.uniforms.size() + self.in_eye.uniforms.size()
    }
}

pub(super) fn all_layers(maps: &wgpu::Texture) -> wgpu::TextureView {
    maps.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// What `map_layers.wgsl` declares as group 1.
pub(super) const BINDINGS: [wgpu::BindingType; 3] = [
    UNIFORM,
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    },
    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
];

fn lookup_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "map lookup", wgpu::ShaderStages::FRAGMENT, &BINDINGS)
}
