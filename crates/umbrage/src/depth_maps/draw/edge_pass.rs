//! Edges of casters drawn into a map of a stage's own, by shaders of its own.

use super::contour::Contour;
use super::layouts::{view_layout, view_uniform};
use super::view::MapView;
use crate::casters::Casters;
use crate::depth_maps::frame::MapFrame;
use crate::depth_maps::layers::Layers;
use crate::{error::Error, gpu::Gpu, passes::Passes, shader::Shader};
use std::sync::OnceLock;
use umbrage_core::glam::DVec4;
use umbrage_core::light_view::{LightView, Omni};

/// Draws the edges that bound the casters' shadows into layers of maps: points and fins on
/// silhouettes. Compute finds them once for all layers of a light; the CPU touches no edge.
///
/// The shader needs the module `map_edges`. Its vertex shaders take vertex and instance number and
/// ask `contour_edge` for the edge that they belong to: its ends in world space, relative to
/// [`Casters::origin`], and how many surfaces end there. `layer_edge` clips it to the layer, also
/// where that is a paraboloid or warped, and says **which side is outwards**, away from the shadow;
/// `outward_at` and `along_at` say so in metres. Each edge has four corners of a quad, which
/// `quad_corner` puts around it. Neighbours need not know of each other: where the quad reaches
/// beyond the ends as far as outwards, those of two edges that meet cover the corner between them.
///
/// What has edges:
/// - Any opaque mesh, closed or open, wound or mirrored as it may be, posed as the GPU has bent it.
///   An open mesh ends at its border, and an edge where it folds is there once, counting 2.
/// - A mesh with an alpha mask has none, since its outline is that of the mask. What it shadows is
///   in the map of depths alone.
/// - A caster around the light has those edges that the light sees from there; what is behind the
///   light is cut off.
/// - Edges within or behind another caster, and those that are no step of depth, are there, too. A
///   fragment shader that has the map of depths tells.
pub struct EdgePass {
    gpu: Gpu,
    module: wgpu::ShaderModule,
    draws: Vec<EdgeDraw>,
    constants: Vec<(&'static str, f64)>,
    pipeline_layout: wgpu::PipelineLayout,
    /// For each kind of layer that came up, one for each of `draws`, made when it is first drawn
    /// by: techniques have ways that only pictures of their inside need.
    pipelines: Vec<(Kind, Vec<OnceLock<wgpu::RenderPipeline>>)>,
    contour: Contour,
    view_layout: wgpu::BindGroupLayout,
    /// By number of the view in the frame.
    uniforms: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
    views: Vec<MapView>,
    kind: Kind,
}

/// Shaders and targets by which all edges are drawn.
#[derive(Clone, Debug)]
pub struct EdgeDraw {
    /// The vertex shader.
    pub vertex: &'static str,
    /// The fragment shader; without one depth alone is written.
    pub fragment: Option<&'static str>,
    /// Formats of colours, and how they are blended.
    pub targets: Vec<Option<wgpu::ColorTargetState>>,
    /// The depth test. Depth in views of light is reversed: 1 is nearest.
    pub depth_stencil: Option<wgpu::DepthStencilState>,
}

/// What edges are drawn into.
pub struct EdgeTarget<'a> {
    /// Of the pass, for its time.
    pub label: &'a str,
    /// As in a render pass.
    pub colors: &'a [Option<wgpu::RenderPassColorAttachment<'a>>],
    /// The same.
    pub depth: Option<wgpu::RenderPassDepthStencilAttachment<'a>>,
}

/// What pipelines are made for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Kind {
    perspective: bool,
    paraboloid: bool,
    /// Maps store linear depths.
    linear: bool,
}

