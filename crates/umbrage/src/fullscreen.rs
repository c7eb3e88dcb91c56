//! What all full-screen passes share: their pipeline, their textures and the entries of their
//! layouts.

use crate::gpu::Gpu;

/// What full-screen pipelines differ in. The vertex shader is `wgsl/fullscreen.wgsl`.
pub struct Fullscreen<'a> {
    /// For messages of the driver.
    pub label: &'a str,
    /// The shader, with `wgsl/fullscreen.wgsl` in it.
    pub module: &'a wgpu::ShaderModule,
    /// The fragment shader.
    pub entry: &'a str,
    /// Bind groups in order.
    pub groups: &'a [&'a wgpu::BindGroupLayout],
    /// Format of the target, and how it is blended.
    pub target: wgpu::ColorTargetState,
    /// Pipeline-overridable constants.
    pub constants: &'a [(&'a str, f64)],
}

impl Fullscreen<'_> {
    /// One without depth and stencil.
    pub fn pipeline(&self, gpu: &Gpu) -> wgpu::RenderPipeline {
        self.with_stencil(gpu, None)
    }

    pub(crate) fn with_stencil(
        &self,
        gpu: &Gpu,
        depth_stencil: Option<wgpu::DepthStencilState>,
    ) -> wgpu::RenderPipeline {
        self.build(gpu, depth_stencil, &[])
    }

    /// One that writes to other targets, too, at the locations from 1 on.
    pub(crate) fn beside(&self, gpu: &Gpu, others: &[wgpu::ColorTargetState]) -> wgpu::RenderPipeline {
        self.build(gpu, None, others)
    }

    fn build(
        &self,
        gpu: &Gpu,
        depth_stencil: Option<wgpu::DepthStencilState>,
        others: &[wgpu::ColorTargetState],
    ) -> wgpu::RenderPipeline {
        let targets: Vec<_> = std::iter::once(&self.target).chain(others).map(|target| Some(target.clone())).collect();
        let groups: Vec<_> = self.groups.iter().map(|g| Some(*g)).collect();
        let layout = gpu.pipeline_layout(&groups);
        gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some("fullscreen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(self.entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: self.constants,
                    ..Default::default()
                },
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A target that adds what is drawn to what is there.
pub fn additive(format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::ColorTargetState { blend: Some(wgpu::BlendState { color: add, alpha: add }), ..format.into() }
}

/// A target that keeps the smaller of what is drawn and what is there.
pub(crate) fn smaller(format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
    let min = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Min,
    };
    wgpu::ColorTargetState { blend: Some(wgpu::BlendState { color: min, alpha: min }), ..format.into() }
}

/// How front faces are wound on the screen.
pub(crate) fn front_face(is_mirrored: bool) -> wgpu::FrontFace {
    if is_mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw }
}

/// A colour attachment over a whole view.
pub fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
}

/// A texture to draw into, to read in shaders and to copy from; `layers` over 1 make an array.
pub fn target_texture(
    gpu: &Gpu,
    label: &str,
    (width, height): (u32, u32),
    layers: u32,
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// One layer of an array.
pub fn layer_view(texture: &wgpu::Texture, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// A layout whose bindings are numbered from 0 in order, for the given stages.
pub fn layout(
    gpu: &Gpu,
    label: &str,
    visibility: wgpu::ShaderStages,
    bindings: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(bindings)
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry { binding, visibility, ty: *ty, count: None })
        .collect();
    gpu.bind_group_layout(label, &entries)
}

/// A bind group of such a layout.
pub fn bind(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// A two-dimensional texture of this sample type.
pub fn texture(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    let view_dimension = wgpu::TextureViewDimension::D2;
    wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false }
}

/// A float texture that is read texel by texel.
pub const FLOATS: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };

/// A uniform buffer.
pub const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// A storage buffer that is only read.
pub(crate) const STORAGE: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Storage { read_only: true },
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// A storage buffer that is written.
pub(crate) const STORAGE_WRITE: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Storage { read_only: false },
    has_dynamic_offset: false,
    min_binding_size: None,
};
