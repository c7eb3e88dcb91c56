//! A separable Gaussian over a visibility target, in place.

use super::COLUMNS_SHADER;
use super::RESULT_SHADER;
use super::ROWS_SHADER;
use super::tiles::{Call, TileLists, Tiles};
use crate::fullscreen::{self, FLOATS, Fullscreen, STORAGE, UNIFORM, attachment, bind, layout};
use crate::shader::shader_struct;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, view::View, visibility::VisibilityTarget};

shader_struct! {
    /// See `head.wgsl`.
    pub(crate) struct Blur {
        pixel_depth: [f32; 2],
        rounding: [f32; 2],
        ndc_from_pixel: [f32; 2],
        background_depth: f32,
        tile: u32,
    }
}

const WORDS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
const VALUES: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Blurs along rows, then along columns.
pub(super) struct ScreenBlur {
    gpu: Gpu,
    tiles: Tiles,
    layouts: [wgpu::BindGroupLayout; 3],
    rows: wgpu::ComputePipeline,
    beside: wgpu::ComputePipeline,
    columns: wgpu::ComputePipeline,
    result: wgpu::RenderPipeline,
    nearest: wgpu::Sampler,
    uniform: wgpu::Buffer,
    data: Blur,
    targets: Option<Targets>,
    /// The target that is blurred.
    read: Option<ReadTarget>,
}

struct Targets {
    size: (u32, u32),
    rows: wgpu::TextureView,
    read_rows: wgpu::BindGroup,
    read_columns: wgpu::BindGroup,
    lists: TileLists,
}

struct ReadTarget {
    texture: wgpu::Texture,
    for_tiles: wgpu::BindGroup,
    for_rows: wgpu::BindGroup,
}

pub(super) fn compute(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    entry: &str,
    groups: &[&wgpu::BindGroupLayout],
    constants: &[(&str, f64)],
) -> wgpu::ComputePipeline {
    let groups: Vec<_> = groups.iter().map(|g| Some(*g)).collect();
    let layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor { bind_group_layouts: &groups, ..Default::default() });
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
        cache: None,
    })
}

