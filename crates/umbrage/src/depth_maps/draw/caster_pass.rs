//! Casters drawn into a map of a stage's own, by a shader of its own.

use super::layouts::{view_layout, view_uniform};
use super::view::MapView;
use crate::casters::{CasterDraw, Casters, DrawList, InstanceNumbers, Surface};
use crate::depth_maps::frame::MapFrame;
use crate::{gpu::Gpu, passes::Passes, shader::Shader, view::View};

/// Draws what each of a light's views sees of the casters, such as colours of stained glass and
/// thicknesses.
///
/// The shader needs the module `map_depth`, which has its vertex shaders, `opaque` and `masked`; it
/// may read the view as `map_view`. Views that are no matrices
/// ([`umbrage_core::light_view::LightView::paraboloid`]) are not for it.
pub struct CasterPass {
    pipelines: [wgpu::RenderPipeline; 2],
    layout: wgpu::BindGroupLayout,
    /// By layer.
    uniforms: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
    lists: Vec<DrawList>,
    views: Vec<MapView>,
    numbers: InstanceNumbers,
    found: Vec<u32>,
}

impl CasterPass {
    /// `fragments`: the fragment shaders of opaque casters and of those with an alpha mask. Depth
    /// in views of light is reversed: 1 is nearest.
    pub fn new(
        gpu: &Gpu,
        shader: &Shader,
        fragments: [&str; 2],
        targets: &[Option<wgpu::ColorTargetState>],
        depth_stencil: Option<wgpu::DepthStencilState>,
    ) -> Self {
        let (layout, module) = (view_layout(gpu), shader.module(gpu));
        let pipeline = |vertex, fragment| {
            CasterDraw {
                label: shader.name,
                view: &layout,
                textured: true,
                more: None,
                module: &module,
                vertex,
                fragment: Some(fragment),
                constants: &[],
                targets,
                depth_stencil: depth_stencil.clone(),
                cull_mode: None,
            }
            .pipeline(gpu)
        };
        Self {
            pipelines: [pipeline("opaque", fragments[0]), pipeline("masked", fragments[1])],
            layout,
            uniforms: Vec::new(),
            lists: Vec::new(),
            views: Vec::new(),
            numbers: InstanceNumbers::default(),
            found: Vec::new(),
        }
    }

    /// Finds what the views of this frame see; in [`super::super::Stage::prepare`].
    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &MapFrame) {
        let count = frame.views.len();
        self.uniforms.resize_with(self.uniforms.len().max(count), || view_uniform(gpu, &self.layout));
        self.lists.resize_with(self.lists.len().max(count), DrawList::default);
        self.numbers.clear(gpu, view.casters, count as u32);
        self.views.clear();
        for (light_view, list) in frame.views.iter().zip(&mut self.lists) {
            self.views.push(MapView::new(light_view, view.casters.origin(), frame.is_linear));
            self.found.clear();
            view.casters.casting().query(&light_view.frustum(), &mut self.found);
            list.clear();
            self.numbers.list(view.casters, &self.found, None, None, list);
        }
    }

    /// Sends what was found to the GPU, before the first [`CasterPass::record`] of a frame.
    pub fn upload(&self, passes: &mut Passes<'_>, frame: &MapFrame) {
        self.numbers.upload(passes);
        for ((view, (buffer, _)), layer) in self.views.iter().zip(&self.uniforms).zip(&frame.views) {
            passes.upload(buffer, bytemuck::bytes_of(view));
            frame.take_matrix(passes, layer.layer, buffer);
        }
    }

    /// Draws what view number `i` of the frame sees; returns the number of draws.
    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        label: &str,
        casters: &Casters,
        i: usize,
        colors: &[Option<wgpu::RenderPassColorAttachment<'_>>],
        depth: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    ) -> u32 {
        let (Some((_, uniform)), Some(list)) = (self.uniforms.get(i), self.lists.get(i)) else { return 0 };
        let mut pass = passes.render(label, colors, depth);
        pass.set_bind_group(0, uniform, &[]);
        let pipeline = |surface| &self.pipelines[usize::from(surface == Surface::Masked)];
        self.numbers.draw(&mut pass, casters, list, true, pipeline);
        list.draws()
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.numbers.bytes() + self.uniforms.iter().map(|(buffer, _)| buffer.size()).sum::<u64>()
    }
}
