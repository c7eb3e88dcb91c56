//! A separable Gaussian over a visibility target, in place.

use super::COLUMNS_SHADER;
use super::RESULT_SHADER;
use super::ROWS_SHADER;
use super::tiles::{Call, TileLists, Tiles};
use crate::compute::compute_pipeline;
use crate::fullscreen::{self, FLOATS, Fullscreen, STORAGE, UNIFORM, attachment, bind, layout};
use crate::shader::shader_struct;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, view::View, visibility::VisibilityTarget};
use umbrage_core::CameraView;

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

/// Visibility of four pixels, see `quads.wgsl`.
const QUAD: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Blurs along rows, then along columns, then puts the blurred tiles back.
pub(super) struct ScreenBlur {
    gpu: Gpu,
    tiles: Tiles,
    /// What rows, columns and the result bind.
    layouts: [wgpu::BindGroupLayout; 3],
    pipelines: Pipelines,
    nearest: wgpu::Sampler,
    uniform: wgpu::Buffer,
    data: Blur,
    targets: Option<Targets>,
    source: Option<Source>,
}

struct Pipelines {
    rows: wgpu::ComputePipeline,
    copy: wgpu::ComputePipeline,
    columns: wgpu::ComputePipeline,
    result: wgpu::RenderPipeline,
}

/// As large as the picture.
struct Targets {
    size: (u32, u32),
    rows: wgpu::TextureView,
    for_columns: wgpu::BindGroup,
    for_result: wgpu::BindGroup,
    lists: TileLists,
}

/// The visibility target that is blurred.
struct Source {
    texture: wgpu::Texture,
    for_tiles: wgpu::BindGroup,
    for_rows: wgpu::BindGroup,
}

