//! Pipelines, and the textures of planes.

use super::planes::Textures;
use crate::casters::{ByForm, CasterDraw, Form, Surface};
use crate::fullscreen::{Fullscreen, UNIFORM, bind, layer_view, layout, target_texture};
use crate::planar::{Finder, Shadows};
use crate::receivers::Receivers;
use crate::shader::Shader;
use crate::{gpu::Gpu, visibility::VisibilityTarget};

pub(super) const CAST_SHADER: Shader = Shader::new("heights of casters", include_str!("cast.wgsl"));

pub(super) const LOOKUP_SHADER: Shader = Shader::new("filtered projected shadows", include_str!("lookup.wgsl"))
    .with_layouts(&[super::planes::PlaneTexture::LAYOUT, Textures::LAYOUT]);

/// Of the textures: what is in shadow is 0 to 1, the rest 2.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
pub(super) const LIT: f64 = 2.0;
pub(super) const TEXEL_BYTES: u64 = 2;

/// What a frame draws with.
pub(super) struct Draws {
    lookup_module: wgpu::ShaderModule,
    lookup: Option<(bool, wgpu::RenderPipeline)>,
    cast: ByForm<[wgpu::RenderPipeline; 3]>,
    layout: wgpu::BindGroupLayout,
    pub uniform: wgpu::Buffer,
    sampler: wgpu::Sampler,
    made: Option<Made>,
}

/// Textures for so many planes.
struct Made {
    texture: wgpu::Texture,
    layers: Vec<wgpu::TextureView>,
    read: wgpu::BindGroup,
}

impl Draws {
    pub fn new(gpu: &Gpu, shadows: &Shadows) -> Self {
        let array = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            lookup_module: LOOKUP_SHADER.module(gpu),
            lookup: None,
            cast: ByForm::new(cast(gpu, shadows, Form::OWN)),
            layout: layout(gpu, "textures of planes", wgpu::ShaderStages::FRAGMENT, &[UNIFORM, array, sampler]),
            uniform: gpu.buffer("textures of planes", &[Textures::default()], usage),
            sampler: gpu.sampler(&Default::default()),
            made: None,
        }
    }

    /// Makes room for so many planes, and what receivers of this kind need.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        receivers: &Receivers,
        finder: &Finder,
        planes: u32,
        blur: &super::planes::Blur,
    ) {
        if self.made.as_ref().is_none_or(|made| (made.layers.len() as u32) < planes) {
            self.made = Some(self.make(gpu, blur.size, planes.max(1)));
        }
        if self.lookup.as_ref().is_none_or(|(has_normals, _)| *has_normals != receivers.has_normals) {
            let pipeline = Fullscreen {
                label: "filtered projected shadows",
                module: &self.lookup_module,
                entry: "visibility",
                groups: &[&Receivers::layout(gpu), &finder.layout, &self.layout],
                target: VisibilityTarget::FORMAT.into(),
                constants: &[
                    ("HAS_NORMALS", f64::from(u8::from(receivers.has_normals))),
                    ("KERNEL", blur.kernel.into()),
                    ("BY_LIGHT", f64::from(u8::from(blur.softness == super::Softness::Light))),
                ],
            }
            .pipeline(gpu);
            self.lookup = Some((receivers.has_normals, pipeline));
        }
    }

    fn make(&self, gpu: &Gpu, size: u32, planes: u32) -> Made {
        let texture = target_texture(gpu, "shadows on planes", (size, size), planes, FORMAT);
        let layers = (0..planes).map(|layer| layer_view(&texture, layer)).collect();
        let all = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let resources = [
            self.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&all),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        let read = bind(gpu, "textures of planes", &self.layout, &resources);
        Made { layers, texture, read }
    }

    /// What draws casters.
    pub fn cast(&self, surface: Surface, form: &Form) -> Option<&wgpu::RenderPipeline> {
        Some(&self.cast.get(form)?[surface as usize])
    }

    /// Makes what draws casters in such buffers.
    pub fn follow(&mut self, gpu: &Gpu, shadows: &Shadows, forms: &[Form]) {
        self.cast.follow(forms, |form| cast(gpu, shadows, form));
    }

    /// The layer of a plane.
    pub fn layer(&self, plane: usize) -> Option<&wgpu::TextureView> {
        self.made.as_ref()?.layers.get(plane)
    }

    /// The look-up, once prepared: its pipeline and group 2.
    pub fn lookup(&self) -> Option<(&wgpu::RenderPipeline, &wgpu::BindGroup)> {
        Some((&self.lookup.as_ref()?.1, &self.made.as_ref()?.read))
    }

    /// The texture of all planes.
    pub fn texture(&self) -> Option<&wgpu::Texture> {
        self.made.as_ref().map(|made| &made.texture)
    }
}

/// In the order of [`Surface`]; both faces, since the lowest counts.
fn cast(gpu: &Gpu, shadows: &Shadows, form: Form) -> [wgpu::RenderPipeline; 3] {
    let module = CAST_SHADER.module(gpu);
    let least = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Min,
    };
    let blend = Some(wgpu::BlendState { color: least, alpha: least });
    let pipeline = |vertex: &str, fragment| {
        CasterDraw {
            label: "heights of casters",
            form,
            view: &shadows.layout,
            textured: vertex == "masked",
            more: None,
            module: &module,
            vertex,
            fragment: Some(fragment),
            constants: &[],
            targets: &[Some(wgpu::ColorTargetState { blend, ..FORMAT.into() })],
            depth_stencil: None,
            cull_mode: None,
        }
        .pipeline(gpu)
    };
    [pipeline("opaque", "low"), pipeline("opaque", "low"), pipeline("masked", "low_cut_out")]
}
