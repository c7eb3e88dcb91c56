//! Pictures of the planes, and of their shadows.

use crate::fullscreen::{self, FLOATS, Fullscreen, attachment, bind, layout, target_texture};
use crate::planar::Finder;
use crate::receivers::Receivers;
use crate::shader::Shader;
use crate::technique::DebugView;
use crate::{gpu::Gpu, passes::Passes, visibility::VisibilityTarget};

pub(super) const VIEWS_SHADER: Shader = Shader::new("views of planes", include_str!("views.wgsl"));

/// What can be asked for.
pub(super) const NAMES: &[&str] = &["planes", "mask"];

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// One of the pictures, drawn every frame after the shadows.
pub(super) struct Views {
    name: &'static str,
    layout: wgpu::BindGroupLayout,
    pipeline: Option<(bool, wgpu::RenderPipeline)>,
    target: Option<(wgpu::Texture, wgpu::TextureView)>,
    read: Option<(wgpu::TextureView, wgpu::BindGroup)>,
}

impl Views {
    pub fn new(gpu: &Gpu, name: &'static str) -> Self {
        let layout = layout(gpu, "visibility", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS)]);
        Self { name, layout, pipeline: None, target: None, read: None }
    }

    pub fn picture(&self) -> Option<DebugView<'_>> {
        self.target.as_ref().map(|(texture, _)| DebugView { name: self.name, texture, layer: 0 })
    }

    /// Makes target and pipeline.
    pub fn prepare(&mut self, gpu: &Gpu, receivers: &Receivers, finder: &Finder) {
        let (width, height) = receivers.size;
        if self.target.as_ref().is_none_or(|(texture, _)| (texture.width(), texture.height()) != (width, height)) {
            let texture = target_texture(gpu, "view", receivers.size, 1, COLOR);
            let view = texture.create_view(&Default::default());
            self.target = Some((texture, view));
        }
        if self.pipeline.as_ref().is_none_or(|(has_normals, _)| *has_normals != receivers.has_normals) {
            let pipeline = Fullscreen {
                label: self.name,
                module: &VIEWS_SHADER.module(gpu),
                entry: self.name,
                groups: &[&Receivers::layout(gpu), &finder.layout, &self.layout],
                target: COLOR.into(),
                constants: &[("HAS_NORMALS", f64::from(u8::from(receivers.has_normals)))],
            }
            .pipeline(gpu);
            self.pipeline = Some((receivers.has_normals, pipeline));
        }
    }

    /// Draws the picture.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        finder: &Finder,
        visibility: &VisibilityTarget,
    ) {
        if self.read.as_ref().is_none_or(|(view, _)| *view != visibility.view) {
            let resources = [wgpu::BindingResource::TextureView(&visibility.view)];
            self.read = Some((visibility.view.clone(), bind(gpu, "visibility", &self.layout, &resources)));
        }
        let (Some((_, target)), Some((_, pipeline)), Some((_, read))) = (&self.target, &self.pipeline, &self.read)
        else {
            return;
        };
        let mut pass = passes.render("view", &[attachment(target, wgpu::LoadOp::Clear(wgpu::Color::BLACK))], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, &finder.bind_group, &[]);
        pass.set_bind_group(2, read, &[]);
        pass.draw(0..3, 0..1);
    }
}
