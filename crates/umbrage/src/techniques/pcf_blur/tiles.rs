//! Finds the tiles of a visibility target around which values differ, and lists them for indirect
//! dispatches and draws.

use super::TILES_SHADER;
use crate::compute::compute_pipeline;
use crate::fullscreen::{self, FLOATS, bind, layout};
use crate::{gpu::Gpu, passes::Passes, visibility::VisibilityTarget};

/// Blocks or tiles across and down a workgroup, see `tiles.wgsl`.
const WORKGROUP: u32 = 8;

/// Pixels across and down a block, at least: whole quads, and not too many blocks.
const SMALLEST_BLOCK: u32 = 4;

/// Bytes before the tiles of a list.
const HEADER: u64 = 8;

/// Bytes of the arguments of one call.
const ARGUMENTS: u64 = 16;

/// What is done with listed tiles; the place of its arguments.
#[derive(Clone, Copy, Debug)]
pub(super) enum Call {
    /// A dispatch over those that are blurred.
    Blurred,
    /// A dispatch over those above and below them.
    Beside,
    /// A draw of those that are blurred.
    Result,
}

/// How many kinds of [`Call`] there are.
const CALLS: u64 = 3;

/// Lists tiles.
pub(super) struct Tiles {
    /// Pixels across and down a block; a tile is two across and down.
    pub block: u32,
    layout: wgpu::BindGroupLayout,
    nearest: wgpu::Sampler,
    /// Of blocks, of tiles, and of how many there are.
    pipelines: [wgpu::ComputePipeline; 3],
}

/// Room for the tiles of a picture.
pub(super) struct TileLists {
    /// Blocks across and down.
    blocks: (u32, u32),
    values: wgpu::Buffer,
    /// `TileList` of `head.wgsl`.
    pub list: wgpu::Buffer,
    arguments: wgpu::Buffer,
}

impl Tiles {
    /// For blurs that reach so many pixels.
    pub fn new(gpu: &Gpu, reach: u32, depth_aware: bool) -> Self {
        let block = reach.next_power_of_two().max(SMALLEST_BLOCK);
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
        let written = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let bindings = [fullscreen::texture(FLOATS), sampler, written, written, written];
        let layout = layout(gpu, "tiles", wgpu::ShaderStages::COMPUTE, &bindings);
        let module = TILES_SHADER.module(gpu);
        let constants = [("BLOCK", f64::from(block)), ("DEPTH_AWARE", f64::from(u8::from(depth_aware)))];
        let pipelines = ["find_blocks", "find_tiles", "count_tiles"]
            .map(|entry| compute_pipeline(gpu, &module, entry, &[Some(&layout)], &constants));
        let nearest = gpu.sampler(&Default::default());
        Self { block, layout, nearest, pipelines }
    }

    pub fn lists(&self, gpu: &Gpu, (width, height): (u32, u32)) -> TileLists {
        let blocks = (width.div_ceil(self.block), height.div_ceil(self.block));
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        let values = 4 * u64::from(blocks.0) * u64::from(blocks.1);
        TileLists {
            blocks,
            values: buffer("blocks", values, wgpu::BufferUsages::empty()),
            list: buffer("tiles", HEADER + 4 * tiles(blocks), wgpu::BufferUsages::COPY_DST),
            arguments: buffer("calls of tiles", ARGUMENTS * CALLS, wgpu::BufferUsages::INDIRECT),
        }
    }

    pub fn bind(&self, gpu: &Gpu, target: &VisibilityTarget, lists: &TileLists) -> wgpu::BindGroup {
        let resources = [
            wgpu::BindingResource::TextureView(&target.view),
            wgpu::BindingResource::Sampler(&self.nearest),
            lists.values.as_entire_binding(),
            lists.list.as_entire_binding(),
            lists.arguments.as_entire_binding(),
        ];
        bind(gpu, "tiles", &self.layout, &resources)
    }

    /// Fills the lists that `bind_group` is of.
    pub fn record(&self, passes: &mut Passes<'_>, lists: &TileLists, bind_group: &wgpu::BindGroup) {
        passes.encoder().clear_buffer(&lists.list, 0, Some(HEADER));
        let mut pass = passes.compute("tiles");
        pass.set_bind_group(0, bind_group, &[]);
        let (across, down) = lists.blocks;
        for (pipeline, share) in self.pipelines.iter().zip([WORKGROUP, 2 * WORKGROUP, u32::MAX]) {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(across.div_ceil(share), down.div_ceil(share), 1);
        }
    }
}

impl TileLists {
    /// Triangles of a draw of all tiles.
    pub fn triangles(&self) -> u64 {
        2 * tiles(self.blocks)
    }

    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>, call: Call) {
        pass.dispatch_workgroups_indirect(&self.arguments, call as u64 * ARGUMENTS);
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, call: Call) {
        pass.draw_indirect(&self.arguments, call as u64 * ARGUMENTS);
    }

    pub fn bytes(&self) -> u64 {
        self.values.size() + self.list.size() + self.arguments.size()
    }
}

/// Tiles of so many blocks.
fn tiles((across, down): (u32, u32)) -> u64 {
    u64::from(across.div_ceil(2)) * u64::from(down.div_ceil(2))
}
