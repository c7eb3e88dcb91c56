//! Materials and textures on the GPU.

use crate::fullscreen::{self, bind, layout};
use crate::{error::Error, gpu::Gpu, shader::Shared, shader::shader_struct};
use std::collections::HashMap;
use umbrage_core::{Filter, Sampling, Scene, Texture, Wrap};
use wgpu::util::DeviceExt;

shader_struct! {
    /// Appearance of an instance.
    pub(crate) struct Material {
        base_color: [f32; 4],
        emissive: [f32; 3],
        alpha_cutoff: f32,
        specular: f32,
        shininess: f32,
        spare: [f32; 2],
    }
}

/// What the host has to agree on with `materials.wgsl`.
pub(super) const SHARED: Shared = Shared { module: "materials", layouts: &[Material::LAYOUT], constants: &[] };

/// All materials of the scene, as the shader reads them.
pub(super) fn all(scene: &Scene) -> Vec<Material> {
    let of = |m: &umbrage_core::Material| Material {
        base_color: m.base_color.to_array(),
        emissive: m.emissive.to_array(),
        alpha_cutoff: m.alpha_cutoff.unwrap_or(0.0),
        specular: m.specular,
        shininess: m.shininess,
        spare: [0.0; 2],
    };
    scene.materials.iter().map(of).collect()
}

/// A bind group for every texture; the first is plain white, for materials without one.
pub(super) fn textures(gpu: &Gpu, scene: &Scene) -> Result<Vec<wgpu::BindGroup>, Error> {
    let sampling = Sampling::default();
    let white = Texture { name: "white".into(), width: 1, height: 1, rgba: vec![[255; 4]], sampling };
    let mut samplers = HashMap::new();
    let mut group = |texture: &Texture| {
        let sampler = samplers.entry(texture.sampling).or_insert_with(|| sampler(gpu, texture.sampling));
        bind_group(gpu, texture, sampler)
    };
    std::iter::once(&white).chain(&scene.textures).map(&mut group).collect()
}

fn sampler(gpu: &Gpu, sampling: Sampling) -> wgpu::Sampler {
    let [address_mode_u, address_mode_v] = sampling.wrap.map(|wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    });
    let filter = match sampling.filter {
        Filter::Linear => wgpu::FilterMode::Linear,
        Filter::Nearest => wgpu::FilterMode::Nearest,
    };
    gpu.sampler(&wgpu::SamplerDescriptor {
        label: Some("base colour"),
        address_mode_u,
        address_mode_v,
        mag_filter: filter,
        min_filter: filter,
        ..Default::default()
    })
}

fn bind_group(gpu: &Gpu, texture: &Texture, sampler: &wgpu::Sampler) -> Result<wgpu::BindGroup, Error> {
    gpu.check_size(&format!("texture `{}`", texture.name), texture.width, texture.height)?;
    if texture.rgba.len() as u64 != u64::from(texture.width) * u64::from(texture.height) {
        return Err(Error::Scene(format!("texture `{}` has not width × height pixels", texture.name)));
    }
    let descriptor = wgpu::TextureDescriptor {
        label: Some(&texture.name),
        size: wgpu::Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let data = texture.rgba.as_flattened();
    let on_gpu = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, Default::default(), data);
    let view = on_gpu.create_view(&Default::default());
    let resources = [wgpu::BindingResource::TextureView(&view), wgpu::BindingResource::Sampler(sampler)];
    Ok(bind(gpu, &texture.name, &texture_layout(gpu), &resources))
}

/// Layout of the bind group that `materials.wgsl` declares as group 2.
pub(crate) fn texture_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let filtered = fullscreen::texture(wgpu::TextureSampleType::Float { filterable: true });
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    layout(gpu, "base colour", wgpu::ShaderStages::FRAGMENT, &[filtered, sampler])
}
