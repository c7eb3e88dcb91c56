//! From half the size to the full one.

use super::target::HostTarget;
use crate::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, bind};
use crate::receivers::{Eye, Receivers};
use crate::shader::{Shader, shader_struct};
use crate::{error::Error, gpu::Gpu, passes::Passes, visibility::VisibilityTarget};
use umbrage_core::CameraView;

pub(super) const SHADER: Shader =
    Shader::new("upsample", include_str!("upsample.wgsl")).with_layouts(&[Upsampling::LAYOUT]);

shader_struct! {
    /// See `upsample.wgsl`.
    pub(crate) struct Upsampling {
        eye: Eye,
        ndc_from_coarse: [f32; 2],
        scale: [f32; 2],
        corner: [i32; 2],
        coarse_size: [i32; 2],
    }
}

/// Visibility of a smaller size, such as half, and what it was made for.
#[derive(Clone, Copy, Debug)]
pub struct Coarse<'a> {
    /// The same surfaces as in the full picture with fewer pixels, as [`crate::Part::is_half`]
    /// makes them.
    pub receivers: &'a Receivers,
    /// The visibility of these.
    pub visibility: &'a VisibilityTarget,
}

/// Takes visibility of fewer pixels to all pixels by one full-screen pass: each takes its value
/// from those of the four nearest that lie on its own surface. A technique at half the size costs
/// a quarter a pixel; edges of shadows then are as exact as two pixels allow, and what is smaller
/// than those may be missed.
pub struct Upsample {
    gpu: Gpu,
    target: HostTarget,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    /// By whether receivers have normals.
    pipelines: [Option<wgpu::RenderPipeline>; 2],
    bound: Option<([wgpu::TextureView; 2], wgpu::BindGroup)>,
}

impl Upsample {
    /// For targets of this kind: [`VisibilityTarget::FORMAT`], or as [`crate::Deliver`] takes them.
    ///
    /// # Errors
    /// As [`crate::Deliver::new`].
    pub fn new(gpu: &Gpu, target: wgpu::ColorTargetState) -> Result<Self, Error> {
        let bindings = [UNIFORM, fullscreen::texture(wgpu::TextureSampleType::Depth), fullscreen::texture(FLOATS)];
        let layout = fullscreen::layout(gpu, "upsample", wgpu::ShaderStages::FRAGMENT, &bindings);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = gpu.buffer("upsample", &[Upsampling::default()], usage);
        let target = HostTarget::new(gpu, target)?;
        Ok(Self {
            gpu: gpu.clone(),
            target,
            module: SHADER.module(gpu),
            layout,
            uniform,
            pipelines: [None, None],
            bound: None,
        })
    }

    /// Records the pass: visibility of all pixels of `receivers`, which `camera` shows, is then in
    /// `target` from pixel `corner` on, and what is around it stays.
    ///
    /// # Errors
    /// [`Error::Lent`] where it does not fit in, [`Error::Scene`] where both of `coarse` differ in
    /// size.
    pub fn record(
        &mut self,
        passes: &mut Passes<'_>,
        camera: &CameraView,
        receivers: &Receivers,
        coarse: &Coarse<'_>,
        target: &wgpu::TextureView,
        corner: (u32, u32),
    ) -> Result<(), Error> {
        coarse.visibility.check(coarse.receivers)?;
        passes.upload(&self.uniform, bytemuck::bytes_of(&Upsampling::of(camera, receivers, coarse, corner)));
        let views = [&coarse.receivers.depth, &coarse.visibility.view];
        let kept = self.bound.take().filter(|(bound, _)| bound.each_ref() == views);
        let bind_group = kept.map_or_else(|| self.bind(views), |(_, group)| group);
        let has_normals = receivers.has_normals;
        let known = self.pipelines[usize::from(has_normals)].take();
        let pipeline = known.unwrap_or_else(|| self.pipeline(has_normals));
        let mut pass = self.target.begin(passes, "upsample visibility", target, corner, receivers.size)?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &receivers.bind_group, &[]);
        pass.set_bind_group(1, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.bound = Some((views.map(Clone::clone), bind_group));
        self.pipelines[usize::from(has_normals)] = Some(pipeline);
        Ok(())
    }

    fn pipeline(&self, has_normals: bool) -> wgpu::RenderPipeline {
        let (label, entry, module) = ("upsample", "upsample", &self.module);
        let of_receivers = Receivers::layout(&self.gpu);
        let groups = &[&of_receivers, &self.layout];
        let constants = &[("HAS_NORMALS", f64::from(u8::from(has_normals)))];
        Fullscreen { label, module, entry, groups, target: self.target.state(), constants }.pipeline(&self.gpu)
    }

    fn bind(&self, [depth, visibility]: [&wgpu::TextureView; 2]) -> wgpu::BindGroup {
        let views = [depth, visibility].map(wgpu::BindingResource::TextureView);
        let resources = [[self.uniform.as_entire_binding()].as_slice(), &views].concat();
        bind(&self.gpu, "upsample", &self.layout, &resources)
    }
}

impl Upsampling {
    fn of(camera: &CameraView, receivers: &Receivers, coarse: &Coarse<'_>, corner: (u32, u32)) -> Self {
        let [fine, coarse] = [receivers.size, coarse.receivers.size];
        let as_f32 = |(width, height): (u32, u32)| [width as f32, height as f32];
        let ([fine_w, fine_h], [w, h]) = (as_f32(fine), as_f32(coarse));
        Self {
            eye: Eye::of(camera, receivers.size, receivers.snapping.max(receivers.bend), receivers.coarseness),
            ndc_from_coarse: [2.0 / w, -2.0 / h],
            scale: [w / fine_w, h / fine_h],
            corner: [corner.0 as i32, corner.1 as i32],
            coarse_size: [coarse.0 as i32, coarse.1 as i32],
        }
    }
}