impl ScreenBlur {
    /// `radius` in pixels, over 0.
    pub fn new(gpu: &Gpu, radius: f64, depth_aware: bool) -> Self {
        let tiles = Tiles::new(gpu, radius.ceil() as u32, depth_aware);
        let layouts = layouts(gpu);
        let constants = [
            ("RADIUS", radius),
            ("DEPTH_AWARE", f64::from(u8::from(depth_aware))),
            ("BLOCK", f64::from(tiles.block)),
            ("ALONG_ROWS", 1.0),
        ];
        Self {
            gpu: gpu.clone(),
            tiles,
            pipelines: Pipelines::new(gpu, &layouts, constants),
            layouts,
            nearest: gpu.sampler(&Default::default()),
            uniform: gpu.buffer("blur", &[Blur::default()], wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST),
            data: Blur::default(),
            targets: None,
            source: None,
        }
    }

    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) {
        self.data = Blur::new(&view.camera, view.receivers.size, 2 * self.tiles.block);
        if self.targets.as_ref().is_none_or(|t| t.size != view.receivers.size) {
            self.targets = Some(self.targets(gpu, view.receivers.size));
            self.source = None;
        }
    }

    /// Blurs what is in `target`.
    pub fn record(&mut self, passes: &mut Passes<'_>, receivers: &Receivers, target: &VisibilityTarget) {
        let Some(targets) = &self.targets else { return };
        let known = self.source.take().filter(|s| s.texture == target.texture);
        let source = &*self.source.insert(known.unwrap_or_else(|| {
            let for_tiles = self.tiles.bind(&self.gpu, target, &targets.lists);
            Source { texture: target.texture.clone(), for_tiles, for_rows: self.for_rows(target, targets) }
        }));
        passes.upload(&self.uniform, bytemuck::bytes_of(&self.data));
        let lists = &targets.lists;
        self.tiles.record(passes, lists, &source.for_tiles);
        let Pipelines { rows, copy, columns, result } = &self.pipelines;
        let mut blur = |label, from, dispatches: &[(&wgpu::ComputePipeline, Call)]| {
            let mut pass = passes.compute(label);
            pass.set_bind_group(0, &receivers.bind_group, &[]);
            pass.set_bind_group(1, from, &[]);
            for (pipeline, call) in dispatches {
                pass.set_pipeline(pipeline);
                lists.dispatch(&mut pass, *call);
            }
        };
        blur("blur rows", &source.for_rows, &[(rows, Call::Blurred), (copy, Call::Beside)]);
        blur("blur columns", &targets.for_columns, &[(columns, Call::Blurred)]);
        let mut pass = passes.render("blurred", &[attachment(&target.view, wgpu::LoadOp::Load)], None);
        pass.set_bind_group(0, &targets.for_result, &[]);
        pass.set_pipeline(result);
        lists.draw(&mut pass, Call::Result);
    }

    /// Triangles of all tiles, whether they are drawn or not.
    pub fn triangles(&self) -> u64 {
        self.targets.as_ref().map_or(0, |t| t.lists.triangles())
    }

    pub fn bytes(&self) -> u64 {
        let quads = |(width, height)| u64::from(half(width)) * u64::from(half(height));
        self.uniform.size() + self.targets.as_ref().map_or(0, |t| 2 * 4 * quads(t.size) + t.lists.bytes())
    }

    fn targets(&self, gpu: &Gpu, size: (u32, u32)) -> Targets {
        let (rows, columns) = (quads(gpu, "blurred rows", size), quads(gpu, "blurred columns", size));
        let lists = self.tiles.lists(gpu, size);
        let shared = [self.uniform.as_entire_binding(), lists.list.as_entire_binding()];
        let [for_rows, for_columns] = [&rows, &columns].map(wgpu::BindingResource::TextureView);
        let nearest = wgpu::BindingResource::Sampler(&self.nearest);
        let blurs_columns = [&shared[..], &[nearest, for_rows, for_columns.clone()]].concat();
        let for_result = bind(gpu, "result", &self.layouts[2], &[&shared[..], &[for_columns]].concat());
        let for_columns = bind(gpu, "columns", &self.layouts[1], &blurs_columns);
        Targets { size, rows, for_columns, for_result, lists }
    }

    fn for_rows(&self, target: &VisibilityTarget, targets: &Targets) -> wgpu::BindGroup {
        let resources = [
            self.uniform.as_entire_binding(),
            targets.lists.list.as_entire_binding(),
            wgpu::BindingResource::Sampler(&self.nearest),
            wgpu::BindingResource::TextureView(&target.view),
            wgpu::BindingResource::TextureView(&targets.rows),
        ];
        bind(&self.gpu, "rows", &self.layouts[0], &resources)
    }
}

impl Pipelines {
    /// The last of the constants is whether rows are blurred.
    fn new(gpu: &Gpu, layouts: &[wgpu::BindGroupLayout; 3], constants: [(&str, f64); 4]) -> Self {
        let [all @ .., (along_rows, _)] = constants;
        let compute = |module: &wgpu::ShaderModule, entry, layout: usize, rows: f64| {
            let constants = [&all[..], &[(along_rows, rows)]].concat();
            compute_pipeline(gpu, module, entry, &[Some(&Receivers::layout(gpu)), Some(&layouts[layout])], &constants)
        };
        let (rows, columns) = (ROWS_SHADER.module(gpu), COLUMNS_SHADER.module(gpu));
        let result = Fullscreen {
            label: "blurred",
            module: &RESULT_SHADER.module(gpu),
            entry: "result",
            groups: &[&layouts[2]],
            target: VisibilityTarget::FORMAT.into(),
            constants: &[],
        };
        Self {
            copy: compute(&rows, "copy", 0, 1.0),
            rows: compute(&rows, "blur_rows", 0, 1.0),
            columns: compute(&columns, "blur_columns", 1, 0.0),
            result: result.pipeline(gpu),
        }
    }
}

