//! A separable Gaussian over a visibility target, in place.

use super::BLUR_SHADER;
use super::tiles::{TileLists, Tiles};
use crate::depth_maps::Eye;
use crate::fullscreen::{self, FLOATS, Fullscreen, STORAGE, UNIFORM, attachment, bind, layout, target_texture};
use crate::shader::shader_struct;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, view::View, visibility::VisibilityTarget};

shader_struct! {
    /// See `blur.wgsl`.
    pub(crate) struct Blur {
        eye: Eye,
        light: [f32; 4],
    }
}

/// Taps on each side at most; wider blurs leave pixels out in between.
const MOST_TAPS: f64 = 16.0;

/// Blurs along rows, then along columns.
pub(super) struct ScreenBlur {
    gpu: Gpu,
    constants: Vec<(&'static str, f64)>,
    tiles: Tiles,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    data: Blur,
    /// For receivers without normals and with.
    pipelines: [Option<Pipelines>; 2],
    targets: Option<Targets>,
    /// The target that is blurred.
    read: Option<ReadTarget>,
}

struct Pipelines {
    rows: wgpu::RenderPipeline,
    columns: wgpu::RenderPipeline,
    beside: wgpu::RenderPipeline,
}

struct Targets {
    size: (u32, u32),
    /// What is blurred along rows.
    rows: wgpu::TextureView,
    read_rows: wgpu::BindGroup,
    lists: TileLists,
}

struct ReadTarget {
    texture: wgpu::Texture,
    for_tiles: wgpu::BindGroup,
    for_rows: wgpu::BindGroup,
}

impl ScreenBlur {
    /// `radius` in pixels, over 0.
    pub fn new(gpu: &Gpu, radius: f64, depth_aware: bool) -> Self {
        let tiles = Tiles::new(gpu, radius.ceil() as u32);
        let step = (radius / MOST_TAPS).max(1.0);
        let sigma = 0.5 * radius;
        let mut constants = vec![
            ("TILE", f64::from(tiles.size())),
            ("TAPS", radius.ceil().min(MOST_TAPS)),
            ("STEP", step),
            ("FALLOFF", (-0.5 * (step / sigma).powi(2)).exp()),
            ("DEPTH_AWARE", f64::from(u8::from(depth_aware))),
        ];
        if let Ok(v) = std::env::var("BLUR_NORMALS") {
            constants.push(("NORMALS", v.parse().unwrap()));
        }
        if let Ok(v) = std::env::var("BLUR_OFF") {
            constants.push(("OFF_PLANE", v.parse().unwrap()));
        }
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let bindings = [UNIFORM, fullscreen::texture(FLOATS), STORAGE];
        Self {
            gpu: gpu.clone(),
            constants,
            tiles,
            module: BLUR_SHADER.module(gpu),
            layout: layout(gpu, "blur", wgpu::ShaderStages::VERTEX_FRAGMENT, &bindings),
            uniform: gpu.buffer("blur", &[Blur::default()], usage),
            data: Blur::default(),
            pipelines: [None, None],
            targets: None,
            read: None,
        }
    }

    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) {
        let center = view.light.shape.center();
        let light = center.truncate() - view.camera.eye * center.w;
        self.data = Blur { eye: Eye::new(view), light: light.extend(center.w).as_vec4().to_array() };
        if self.targets.as_ref().is_none_or(|t| t.size != view.receivers.size) {
            self.targets = Some(self.targets(gpu, view.receivers.size));
            self.read = None;
        }
        let has_normals = view.receivers.has_normals;
        if self.pipelines[usize::from(has_normals)].is_none() {
            self.pipelines[usize::from(has_normals)] = Some(self.pipelines(gpu, has_normals));
        }
    }

    /// Blurs what is in `target`.
    pub fn record(&mut self, passes: &mut Passes<'_>, receivers: &Receivers, target: &VisibilityTarget) {
        let read = self.read.take().filter(|r| r.texture == target.texture).or_else(|| self.read(target));
        let (Some(read), Some(targets)) = (read, &self.targets) else { return };
        let Some(pipelines) = &self.pipelines[usize::from(receivers.has_normals)] else { return };
        passes.upload(&self.uniform, bytemuck::bytes_of(&self.data));
        self.tiles.record(passes, &targets.lists, &read.for_tiles);
        let mut pass = passes.render("blur rows", &[attachment(&targets.rows, wgpu::LoadOp::Load)], None);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, &read.for_rows, &[]);
        pass.set_pipeline(&pipelines.rows);
        targets.lists.draw_blurred(&mut pass);
        pass.set_pipeline(&pipelines.beside);
        targets.lists.draw_beside(&mut pass);
        drop(pass);
        let mut pass = passes.render("blur columns", &[attachment(&target.view, wgpu::LoadOp::Load)], None);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, &targets.read_rows, &[]);
        pass.set_pipeline(&pipelines.columns);
        targets.lists.draw_blurred(&mut pass);
        drop(pass);
        self.read = Some(read);
    }

    /// Triangles of all tiles, whether they are drawn or not.
    pub fn triangles(&self) -> u64 {
        self.targets.as_ref().map_or(0, |t| 4 * t.lists.count())
    }

    pub fn bytes(&self) -> u64 {
        let targets = self.targets.as_ref();
        let bytes = targets.map_or(0, |t| u64::from(t.size.0) * u64::from(t.size.1) * 2 + t.lists.bytes());
        bytes + self.uniform.size()
    }

    fn pipelines(&self, gpu: &Gpu, has_normals: bool) -> Pipelines {
        let make = |entry, along_rows, beside| {
            let mut constants = self.constants.clone();
            constants.push(("HAS_NORMALS", f64::from(u8::from(has_normals))));
            constants.push(("ALONG_ROWS", f64::from(u8::from(along_rows))));
            constants.push(("BESIDE", f64::from(u8::from(beside))));
            Fullscreen {
                label: "blur",
                module: &self.module,
                entry,
                groups: &[&Receivers::layout(gpu), &self.layout],
                target: VisibilityTarget::FORMAT.into(),
                constants: &constants,
            }
            .pipeline(gpu)
        };
        Pipelines {
            rows: make("blurred", true, false),
            columns: make("blurred", false, false),
            beside: make("unchanged", true, true),
        }
    }

    fn targets(&self, gpu: &Gpu, size: (u32, u32)) -> Targets {
        let texture = target_texture(gpu, "blurred rows", size, 1, VisibilityTarget::FORMAT);
        let rows = texture.create_view(&Default::default());
        let lists = self.tiles.lists(gpu, size);
        let read_rows = self.bind(&rows, &lists);
        Targets { size, rows, read_rows, lists }
    }

    fn read(&self, target: &VisibilityTarget) -> Option<ReadTarget> {
        let lists = &self.targets.as_ref()?.lists;
        let for_tiles = self.tiles.bind(&self.gpu, target, lists);
        let for_rows = self.bind(&target.view, lists);
        Some(ReadTarget { texture: target.texture.clone(), for_tiles, for_rows })
    }

    fn bind(&self, source: &wgpu::TextureView, lists: &TileLists) -> wgpu::BindGroup {
        let resources = [
            self.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(source),
            lists.list.as_entire_binding(),
        ];
        bind(&self.gpu, "blur", &self.layout, &resources)
    }
}
