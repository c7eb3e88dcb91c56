//! Visibility in targets of a host's own: other formats, one channel of several, a part of a larger
//! texture, a layer of an array; and from half the size to the full one.

mod target;
mod upsample;

use crate::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, bind};
use crate::shader::{Shader, shader_struct};
use crate::{error::Error, gpu::Gpu, passes::Passes, visibility::VisibilityTarget};
use target::HostTarget;
pub use upsample::{Coarse, Upsample};

const SHADER: Shader = Shader::new("deliver", include_str!("deliver.wgsl")).with_layouts(&[Delivery::LAYOUT]);

/// All shaders of this module.
pub(crate) const SHADERS: [Shader; 2] = [SHADER, upsample::SHADER];

shader_struct! {
    /// See `deliver.wgsl`.
    struct Delivery {
        corner: [i32; 2],
        pad_a: f32,
        pad_b: f32,
    }
}

/// Copies visibility to a host's target by one full-screen pass, which reads two bytes a pixel and
/// writes what the format has. The value goes to all channels; the write mask chooses one, and the
/// blend state may multiply it with what is there.
///
/// Techniques themselves write `R16Float` alone: several of them draw to their target more than
/// once, or read what they have drawn.
pub struct Deliver {
    gpu: Gpu,
    target: HostTarget,
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    bound: Option<(wgpu::TextureView, wgpu::BindGroup)>,
}

impl Deliver {
    /// For targets of this kind; for one channel of four:
    ///
    /// ```
    /// let green = wgpu::ColorTargetState {
    ///     write_mask: wgpu::ColorWrites::GREEN,
    ///     ..wgpu::TextureFormat::Rgba8Unorm.into()
    /// };
    /// ```
    ///
    /// # Errors
    /// [`Error::Lent`] for a format that can't be drawn to, or that takes no floats, and for a
    /// blend state that does not go with it.
    pub fn new(gpu: &Gpu, target: wgpu::ColorTargetState) -> Result<Self, Error> {
        let target = HostTarget::new(gpu, target)?;
        let stages = wgpu::ShaderStages::FRAGMENT;
        let layout = fullscreen::layout(gpu, "deliver", stages, &[UNIFORM, fullscreen::texture(FLOATS)]);
        let (label, entry, module) = ("deliver", "deliver", &SHADER.module(gpu));
        let (groups, constants) = (&[&layout], &[]);
        let pipeline = Fullscreen { label, module, entry, groups, target: target.state(), constants }.pipeline(gpu);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = gpu.buffer("deliver", &[Delivery::default()], usage);
        Ok(Self { gpu: gpu.clone(), target, pipeline, layout, uniform, bound: None })
    }

    /// Records the pass: `visibility` is then in `target` from pixel `corner` on, and what is
    /// around it stays.
    ///
    /// # Errors
    /// [`Error::Lent`] where it does not fit in.
    pub fn record(
        &mut self,
        passes: &mut Passes<'_>,
        visibility: &VisibilityTarget,
        target: &wgpu::TextureView,
        corner: (u32, u32),
    ) -> Result<(), Error> {
        let corner_i32 = [corner.0 as i32, corner.1 as i32];
        passes.upload(&self.uniform, bytemuck::bytes_of(&Delivery { corner: corner_i32, ..Default::default() }));
        let kept = self.bound.take().filter(|(view, _)| *view == visibility.view);
        let bind_group = kept.map_or_else(|| self.bind(&visibility.view), |(_, group)| group);
        let mut pass = self.target.begin(passes, "deliver visibility", target, corner, visibility.size)?;
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.bound = Some((visibility.view.clone(), bind_group));
        Ok(())
    }

    fn bind(&self, view: &wgpu::TextureView) -> wgpu::BindGroup {
        let resources = [self.uniform.as_entire_binding(), wgpu::BindingResource::TextureView(view)];
        bind(&self.gpu, "deliver", &self.layout, &resources)
    }
}