impl ScreenBlur {
    /// `radius` in pixels, over 0.
    pub fn new(gpu: &Gpu, radius: f64, depth_aware: bool) -> Self {
        let tiles = Tiles::new(gpu, radius.ceil() as u32, depth_aware);
        let constants = vec![
            ("RADIUS", radius),
            ("DEPTH_AWARE", f64::from(u8::from(depth_aware))),
            ("BLOCK", f64::from(tiles.block())),
        ];
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
        let written = |format| wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format,
            view_dimension: wgpu::TextureViewDimension::D2,
        };
        let values = fullscreen::texture(FLOATS);
        let words = fullscreen::texture(wgpu::TextureSampleType::Uint);
        let layouts = [
            layout(gpu, "rows", wgpu::ShaderStages::COMPUTE, &[UNIFORM, STORAGE, values, sampler, written(WORDS)]),
            layout(gpu, "columns", wgpu::ShaderStages::COMPUTE, &[UNIFORM, STORAGE, words, written(VALUES)]),
            layout(gpu, "result", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM, STORAGE, words]),
        ];
        let receivers = Receivers::layout(gpu);
        let rows_module = ROWS_SHADER.module(gpu);
        let result = Fullscreen {
            label: "blurred",
            module: &RESULT_SHADER.module(gpu),
            entry: "result",
            groups: &[&layouts[2]],
            target: VisibilityTarget::FORMAT.into(),
            constants: &[],
        }
        .pipeline(gpu);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            rows: compute(gpu, &rows_module, "rows", &[&receivers, &layouts[0]], &constants),
            beside: compute(gpu, &rows_module, "beside", &[&receivers, &layouts[0]], &constants),
            columns: compute(gpu, &COLUMNS_SHADER.module(gpu), "columns", &[&receivers, &layouts[1]], &constants),
            result,
            layouts,
            tiles,
            gpu: gpu.clone(),
            nearest: gpu.device.create_sampler(&Default::default()),
            uniform: gpu.buffer("blur", &[Blur::default()], usage),
            data: Blur::default(),
            targets: None,
            read: None,
        }
    }

    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) {
        let (width, height) = view.receivers.size;
        let clip = view.camera.clip_from_view;
        let background = f64::from(view.camera.background_depth());
        // Half widths of the picture at a distance of 1, and so what a pixel spans.
        let pixel = 2.0 / (f64::from(width) * clip.x_axis.x.abs()).min(f64::from(height) * clip.y_axis.y.abs());
        let toward = if background == 0.0 { 1.0 } else { -1.0 };
        let pixel_depth = if clip.z_axis.w == 0.0 {
            [0.0, pixel * clip.z_axis.z.abs()]
        } else {
            [pixel, pixel * toward * (background + clip.z_axis.z)]
        };
        self.data = Blur {
            pixel_depth: pixel_depth.map(|d| d as f32),
            rounding: [2e-4, background as f32 * 1e-6],
            ndc_from_pixel: [2.0 / width as f32, -2.0 / height as f32],
            background_depth: background as f32,
            tile: 2 * self.tiles.block(),
        };
        if self.targets.as_ref().is_none_or(|t| t.size != view.receivers.size) {
            self.targets = Some(self.targets(gpu, view.receivers.size));
            self.read = None;
        }
    }

    /// Blurs what is in `target`.
    pub fn record(&mut self, passes: &mut Passes<'_>, receivers: &Receivers, target: &VisibilityTarget) {
        let read = self.read.take().filter(|r| r.texture == target.texture).or_else(|| self.read(target));
        let (Some(read), Some(targets)) = (read, &self.targets) else { return };
        passes.upload(&self.uniform, bytemuck::bytes_of(&self.data));
        self.tiles.record(passes.encoder(), &targets.lists);
        let lists = &targets.lists;
        let one = std::env::var("ONE").is_ok();
        let mut pass = passes.compute("tiles");
        self.tiles.find(&mut pass, lists, &read.for_tiles);
        if !one {
            drop(pass);
            pass = passes.compute("rows");
        }
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, &read.for_rows, &[]);
        pass.set_pipeline(&self.rows);
        lists.dispatch(&mut pass, Call::Blurred);
        pass.set_pipeline(&self.beside);
        lists.dispatch(&mut pass, Call::Beside);
        if !one {
            drop(pass);
            pass = passes.compute("columns");
            pass.set_bind_group(0, &receivers.bind_group, &[]);
        }
        pass.set_bind_group(1, &targets.read_rows, &[]);
        pass.set_pipeline(&self.columns);
        lists.dispatch(&mut pass, Call::Blurred);
        drop(pass);
        let mut pass = passes.render("blurred", &[attachment(&target.view, wgpu::LoadOp::Load)], None);
        pass.set_bind_group(0, &targets.read_columns, &[]);
        pass.set_pipeline(&self.result);
        lists.draw(&mut pass, Call::Result);
        drop(pass);
        self.read = Some(read);
    }

    /// Triangles of all tiles, whether they are drawn or not.
    pub fn triangles(&self) -> u64 {
        self.targets.as_ref().map_or(0, |t| 2 * t.lists.count())
    }

    pub fn bytes(&self) -> u64 {
        let targets = self.targets.as_ref();
        let bytes = targets
            .map_or(0, |t| u64::from(t.size.0.div_ceil(2)) * u64::from(t.size.1.div_ceil(2)) * 20 + t.lists.bytes());
        bytes + self.uniform.size()
    }

    fn targets(&self, gpu: &Gpu, size: (u32, u32)) -> Targets {
        let lists = self.tiles.lists(gpu, size);
        let view = |label, format| {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size.0.div_ceil(2),
                    height: size.1.div_ceil(2),
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        let rows = view("blurred rows", WORDS);
        let columns = view("blurred columns", VALUES);
        let texture = wgpu::BindingResource::TextureView;
        let (uniform, list) = (self.uniform.as_entire_binding(), lists.list.as_entire_binding());
        let read_rows =
            bind(gpu, "columns", &self.layouts[1], &[uniform.clone(), list.clone(), texture(&rows), texture(&columns)]);
        let read_columns = bind(gpu, "result", &self.layouts[2], &[uniform, list, texture(&columns)]);
        Targets { size, rows, read_rows, read_columns, lists }
    }

    fn read(&self, target: &VisibilityTarget) -> Option<ReadTarget> {
        let targets = self.targets.as_ref()?;
        let for_tiles = self.tiles.bind(&self.gpu, target, &targets.lists);
        let resources = [
            self.uniform.as_entire_binding(),
            targets.lists.list.as_entire_binding(),
            wgpu::BindingResource::TextureView(&target.view),
            wgpu::BindingResource::Sampler(&self.nearest),
            wgpu::BindingResource::TextureView(&targets.rows),
        ];
        let for_rows = bind(&self.gpu, "rows", &self.layouts[0], &resources);
        Some(ReadTarget { texture: target.texture.clone(), for_tiles, for_rows })
    }
}