impl Blur {
    /// For pictures of `width` × `height` and tiles of so many pixels.
    fn new(camera: &CameraView, (width, height): (u32, u32), tile: u32) -> Self {
        let clip = camera.clip_from_view;
        let background = f64::from(camera.background_depth());
        // What a pixel spans: at a distance of 1, or on a parallel picture everywhere.
        let pixel = 2.0 / (f64::from(width) * clip.x_axis.x.abs()).min(f64::from(height) * clip.y_axis.y.abs());
        // In perspective depth is a constant plus something over the distance, and changes by the
        // latter where the distance does by its own length.
        let pixel_depth = if clip.z_axis.w == 0.0 {
            [0.0, pixel * clip.z_axis.z.abs()]
        } else {
            [pixel, pixel * (background - clip.z_axis.z / clip.z_axis.w).abs()]
        };
        Self {
            pixel_depth: pixel_depth.map(|d| d as f32),
            rounding: [ROUNDING, background as f32 * ROUNDING],
            ndc_from_pixel: [2.0 / width as f32, -2.0 / height as f32],
            background_depth: background as f32,
            tile,
        }
    }
}

/// Of depth in single precision, some steps.
const ROUNDING: f32 = 1e-6;

/// Quads across so many pixels.
fn half(pixels: u32) -> u32 {
    pixels.div_ceil(2)
}

/// A texel for each quad of a picture.
fn quads(gpu: &Gpu, label: &str, (width, height): (u32, u32)) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: half(width), height: half(height), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: QUAD,
        usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

fn layouts(gpu: &Gpu) -> [wgpu::BindGroupLayout; 3] {
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let (values, quads) = (fullscreen::texture(FLOATS), fullscreen::texture(wgpu::TextureSampleType::Uint));
    let written = wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format: QUAD,
        view_dimension: wgpu::TextureViewDimension::D2,
    };
    [
        layout(gpu, "rows", wgpu::ShaderStages::COMPUTE, &[UNIFORM, STORAGE, sampler, values, written]),
        layout(gpu, "columns", wgpu::ShaderStages::COMPUTE, &[UNIFORM, STORAGE, sampler, quads, written]),
        layout(gpu, "result", wgpu::ShaderStages::VERTEX_FRAGMENT, &[UNIFORM, STORAGE, quads]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::glam::{DAffine3, DMat4, DVec4};

    /// A projection as wide as high, 200 pixels a side, at distances of 0.5 to 50.
    fn check(name: &str, z: DVec4, w: DVec4, span: impl Fn(f64) -> f64) {
        let clip = DMat4::from_cols(DVec4::X * 2.0, DVec4::Y * 2.0, z, w);
        let camera = CameraView::from_matrices(DAffine3::IDENTITY, clip);
        let blur = Blur::new(&camera, (200, 200), 8);
        let depth = |distance: f64| {
            let p = clip * DVec4::new(0.0, 0.0, -distance, 1.0);
            p.z / p.w
        };
        for distance in [0.5, 2.0, 50.0] {
            let by = 1e-4 * distance;
            let change = (depth(distance + by) - depth(distance - by)).abs() / (2.0 * by) * span(distance);
            let from_background = (depth(distance) - f64::from(blur.background_depth)).abs();
            let stated = f64::from(blur.pixel_depth[0]) * from_background + f64::from(blur.pixel_depth[1]);
            assert!((stated / change - 1.0).abs() < 1e-3, "{name} at {distance}: {stated}, not {change}");
        }
    }

    #[test]
    fn depth_changes_as_stated_over_the_width_of_a_pixel() {
        let (near, far) = (0.1, 100.0);
        let perspective = |scale: f64, at: f64| (DVec4::new(0.0, 0.0, scale, -1.0), DVec4::new(0.0, 0.0, at, 0.0));
        let wider_with_distance = |distance: f64| distance / 200.0;
        for (name, (z, w)) in [
            ("reversed, infinite", perspective(0.0, near)),
            ("reversed, finite", perspective(near / (far - near), near * far / (far - near))),
            ("not reversed", perspective(far / (near - far), near * far / (near - far))),
        ] {
            check(name, z, w, wider_with_distance);
        }
        let parallel = |scale: f64, at: f64| (DVec4::Z * scale, DVec4::new(0.0, 0.0, at, 1.0));
        for (name, (z, w)) in [("parallel", parallel(-0.01, 0.0)), ("parallel, reversed", parallel(0.01, 1.0))] {
            check(name, z, w, |_| 1.0 / 200.0);
        }
    }
}
