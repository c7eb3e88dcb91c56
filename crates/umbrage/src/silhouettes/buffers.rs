//! What a frame's casters and lists are uploaded to, and what shaders read beside them.

use crate::fullscreen::{STORAGE, bind, layout};
use crate::shader::shader_struct;
use crate::{error::Error, gpu::Gpu};

shader_struct! {
    /// What the vertex shaders need of camera and light, see `extrude.wgsl`.
    pub(crate) struct Extrusion {
        clip_from_world: [[f32; 4]; 4],
        light: [f32; 4],
        away: [f32; 2],
        pad: [f32; 2],
    }
}

shader_struct! {
    /// See `find_silhouettes.wgsl`.
    pub(crate) struct FindSilhouettes {
        edge_chunks: u32,
        triangle_chunks: u32,
        weighted: u32,
        pad: u32,
    }
}

/// Bytes of the arguments of an indirect draw.
pub(super) const ARGUMENTS: u64 = size_of::<wgpu::util::DrawIndexedIndirectArgs>() as u64;

/// Of the bind group with casters alone, for compute.
pub(crate) fn casters_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "casters of a light", wgpu::ShaderStages::COMPUTE, &[STORAGE])
}

/// Bytes that buffers need to have.
pub(super) struct Needs {
    pub casters: u64,
    pub list: u64,
}

/// What a frame's casters and lists are uploaded to.
pub(super) struct Buffers {
    pub casters: wgpu::Buffer,
    pub list: wgpu::Buffer,
    pub arguments: wgpu::Buffer,
    pub find_uniform: wgpu::Buffer,
    pub extrusion: wgpu::Buffer,
    pub draw: wgpu::BindGroup,
    pub casters_alone: wgpu::BindGroup,
    pub find: Option<wgpu::BindGroup>,
}

impl Buffers {
    pub fn new(
        gpu: &Gpu,
        needs: &Needs,
        draw_layout: &wgpu::BindGroupLayout,
        find_layout: Option<&wgpu::BindGroupLayout>,
    ) -> Result<Self, Error> {
        use wgpu::BufferUsages as Usage;
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let largest = needs.list.max(needs.casters);
        if largest > limit {
            return Err(Error::Size { what: "a list of silhouettes".into(), size: largest, limit });
        }
        // Half as much again, so that a moving camera does not make it grow all the time.
        let room = |bytes: u64| (bytes + bytes / 2).next_multiple_of(256).clamp(256, limit);
        let buffer = |label, size, usage| {
            let usage = usage | Usage::COPY_DST;
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let casters = buffer("casters of a light", room(needs.casters), Usage::STORAGE);
        let list = buffer("silhouettes", room(needs.list), Usage::STORAGE);
        let indirect = Usage::STORAGE | Usage::INDIRECT | Usage::COPY_SRC;
        let arguments = buffer("draws of silhouettes", 3 * ARGUMENTS, indirect);
        let find_uniform = buffer("find silhouettes", size_of::<FindSilhouettes>() as u64, Usage::UNIFORM);
        let extrusion = buffer("extrusion", size_of::<Extrusion>() as u64, Usage::UNIFORM);
        let shared = [&casters, &list].map(|b| b.as_entire_binding());
        let draw_extra = [extrusion.as_entire_binding()];
        let find_extra = [arguments.as_entire_binding(), find_uniform.as_entire_binding()];
        let draw = bind(gpu, "silhouettes", draw_layout, &[&shared[..], &draw_extra].concat());
        let casters_alone = bind(gpu, "casters of a light", &casters_layout(gpu), &shared[..1]);
        let find = find_layout.map(|l| bind(gpu, "find silhouettes", l, &[&shared[..], &find_extra].concat()));
        Ok(Self { draw, casters_alone, find, casters, list, arguments, find_uniform, extrusion })
    }

    pub fn hold(&self, needs: &Needs) -> bool {
        self.casters.size() >= needs.casters && self.list.size() >= needs.list
    }

    pub fn bytes(&self) -> u64 {
        let all = [&self.casters, &self.list, &self.arguments, &self.find_uniform, &self.extrusion];
        all.iter().map(|b| b.size()).sum()
    }
}
