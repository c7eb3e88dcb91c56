//! Whether a device's limits allow what several lights bind in one stage.

use super::Lent;
use crate::{error::Error, gpu::Gpu};

/// That one bind group may hold all that `lights` read.
pub(super) fn check(gpu: &Gpu, group: u32, lights: &[Lent]) -> Result<(), Error> {
    let limits = gpu.device.limits();
    if group >= limits.max_bind_groups {
        let what = format!("bind group {group} is beyond the {} that this device has", limits.max_bind_groups);
        return Err(Error::Inline(what));
    }
    let count = |is: fn(&wgpu::BindingType) -> bool| {
        lights.iter().flat_map(Lent::bindings).filter(|bound| is(&bound.ty)).count() as u32
    };
    let all = |_: &wgpu::BindingType| true;
    let needs = [
        ("uniform buffers", count(is_uniform), limits.max_uniform_buffers_per_shader_stage),
        ("storage buffers", count(is_storage), limits.max_storage_buffers_per_shader_stage),
        ("textures", count(is_texture), limits.max_sampled_textures_per_shader_stage),
        ("samplers", count(is_sampler), limits.max_samplers_per_shader_stage),
        ("bindings in a group", count(all), limits.max_bindings_per_bind_group),
    ];
    match needs.iter().find(|(_, needed, limit)| needed > limit) {
        None => Ok(()),
        Some((what, needed, limit)) => Err(Error::Inline(format!(
            "{} lights in one shader read {needed} {what}, and this device has {limit}; shade some of them in a pass of their own",
            lights.len()
        ))),
    }
}

fn is_uniform(ty: &wgpu::BindingType) -> bool {
    matches!(ty, wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, .. })
}

fn is_storage(ty: &wgpu::BindingType) -> bool {
    matches!(ty, wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Storage { .. }, .. })
}

fn is_texture(ty: &wgpu::BindingType) -> bool {
    matches!(ty, wgpu::BindingType::Texture { .. })
}

fn is_sampler(ty: &wgpu::BindingType) -> bool {
    matches!(ty, wgpu::BindingType::Sampler(_))
}