impl EdgePass {
    /// `own` is the layout of what the shaders bind as group 3; `constants` override the shader's.
    /// A technique with this needs [`EdgePass::STORAGE_BUFFERS`].
    pub fn new(
        gpu: &Gpu,
        shader: &Shader,
        own: Option<&wgpu::BindGroupLayout>,
        constants: &[(&'static str, f64)],
        draws: Vec<EdgeDraw>,
    ) -> Self {
        let contour = Contour::new(gpu);
        let view_layout = view_layout(gpu);
        let groups = [Some(contour.layout()), None, Some(&view_layout), own];
        let pipeline_layout = gpu.pipeline_layout(&groups[..if own.is_some() { 4 } else { 3 }]);
        Self {
            gpu: gpu.clone(),
            module: shader.module(gpu),
            draws,
            constants: constants.to_vec(),
            pipeline_layout,
            pipelines: Vec::new(),
            contour,
            view_layout,
            uniforms: Vec::new(),
            views: Vec::new(),
            kind: Kind::default(),
        }
    }

    /// Storage buffers that a shader stage has to have room for.
    pub const STORAGE_BUFFERS: u32 = 8;

    /// Chooses the casters that any of `seen_by` sees (mostly the frame's own views), for their
    /// edges as seen from `light` (mostly [`umbrage_core::LightShape::center`]: a place, or with w
    /// = 0 a direction to it), drawn into the layers of `frame`. Costs nothing to speak of while
    /// all that is the same.
    ///
    /// # Errors
    /// [`Error::Size`] where the list of edges does not fit the adapter's limits. Of more
    /// silhouette edges than one binding holds (four million with WebGPU's limits) some are left
    /// out.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        casters: &Casters,
        light: DVec4,
        seen_by: &[LightView],
        frame: &MapFrame,
    ) -> Result<(), Error> {
        self.views.clear();
        self.views.extend(frame.views.iter().map(|view| MapView::new(view, casters.origin(), frame.is_linear)));
        let count = self.views.len();
        self.uniforms.resize_with(self.uniforms.len().max(count), || view_uniform(gpu, &self.view_layout));
        let paraboloid = frame.layers == Layers::Omni(Omni::DualParaboloid);
        self.kind = Kind { perspective: frame.is_from_a_point(), paraboloid, linear: frame.is_linear };
        if !self.pipelines.iter().any(|(kind, _)| *kind == self.kind) {
            self.pipelines.push((self.kind, self.draws.iter().map(|_| OnceLock::new()).collect()));
        }
        self.contour.prepare(gpu, casters, light, seen_by)
    }

    /// Finds the edges, before the first [`EdgePass::record`] of a frame. A frame in which no layer
    /// is drawn anew, see [`MapFrame::version`], needs neither.
    pub fn find(&self, passes: &mut Passes<'_>, casters: &Casters, frame: &MapFrame) {
        for ((view, (buffer, _)), layer) in self.views.iter().zip(&self.uniforms).zip(&frame.views) {
            passes.upload(buffer, bytemuck::bytes_of(view));
            frame.take_matrix(passes, layer.layer, buffer);
        }
        self.contour.record(passes, casters);
    }

    /// Draws all edges into the layer of view number `i` of the frame, by way number `draw` of
    /// those that [`EdgePass::new`] was given, in a pass of its own, which begins in any case, so
    /// that its load operation takes effect.
    /// Returns the number of draws.
    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        (i, draw): (usize, usize),
        own: Option<&wgpu::BindGroup>,
        target: EdgeTarget<'_>,
    ) -> u32 {
        let mut pass = passes.render(target.label, target.colors, target.depth);
        let pipelines = self.pipelines.iter().find(|(kind, _)| *kind == self.kind);
        let made = pipelines.and_then(|(_, pipelines)| pipelines.get(draw)).zip(self.draws.get(draw));
        let uniform = self.uniforms.get(i).filter(|_| i < self.views.len());
        let (Some((pipeline, draw)), Some((_, uniform))) = (made, uniform) else { return 0 };
        pass.set_pipeline(pipeline.get_or_init(|| self.pipeline(draw)));
        pass.set_bind_group(2, uniform, &[]);
        if own.is_some() {
            pass.set_bind_group(3, own, &[]);
        }
        u32::from(self.contour.draw(&mut pass))
    }

    /// Edges that are looked at.
    pub fn edges(&self) -> u64 {
        self.contour.edges()
    }

    /// Bytes of GPU memory held; the edges themselves are the casters'.
    pub fn bytes(&self) -> u64 {
        self.contour.bytes() + self.uniforms.iter().map(|(buffer, _)| buffer.size()).sum::<u64>()
    }

    fn pipeline(&self, draw: &EdgeDraw) -> wgpu::RenderPipeline {
        let on = |switch: bool| if switch { 1.0 } else { 0.0 };
        let Kind { perspective, paraboloid, linear } = self.kind;
        let own = [("PERSPECTIVE", on(perspective)), ("PARABOLOID", on(paraboloid)), ("LINEAR", on(linear))];
        let constants = [&self.constants[..], &own].concat();
        let compilation_options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        self.gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(draw.vertex),
            layout: Some(&self.pipeline_layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(draw.vertex),
                compilation_options: compilation_options(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: draw.depth_stencil.clone(),
            multisample: Default::default(),
            fragment: draw.fragment.map(|entry| wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(entry),
                compilation_options: compilation_options(),
                targets: &draw.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
