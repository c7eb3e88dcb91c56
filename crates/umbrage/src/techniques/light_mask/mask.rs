//! The pass that removes samples, and what it reads.

use super::casters::{Placed, Trees};
use super::grown::storage;
use super::half_planes::{DISTANCES, TURNS, half_planes};
use super::samples::{reach, samples};
use super::tree::TreeNode;
use crate::area_light::{AreaLight, Face, Form, Frame, ROUNDING};
use crate::fullscreen::{Fullscreen, STORAGE, UNIFORM, bind, layout};
use crate::receivers::Eye;
use crate::receivers::Receivers;
use crate::shader::Shader;
use crate::{
    error::Error,
    gpu::Gpu,
    passes::{Kept, Passes},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::{LightShape, Texture};

pub(super) const MASK_SHADER: Shader =
    Shader::new("light mask", include_str!("light_mask.wgsl")).with_layouts(&[TreeNode::LAYOUT, Placed::LAYOUT]);

/// Samples in a word of the mask.
const WORD: u32 = 32;

/// Removes the samples of a light.
pub(super) struct Mask {
    words: u32,
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
    pipelines: Vec<((Face, bool), wgpu::RenderPipeline)>,
    light: wgpu::Buffer,
    eye: wgpu::Buffer,
    /// Face, whether it is a point, and picture that half planes were made for, and they.
    made_for: Option<(Face, bool, Option<Texture>)>,
    half_planes: wgpu::Buffer,
    new_half_planes: Option<Vec<[u32; 4]>>,
    /// With the [`crate::Casters::version`] of the casters that they are trees of, and their
    /// vertices.
    trees: Option<(u64, wgpu::Buffer, Trees)>,
    bind_group: Option<wgpu::BindGroup>,
    /// Half planes and trees on the GPU.
    kept: Kept,
}

impl Mask {
    /// `samples` of the light, rounded up to a multiple of 32.
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let words = samples.div_ceil(WORD);
        let bindings = [UNIFORM, UNIFORM, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE];
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            words,
            layout: layout(gpu, "light mask", wgpu::ShaderStages::FRAGMENT, &bindings),
            module: MASK_SHADER.module(gpu),
            pipelines: Vec::new(),
            light: gpu.buffer("light", &[AreaLight::default()], uniform),
            eye: gpu.buffer("eye", &[Eye::default()], uniform),
            made_for: None,
            kept: Kept::default(),
            half_planes: storage(gpu, "half planes", u64::from(TURNS * DISTANCES * words.div_ceil(4)) * 16),
            new_half_planes: None,
            trees: None,
            bind_group: None,
        }
    }

    /// Makes trees of the chosen casters, half planes and pipelines.
    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, form: &Form, chosen: &[u32]) -> Result<(), Error> {
        let positions = view.casters.positions();
        let version = view.casters.version();
        match &mut self.trees {
            Some((of, bound, _)) if *of == version => {
                if bound != positions {
                    *bound = positions.clone();
                    self.bind_group = None;
                }
            }
            _ => {
                self.trees = Some((version, positions.clone(), Trees::new(gpu)));
                self.bind_group = None;
            }
        }
        let holds = self.kept.holds();
        if !holds {
            self.made_for = None;
        }
        self.make_half_planes(view, form);
        let Some((.., trees)) = &mut self.trees else { return Ok(()) };
        if !holds {
            trees.forget();
        }
        if trees.prepare(gpu, view, chosen)? || self.bind_group.is_none() {
            let [nodes, triangles, top, placed] = trees.buffers();
            let buffers = [&self.light, &self.eye, nodes, triangles, positions, top, placed, &self.half_planes];
            let entries = buffers.map(|b| b.as_entire_binding());
            self.bind_group = Some(bind(gpu, "light mask", &self.layout, &entries));
        }
        self.prepare_pipeline(gpu, form.face, view.receivers.has_normals);
        Ok(())
    }

    /// Only if the light looks otherwise than before. Whether a picture is the same is asked of its
    /// pixels, since hosts may change them where they are.
    fn make_half_planes(&mut self, view: &View<'_>, form: &Form) {
        let picture = match view.light.shape {
            LightShape::Rect { texture: Some(index), .. } => view.textures.get(index),
            _ => None,
        };
        let (face, is_point) = (form.face, form.is_point());
        let is_same = |(f, p, of): &(_, _, Option<Texture>)| (*f, *p, of.as_ref()) == (face, is_point, picture);
        if !self.made_for.as_ref().is_some_and(is_same) {
            let samples = samples(picture, form, self.words * WORD);
            self.new_half_planes = Some(half_planes(&samples, reach(face)));
            self.made_for = Some((face, is_point, picture.cloned()));
        }
    }

    fn prepare_pipeline(&mut self, gpu: &Gpu, face: Face, has_normals: bool) {
        if self.pipelines.iter().any(|(k, _)| *k == (face, has_normals)) {
            return;
        }
        let has = if has_normals { 1.0 } else { 0.0 };
        let constants = [
            ("FACE", f64::from(face as u32)),
            ("WORDS", f64::from(self.words)),
            ("FOURS", f64::from(self.words.div_ceil(4))),
            ("REACH", reach(face)),
            ("TURNS", f64::from(TURNS)),
            ("DISTANCES", f64::from(DISTANCES)),
            ("HAS_NORMALS", has),
        ];
        let made = Fullscreen {
            label: "light mask",
            module: &self.module,
            entry: "mask",
            groups: &[&Receivers::layout(gpu), &self.layout],
            target: VisibilityTarget::FORMAT.into(),
            constants: &constants,
        };
        self.pipelines.push(((face, has_normals), made.pipeline(gpu)));
    }

    /// Leaves visibility in the target.
    pub fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, form: &Form, visibility: &VisibilityTarget) {
        let key = (form.face, view.receivers.has_normals);
        let pipeline = self.pipelines.iter().find(|(k, _)| *k == key);
        let (Some((_, pipeline)), Some(group), Some((.., trees))) = (pipeline, &self.bind_group, &mut self.trees)
        else {
            return;
        };
        let frame = Frame { rounding: ROUNDING, cap_chunks: 0, scale: 1, wedges: [0; 2] };
        passes.upload(&self.light, bytemuck::bytes_of(&form.uniform(view, &frame)));
        passes.upload(&self.eye, bytemuck::bytes_of(&Eye::new(view)));
        if self.new_half_planes.is_some() || trees.is_new() {
            self.kept.note(passes);
        }
        if let Some(made) = self.new_half_planes.take() {
            passes.upload(&self.half_planes, bytemuck::cast_slice(&made));
        }
        trees.upload(passes);
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Bytes that a pixel reads at most: all trees, and of each triangle its corners and four half
    /// planes.
    pub fn most_read(&self) -> u64 {
        let of = |(.., trees): &(u64, wgpu::Buffer, Trees)| {
            let [nodes, triangles, top, placed] = trees.buffers().map(wgpu::Buffer::size);
            let corners = triangles / 4;
            nodes + top + placed + triangles + corners * 12 + corners / 3 * 4 * 16 * u64::from(self.words.div_ceil(4))
        };
        self.trees.as_ref().map_or(0, of)
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        let trees = self.trees.iter().flat_map(|(.., trees)| trees.buffers());
        trees.chain([&self.light, &self.eye, &self.half_planes]).map(|b| b.size()).sum()
    }
}
