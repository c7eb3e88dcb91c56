//! The full-screen pass that compares receivers with the maps.

use super::DepthMaps;
use crate::{
    gpu::Gpu,
    passes::Passes,
    receivers::Receivers,
    shader::{Shader, shader_struct},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::glam::{DMat4, DVec4};

shader_struct! {
    /// How to get from a pixel to the surface it shows.
    pub(crate) struct Eye {
        eye_from_ndc: [[f32; 4]; 4],
        ndc_from_pixel: [f32; 2],
        background_depth: f32,
        spare: f32,
    }
}

shader_struct! {
    /// See `wgsl/map_lookup.wgsl`.
    pub(crate) struct MapLookup {
        eye: Eye,
        map_from_eye: [[[f32; 4]; 4]; 6],
        map_from_eye_plane: [[[f32; 4]; 4]; 6],
        light_eye: [f32; 3],
        size: f32,
        rounding: [f32; 2],
        per_metre: [f32; 2],
        bias: f32,
        spare: f32,
        more_spare: [f32; 2],
    }
}

/// Host structs of a lookup shader.
pub(crate) const LOOKUP_LAYOUTS: &[crate::shader::HostLayout] = &[Eye::LAYOUT, MapLookup::LAYOUT];

impl Eye {
    /// For the camera and size of `view`.
    pub(crate) fn new(view: &View<'_>) -> Self {
        let (width, height) = view.receivers.size;
        Self {
            eye_from_ndc: view.clip_from_eye().inverse().as_mat4().to_cols_array_2d(),
            ndc_from_pixel: [2.0 / width as f32, -2.0 / height as f32],
            background_depth: view.camera.background_depth(),
            spare: 0.0,
        }
    }
}

/// Pipelines (one for each combination that came up) and the uniforms of the pass.
pub(crate) struct Lookup {
    module: wgpu::ShaderModule,
    constants: Vec<(&'static str, f64)>,
    bias: f64,
    layout: wgpu::BindGroupLayout,
    pipelines: Vec<(Variant, wgpu::RenderPipeline)>,
    uniforms: wgpu::Buffer,
    data: MapLookup,
    sampler: wgpu::Sampler,
    bind_group: Option<(wgpu::Texture, wgpu::BindGroup)>,
    current: Option<usize>,
}

/// What a pipeline is made for.
#[derive(Clone, Copy, PartialEq)]
struct Variant {
    cube: bool,
    has_normals: bool,
}

impl Lookup {
    pub(crate) fn new(gpu: &Gpu, shader: &Shader, bias: f64, constants: &[(&'static str, f64)]) -> Self {
        Self {
            module: shader.module(gpu),
            constants: constants.to_vec(),
            bias,
            layout: layout(gpu),
            pipelines: Vec::new(),
            uniforms: gpu.buffer(
                "map lookup",
                &[MapLookup::default()],
                wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
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

    pub(crate) fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &DepthMaps) {
        self.current = None;
        let Some(textures) = maps.textures.as_ref().filter(|_| !maps.views.is_empty()) else { return };
        self.data = self.uniforms(view, maps);
        let variant = Variant { cube: maps.is_cube, has_normals: view.receivers.has_normals };
        let known = self.pipelines.iter().position(|(v, _)| *v == variant);
        self.current = Some(known.unwrap_or_else(|| {
            self.pipelines.push((variant, self.pipeline(gpu, variant)));
            self.pipelines.len() - 1
        }));
        if self.bind_group.as_ref().is_none_or(|(t, _)| t != textures.result()) {
            self.bind_group = Some((textures.result().clone(), self.bind(gpu, textures.result())));
        }
    }

    /// Writes 1 everywhere where there is nothing to look up.
    pub(crate) fn record(&self, passes: &mut Passes<'_>, receivers: &Receivers, visibility: &VisibilityTarget) {
        passes.upload(&self.uniforms, bytemuck::bytes_of(&self.data));
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        if let (Some(current), Some((_, bind_group))) = (self.current, &self.bind_group) {
            pass.set_pipeline(&self.pipelines[current].1);
            pass.set_bind_group(0, &receivers.bind_group, &[]);
            pass.set_bind_group(1, bind_group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.uniforms.size()
    }

    fn uniforms(&self, view: &View<'_>, maps: &DepthMaps) -> MapLookup {
        // A layer that was not rendered sends every point outside of the map, where all is lit.
        let outside = DMat4::from_cols(DVec4::ZERO, DVec4::ZERO, DVec4::ZERO, DVec4::new(-1.0, -1.0, 0.0, 1.0));
        let mut map_from_eye = [outside; 6];
        for v in &maps.views {
            let size = f64::from(v.size);
            let texels_from_clip = DMat4::from_cols(
                DVec4::new(size * 0.5, 0.0, 0.0, 0.0),
                DVec4::new(0.0, -size * 0.5, 0.0, 0.0),
                DVec4::Z,
                DVec4::new(size * 0.5, size * 0.5, 0.0, 1.0),
            );
            map_from_eye[v.layer as usize] =
                texels_from_clip * v.clip_from_world * DMat4::from_translation(view.camera.eye);
        }
        let planes = map_from_eye.map(|m| {
            let p = m.inverse().transpose();
            // Only directions of planes matter: scaled so that single precision holds them.
            p * (1.0 / p.to_cols_array().iter().fold(f64::MIN_POSITIVE, |a, x| a.max(x.abs())))
        });
        let center = view.light.shape.center();
        let perspective = maps.views.first().is_some_and(|v| maps.is_perspective(v));
        MapLookup {
            eye: Eye::new(view),
            map_from_eye: map_from_eye.map(|m| m.as_mat4().to_cols_array_2d()),
            map_from_eye_plane: planes.map(|m| m.as_mat4().to_cols_array_2d()),
            light_eye: (center.truncate() - view.camera.eye * center.w).as_vec3().to_array(),
            size: maps.size as f32,
            // Depth 0…1 in single precision; perspective depth keeps its relative precision, parallel depth does not.
            rounding: if perspective { [2e-6, 0.0] } else { [0.0, 1e-6] },
            per_metre: per_metre(maps),
            bias: self.bias as f32,
            ..MapLookup::default()
        }
    }

    fn pipeline(&self, gpu: &Gpu, variant: Variant) -> wgpu::RenderPipeline {
        let mut constants = self.constants.clone();
        constants.push(("CUBE", f64::from(u8::from(variant.cube))));
        constants.push(("HAS_NORMALS", f64::from(u8::from(variant.has_normals))));
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&Receivers::layout(gpu)), Some(&self.layout)],
            ..Default::default()
        });
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("map lookup"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some("fullscreen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some("visibility"),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets: &[Some(VisibilityTarget::FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn bind(&self, gpu: &Gpu, maps: &wgpu::Texture) -> wgpu::BindGroup {
        let view = maps.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("map lookup"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.uniforms.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        })
    }
}

/// How stored depth changes per metre along the light: perspective depth is near / distance, so its derivative is
/// depth² / near; that of parallel depth is constant.
fn per_metre(maps: &DepthMaps) -> [f32; 2] {
    let Some(view) = maps.views.first() else { return [0.0; 2] };
    let depth = view.clip_from_world.row(2);
    if maps.is_perspective(view) { [(1.0 / depth.w) as f32, 0.0] } else { [0.0, depth.truncate().length() as f32] }
}

fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let maps = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let compare = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("map lookup"),
        entries: &[entry(0, uniform), entry(1, maps), entry(2, compare)],
    })
}
