//! Nearest depths of ever larger parts of a map: what lets soft filters skip what is surely lit,
//! and look for blockers only as far as there can be some.

use crate::compute::compute_pipeline;
use crate::depth_maps::frame::MapFrame;
use crate::fullscreen::{STORAGE, UNIFORM, bind, layout};
use crate::shader::{Shader, Shared, shader_struct};
use crate::{gpu::Gpu, passes::Passes};

/// Makes the pyramid, level by level.
pub(crate) const BOUNDS_SHADER: Shader = Shader::new("map bounds", include_str!("map_bounds.wgsl"))
    .with_layouts(&[MapBoundsPass::LAYOUT])
    .with_constants(&[("WORKGROUP", WORKGROUP as f64)]);

/// What the host has to agree on with `map_cells.wgsl`.
pub(in crate::depth_maps) const SHARED: Shared =
    Shared { module: "map_cells", layouts: &[MapBoundsHead::LAYOUT], constants: &[] };

/// Most cells a side of the finest level: larger maps have wider cells.
const MOST_CELLS: u32 = 1024;

/// Base 2 logarithm of the texels across a cell of the finest level, at least.
const FINEST: u32 = 2;

/// Threads of a workgroup a side.
const WORKGROUP: u32 = 8;

shader_struct! {
    /// See `map_cells.wgsl`.
    pub(crate) struct MapBoundsHead {
        cells: u32,
        finest: u32,
        levels: u32,
        pad: u32,
    }
}

shader_struct! {
    /// See `map_bounds.wgsl`.
    pub(crate) struct MapBoundsPass {
        layer: u32,
        level: u32,
    }
}

impl MapBoundsHead {
    /// For maps of this size in texels.
    fn of(size: u32) -> Self {
        let side = size.next_power_of_two();
        let finest = FINEST.max(side.div_ceil(MOST_CELLS).ilog2());
        let cells = (side >> finest).max(1);
        Self { cells, finest, levels: cells.ilog2() + 1, pad: 0 }
    }

    /// Cells of all levels of a layer.
    fn in_layer(&self) -> u64 {
        (4 * u64::from(self.cells).pow(2) - 1) / 3
    }
}

/// The pyramid over all layers of a light's maps.
pub(crate) struct BoundsPyramid {
    layout: wgpu::BindGroupLayout,
    of_map: wgpu::ComputePipeline,
    of_bounds: wgpu::ComputePipeline,
    made: Option<Made>,
}

struct Made {
    /// The maps it was made for.
    maps: wgpu::Texture,
    head: MapBoundsHead,
    buffer: wgpu::Buffer,
    /// For each layer, its levels from the finest.
    layers: Vec<Vec<wgpu::BindGroup>>,
    /// By layer: the version of the map that bounds were last taken of.
    taken: Vec<u64>,
}

impl BoundsPyramid {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let maps = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let written = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let layout = layout(gpu, "map bounds", wgpu::ShaderStages::COMPUTE, &[maps, written, UNIFORM]);
        let module = BOUNDS_SHADER.module(gpu);
        let pipeline = |entry| compute_pipeline(gpu, &module, entry, &[Some(&layout)], &[]);
        Self { of_map: pipeline("bounds_of_map"), of_bounds: pipeline("bounds_of_bounds"), layout, made: None }
    }

    /// What the look-up binds.
    pub(crate) const BINDING: wgpu::BindingType = STORAGE;

    /// Makes room for the pyramid of these maps; true where that is new.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, maps: &wgpu::Texture) -> bool {
        if self.made.as_ref().is_some_and(|m| m.maps == *maps) {
            return false;
        }
        self.made = Some(self.make(gpu, maps));
        true
    }

    pub(crate) fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.made.as_ref().map(|m| &m.buffer)
    }

    /// Fills the layers that were rendered since.
    pub(crate) fn record(&mut self, passes: &mut Passes<'_>, maps: &MapFrame) {
        let Some(made) = &mut self.made else { return };
        let mut is_new = |layer: u32| {
            let now = maps.version(layer);
            std::mem::replace(&mut made.taken[layer as usize], now) != now
        };
        let layers: Vec<u32> = maps.views.iter().map(|view| view.layer).filter(|layer| is_new(*layer)).collect();
        if layers.is_empty() {
            return;
        }
        let mut pass = passes.compute("map bounds");
        for level in 0..made.head.levels {
            pass.set_pipeline(if level == 0 { &self.of_map } else { &self.of_bounds });
            let groups = (made.head.cells >> level).div_ceil(WORKGROUP);
            for layer in &layers {
                pass.set_bind_group(0, &made.layers[*layer as usize][level as usize], &[]);
                pass.dispatch_workgroups(groups, groups, 1);
            }
        }
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.made.as_ref().map_or(0, |m| m.buffer.size())
    }

    fn make(&self, gpu: &Gpu, maps: &wgpu::Texture) -> Made {
        let head = MapBoundsHead::of(maps.width());
        let count = maps.depth_or_array_layers();
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("map bounds"),
            size: size_of::<MapBoundsHead>() as u64 + 4 * head.in_layer() * u64::from(count),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&head));
        let view = maps.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let one = |layer, level| {
            let uniform = gpu.buffer("level", &[MapBoundsPass { layer, level }], wgpu::BufferUsages::UNIFORM);
            let resources =
                [wgpu::BindingResource::TextureView(&view), buffer.as_entire_binding(), uniform.as_entire_binding()];
            bind(gpu, "map bounds", &self.layout, &resources)
        };
        let layers = (0..count).map(|layer| (0..head.levels).map(|level| one(layer, level)).collect()).collect();
        Made { maps: maps.clone(), head, buffer, layers, taken: vec![0; count as usize] }
    }
}
