//! Pictures of what a look-up finds, drawn over the scene when somebody looks at one.

use super::variant::Variant;
use crate::fullscreen::{Fullscreen, attachment, target_texture};
use crate::technique::DebugView;
use crate::{gpu::Gpu, passes::Passes, shader::Shader};

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The pictures of a technique, see `map_picture.wgsl`.
pub(super) struct Pictures {
    module: wgpu::ShaderModule,
    names: &'static [&'static str],
    shown: Option<usize>,
    pipelines: Vec<((Variant, usize), wgpu::RenderPipeline)>,
    current: Option<usize>,
    target: Option<((u32, u32), wgpu::Texture, wgpu::TextureView)>,
}

impl Pictures {
    pub fn new(gpu: &Gpu, shader: &Shader, names: &'static [&'static str]) -> Self {
        let module = shader.module(gpu);
        Self { module, names, shown: None, pipelines: Vec::new(), current: None, target: None }
    }

    /// Shows one of the pictures, or none.
    pub fn inspect(&mut self, view: Option<&str>) {
        self.shown = view.and_then(|view| self.names.iter().position(|name| *name == view));
        self.target = self.target.take().filter(|_| self.shown.is_some());
    }

    /// Whether somebody looks at one.
    pub fn is_shown(&self) -> bool {
        self.shown.is_some()
    }

    /// `variant`: of the look-up, where there is one. `groups` and `constants` are its own.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        variant: Option<Variant>,
        groups: &[&wgpu::BindGroupLayout],
        constants: &[(&'static str, f64)],
        size: (u32, u32),
    ) {
        self.current = None;
        let Some(shown) = self.shown else { return };
        if self.target.as_ref().is_none_or(|(made, ..)| *made != size) {
            let texture = target_texture(gpu, "picture", size, 1, COLOR);
            let view = texture.create_view(&Default::default());
            self.target = Some((size, texture, view));
        }
        let Some(variant) = variant else { return };
        let known = self.pipelines.iter().position(|(key, _)| *key == (variant, shown));
        self.current = Some(known.unwrap_or_else(|| {
            let constants = [constants, &[("PICTURE", shown as f64)]].concat();
            let recipe = Fullscreen {
                label: "picture",
                module: &self.module,
                entry: "inspected",
                groups,
                target: COLOR.into(),
                constants: &constants,
            };
            self.pipelines.push(((variant, shown), recipe.pipeline(gpu)));
            self.pipelines.len() - 1
        }));
    }

    /// Draws it with the bind groups of the look-up; black without a look-up.
    pub fn record(&self, passes: &mut Passes<'_>, groups: [Option<&wgpu::BindGroup>; 3]) {
        let Some((_, _, target)) = self.target.as_ref().filter(|_| self.shown.is_some()) else { return };
        let mut pass = passes.render("view", &[attachment(target, wgpu::LoadOp::Clear(wgpu::Color::BLACK))], None);
        let Some((_, pipeline)) = self.current.and_then(|current| self.pipelines.get(current)) else { return };
        pass.set_pipeline(pipeline);
        for (number, group) in (0..).zip(groups).filter(|(_, group)| group.is_some()) {
            pass.set_bind_group(number, group, &[]);
        }
        pass.draw(0..3, 0..1);
    }

    /// The one that is shown.
    pub fn view(&self) -> Option<DebugView<'_>> {
        let (_, texture, _) = self.target.as_ref()?;
        Some(DebugView { name: self.names.get(self.shown?)?, texture, layer: 0 })
    }

    pub fn bytes(&self) -> u64 {
        self.target.as_ref().map_or(0, |((width, height), ..)| u64::from(*width) * u64::from(*height) * 4)
    }
}
