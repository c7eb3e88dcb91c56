//! Casters drawn into a map of a stage's own, by a shader of its own.

use super::layouts::{view_layout, view_uniform};
use super::view::MapView;
use crate::casters::{ByForm, CasterDraw, Casters, DrawList, Form, InstanceNumbers, Surface};
use crate::depth_maps::frame::MapFrame;
use crate::{gpu::Gpu, passes::Passes, shader::Shader, view::View};

/// Draws what each of a light's views sees of the casters, such as colours of stained glass and
/// thicknesses.
///
/// The shader needs the module `map_depth`, which has its vertex shaders, `opaque` and `masked`; it
/// may read the view as `map_view`. Views that are no matrices
/// ([`umbrage_core::light_view::LightView::paraboloid`]) are not for it.
pub struct CasterPass {
    pipelines: ByForm<[wgpu::RenderPipeline; 2]>,
    made_by: Maker,
    layout: wgpu::BindGroupLayout,
    /// By layer.
    uniforms: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
    lists: Vec<DrawList>,
    views: Vec<MapView>,
    numbers: InstanceNumbers,
    found: Vec<u32>,
}

/// What pipelines are made by.
struct Maker {
    label: &'static str,
    module: wgpu::ShaderModule,
    fragments: [String; 2],
    targets: Vec<Option<wgpu::ColorTargetState>>,
    depth_stencil: Option<wgpu::DepthStencilState>,
}

impl Maker {
    /// For opaque casters and for those with an alpha mask.
    fn pipelines(&self, gpu: &Gpu, layout: &wgpu::BindGroupLayout, form: Form) -> [wgpu::RenderPipeline; 2] {
        let [opaque, masked] = &self.fragments;
        [("opaque", opaque), ("masked", masked)].map(|(vertex, fragment)| {
            CasterDraw {
                label: self.label,
                form,
                view: layout,
                textured: true,
                more: None,
                module: &self.module,
                vertex,
                fragment: Some(fragment),
                constants: &[],
                targets: &self.targets,
                depth_stencil: self.depth_stencil.clone(),
                cull_mode: None,
            }
            .pipeline(gpu)
        })
    }
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
        let layout = view_layout(gpu);
        let made_by = Maker {
            label: shader.name,
            module: shader.module(gpu),
            fragments: fragments.map(String::from),
            targets: targets.to_vec(),
            depth_stencil,
        };
        Self {
            pipelines: ByForm::new(made_by.pipelines(gpu, &layout, Form::OWN)),
            made_by,
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
        self.pipelines.follow(view.casters.forms(), |form| self.made_by.pipelines(gpu, &self.layout, form));
        let count = frame.views.len();
        self.uniforms.resize_with(self.uniforms.len().max(count), || view_uniform(gpu, &self.layout));
        self.lists.resize_with(self.lists.len().max(count), DrawList::default);
        self.numbers.clear(gpu, view.casters, count as u32);
        self.views.clear();
        for (light_view, list) in frame.views.iter().zip(&mut self.lists) {
            self.views.push(MapView::new(light_view, view.casters.origin(), frame.is_linear));
            self.found.clear();
            view.casters.casting().query(&light_view.frustum(), &mut self.found);
            frame.keep_held(view.casters, &mut self.found);
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
        let pipeline =
            |surface, _, form: &Form| Some(&self.pipelines.get(form)?[usize::from(surface == Surface::Masked)]);
        self.numbers.draw(&mut pass, casters, list, true, pipeline);
        list.draws()
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.numbers.bytes() + self.uniforms.iter().map(|(buffer, _)| buffer.size()).sum::<u64>()
    }
}
