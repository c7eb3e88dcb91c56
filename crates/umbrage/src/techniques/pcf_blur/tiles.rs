//! Finds the tiles of a visibility target around which values differ, and lists them for indirect draws.

use super::TILES_SHADER;
use crate::fullscreen::{self, FLOATS, bind, layout};
use crate::{gpu::Gpu, passes::Passes, visibility::VisibilityTarget};

/// Tiles that an instance draws, see `blur.wgsl`.
const GROUP: u32 = 64;

/// Blocks or tiles across and down a workgroup.
const WORKGROUP: u32 = 8;

/// Numbers before the tiles of a list.
const HEADER: [u32; 2] = [0; 2];

/// No instance yet.
const DRAW: [u32; 4] = [6 * GROUP, 0, 0, 0];

/// Lists of tiles.
pub(super) struct Tiles {
    /// Pixels across and down a block; a tile is two across and down.
    block: u32,
    layout: wgpu::BindGroupLayout,
    /// Blocks, tiles, their number.
    pipelines: [wgpu::ComputePipeline; 3],
}

/// Room for the tiles of a picture.
pub(super) struct TileLists {
    /// Blocks across and down.
    blocks: (u32, u32),
    values: wgpu::Buffer,
    /// Read by the vertex shader of `blur.wgsl`.
    pub list: wgpu::Buffer,
    arguments: wgpu::Buffer,
}

impl Tiles {
    /// For blurs that reach so many pixels.
    pub fn new(gpu: &Gpu, reach: u32) -> Self {
        let block = reach.next_power_of_two().max(4);
        let written = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let bindings = [fullscreen::texture(FLOATS), written, written, written];
        let layout = layout(gpu, "tiles", wgpu::ShaderStages::COMPUTE, &bindings);
        let module = TILES_SHADER.module(gpu);
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&layout)],
            ..Default::default()
        });
        let constants = [("BLOCK", f64::from(block))];
        let pipelines = ["find_blocks", "find_tiles", "group_tiles"].map(|entry| {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                cache: None,
            })
        });
        Self { block, layout, pipelines }
    }

    /// Pixels across and down a tile.
    pub fn size(&self) -> u32 {
        2 * self.block
    }

    pub fn lists(&self, gpu: &Gpu, (width, height): (u32, u32)) -> TileLists {
        let blocks = (width.div_ceil(self.block), height.div_ceil(self.block));
        let tiles = u64::from(blocks.0.div_ceil(2)) * u64::from(blocks.1.div_ceil(2));
        let buffer = |label, words: u64, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: 4 * words,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | usage,
                mapped_at_creation: false,
            })
        };
        let none = wgpu::BufferUsages::empty();
        TileLists {
            blocks,
            values: buffer("blocks", u64::from(blocks.0) * u64::from(blocks.1), none),
            list: buffer("tiles", HEADER.len() as u64 + tiles, none),
            arguments: buffer("draws of tiles", 2 * DRAW.len() as u64, wgpu::BufferUsages::INDIRECT),
        }
    }

    pub fn bind(&self, gpu: &Gpu, target: &VisibilityTarget, lists: &TileLists) -> wgpu::BindGroup {
        let resources = [
            wgpu::BindingResource::TextureView(&target.view),
            lists.values.as_entire_binding(),
            lists.list.as_entire_binding(),
            lists.arguments.as_entire_binding(),
        ];
        bind(gpu, "tiles", &self.layout, &resources)
    }

    /// Fills the lists that `bind_group` is of.
    pub fn record(&self, passes: &mut Passes<'_>, lists: &TileLists, bind_group: &wgpu::BindGroup) {
        passes.upload(&lists.list, bytemuck::bytes_of(&HEADER));
        passes.upload(&lists.arguments, bytemuck::bytes_of(&[DRAW; 2]));
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
    /// Tiles of a picture, all together.
    pub fn count(&self) -> u64 {
        u64::from(self.blocks.0.div_ceil(2)) * u64::from(self.blocks.1.div_ceil(2))
    }

    /// Draws the tiles that are blurred.
    pub fn draw_blurred(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.draw_indirect(&self.arguments, 0);
    }

    /// Draws the tiles beside them.
    pub fn draw_beside(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.draw_indirect(&self.arguments, size_of_val(&DRAW) as u64);
    }

    pub fn bytes(&self) -> u64 {
        self.values.size() + self.list.size() + self.arguments.size()
    }
}
