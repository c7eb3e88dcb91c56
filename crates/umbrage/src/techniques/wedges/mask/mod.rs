//! `combine = bitmask`: every point keeps one bit for each sample of the light, and triangles strike them out.

mod half_planes;
mod tree;

use super::light::{Face, Form, Frame};
use super::select::Selection;
use crate::casters::Casters;
use crate::depth_maps::Eye;
use crate::fullscreen::{Fullscreen, STORAGE, UNIFORM, bind, layout};
use crate::receivers::Receivers;
use crate::shader::{FULLSCREEN, RECEIVERS, Shader, shader_struct};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View, visibility::VisibilityTarget};
use half_planes::{DISTANCES, TURNS, half_planes};
use std::ops::Range;
use tree::{Boxed, TreeNode, append};
use umbrage_core::glam::{DAffine3, DVec2, Vec3};
use umbrage_core::sampling::{Luminance, lattice, square_to_disc};
use umbrage_core::{LightShape, Mesh, Texture};

pub(super) const MASK_SHADER: Shader = Shader {
    name: "samples of a light",
    parts: &[FULLSCREEN, RECEIVERS, include_str!("../light.wgsl"), include_str!("mask.wgsl")],
    layouts: &[super::light::WedgeLight::LAYOUT, Eye::LAYOUT, TreeNode::LAYOUT, Placed::LAYOUT],
};

shader_struct! {
    /// A placed mesh, see `mask.wgsl`.
    pub(crate) struct Placed {
        mesh_from_eye: [[f32; 4]; 3],
        eye_from_mesh: [[f32; 4]; 3],
        first_node: u32,
        end_node: u32,
        tolerance: f32,
        pad: u32,
    }
}

/// Samples in a word of the mask.
const WORD: u32 = 32;

/// Masks of a light's samples.
pub(super) struct Mask {
    words: u32,
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
    pipelines: Vec<((Face, bool), wgpu::RenderPipeline)>,
    meshes: Option<Meshes>,
    light: wgpu::Buffer,
    eye: wgpu::Buffer,
    /// Face, whether it is a point, and picture that half planes were made for, and they.
    made_for: Option<(Face, bool, Option<Texture>)>,
    half_planes: wgpu::Buffer,
    new_half_planes: Option<Vec<[u32; 4]>>,
    top: Grown,
    placed: Grown,
    top_data: Vec<TreeNode>,
    placed_data: Vec<Placed>,
    bind_group: Option<wgpu::BindGroup>,
}

/// Trees of all meshes of some casters.
struct Meshes {
    /// Whose they are.
    positions: wgpu::Buffer,
    nodes: Grown,
    triangles: Grown,
    node_data: Vec<TreeNode>,
    triangle_data: Vec<u32>,
    of: Vec<Range<u32>>,
    /// Nodes and triangles of meshes that are not posed come first and stay.
    fixed: (usize, usize),
    is_new: bool,
}

/// A storage buffer that is made anew when it gets too small.
struct Grown {
    label: &'static str,
    buffer: wgpu::Buffer,
}

impl Grown {
    fn new(gpu: &Gpu, label: &'static str) -> Self {
        Self { label, buffer: storage(gpu, label, 256) }
    }

    /// True where it was made anew.
    fn fit(&mut self, gpu: &Gpu, bytes: usize) -> Result<bool, Error> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let size = bytes as u64;
        if size <= self.buffer.size() {
            return Ok(false);
        }
        if size > limit {
            return Err(Error::Size { what: format!("{} of a light's samples", self.label), size, limit });
        }
        self.buffer = storage(gpu, self.label, (size + size / 2).next_multiple_of(16).min(limit));
        Ok(true)
    }
}

fn storage(gpu: &Gpu, label: &str, size: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

impl Mask {
    /// `samples` of the light; a multiple of 32.
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let words = samples.div_ceil(WORD);
        let bindings = [UNIFORM, UNIFORM, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE];
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            words,
            layout: layout(gpu, "samples of a light", wgpu::ShaderStages::FRAGMENT, &bindings),
            module: MASK_SHADER.module(gpu),
            pipelines: Vec::new(),
            meshes: None,
            light: gpu.buffer("light", &[super::light::WedgeLight::default()], uniform),
            eye: gpu.buffer("eye", &[Eye::default()], uniform),
            made_for: None,
            half_planes: storage(gpu, "half planes", u64::from(TURNS * DISTANCES * words.div_ceil(4)) * 16),
            new_half_planes: None,
            top: Grown::new(gpu, "boxes of casters"),
            placed: Grown::new(gpu, "placed meshes"),
            top_data: Vec::new(),
            placed_data: Vec::new(),
            bind_group: None,
        }
    }

    /// Makes trees, records and pipelines.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        form: &Form,
        selection: &Selection,
        rounding: f64,
    ) -> Result<(), Error> {
        let casters = view.casters;
        if self.meshes.as_ref().is_none_or(|m| m.positions != casters.positions) {
            self.meshes = Some(Meshes::new(gpu, casters));
            self.bind_group = None;
        }
        self.make_half_planes(view, form);
        let Some(meshes) = &mut self.meshes else { return Ok(()) };
        meshes.pose(casters);
        let eye = view.camera.eye;
        let mut boxes = Vec::with_capacity(selection.throws.len());
        let mut records = Vec::with_capacity(selection.throws.len());
        for throw in &selection.throws {
            let caster = &casters.placed()[throw.place as usize];
            let Some(sides) = &caster.sides else { continue };
            let bounds = caster.bounds.grown(rounding * caster.bounds.largest_coordinate());
            boxes.push(Boxed((bounds.min - eye).as_vec3(), (bounds.max - eye).as_vec3()));
            let range = meshes.of[caster.mesh as usize].clone();
            records.push(Placed::of(&sides.mesh_from_world, view, range, rounding));
        }
        self.top_data.clear();
        let mut order = Vec::with_capacity(boxes.len());
        append(&boxes, &mut self.top_data, &mut order);
        if self.top_data.is_empty() {
            self.top_data.push(TreeNode::default());
        }
        self.placed_data.clear();
        self.placed_data.extend(order.iter().map(|i| records[*i as usize]));
        let grown = [
            self.top.fit(gpu, size_of_val(&self.top_data[..]))?,
            self.placed.fit(gpu, size_of_val(&self.placed_data[..]))?,
            meshes.nodes.fit(gpu, size_of_val(&meshes.node_data[..]))?,
            meshes.triangles.fit(gpu, size_of_val(&meshes.triangle_data[..]))?,
        ];
        meshes.is_new |= grown[2] || grown[3];
        if grown.contains(&true) || self.bind_group.is_none() {
            let buffers = [
                &self.light,
                &self.eye,
                &meshes.nodes.buffer,
                &meshes.triangles.buffer,
                &casters.positions,
                &self.top.buffer,
                &self.placed.buffer,
                &self.half_planes,
            ];
            let entries = buffers.map(|b| b.as_entire_binding());
            self.bind_group = Some(bind(gpu, "samples of a light", &self.layout, &entries));
        }
        self.prepare_pipeline(gpu, form.face, view.receivers.has_normals);
        Ok(())
    }

    /// Only if the light looks otherwise than before. Whether a picture is the same is asked of its pixels, since hosts may change them where they are.
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
            label: "samples of a light",
            module: &self.module,
            entry: "mask",
            groups: &[&Receivers::layout(gpu), &self.layout],
            target: VisibilityTarget::FORMAT.into(),
            constants: &constants,
        };
        self.pipelines.push(((face, has_normals), made.pipeline(gpu)));
    }

    /// Leaves visibility in the target.
    pub fn record(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        form: &Form,
        rounding: f64,
        visibility: &VisibilityTarget,
    ) {
        let key = (form.face, view.receivers.has_normals);
        let pipeline = self.pipelines.iter().find(|(k, _)| *k == key);
        let (Some((_, pipeline)), Some(group), Some(meshes)) = (pipeline, &self.bind_group, &mut self.meshes) else {
            return;
        };
        passes
            .upload(&self.light, bytemuck::bytes_of(&form.uniform(view, &Frame { rounding, cap_chunks: 0, scale: 1 })));
        passes.upload(&self.eye, bytemuck::bytes_of(&Eye::new(view)));
        if let Some(made) = self.new_half_planes.take() {
            passes.upload(&self.half_planes, bytemuck::cast_slice(&made));
        }
        passes.upload(&self.top.buffer, bytemuck::cast_slice(&self.top_data));
        passes.upload(&self.placed.buffer, bytemuck::cast_slice(&self.placed_data));
        if std::mem::take(&mut meshes.is_new) {
            passes.upload(&meshes.nodes.buffer, bytemuck::cast_slice(&meshes.node_data));
            passes.upload(&meshes.triangles.buffer, bytemuck::cast_slice(&meshes.triangle_data));
        }
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        let own = [&self.light, &self.eye, &self.half_planes, &self.top.buffer, &self.placed.buffer];
        let meshes = self.meshes.as_ref().map_or(0, |m| m.nodes.buffer.size() + m.triangles.buffer.size());
        own.map(|b| b.size()).iter().sum::<u64>() + meshes
    }
}

impl Placed {
    fn of(mesh_from_world: &DAffine3, view: &View<'_>, nodes: Range<u32>, rounding: f64) -> Self {
        let eye = view.camera.eye;
        let mesh_from_eye = *mesh_from_world * DAffine3::from_translation(eye);
        let m = mesh_from_eye.matrix3;
        let offset = mesh_from_eye.translation;
        let row = |i: usize| m.row(i).extend(offset[i]).as_vec4().to_array();
        let back = m.inverse();
        let column = |i: usize| back.col(i).extend(0.0).as_vec4().to_array();
        // What a depth buffer's rounding and single precision come to.
        let coordinates = view.casters.all_bounds().largest_coordinate().max(eye.abs().max_element());
        let stretch = [m.x_axis, m.y_axis, m.z_axis].map(|c| c.length()).into_iter().fold(0.0, f64::max);
        Self {
            mesh_from_eye: [0, 1, 2].map(row),
            eye_from_mesh: [0, 1, 2].map(column),
            first_node: nodes.start,
            end_node: nodes.end,
            tolerance: (4.0 * rounding * coordinates * stretch) as f32,
            pad: 0,
        }
    }
}

impl Meshes {
    fn new(gpu: &Gpu, casters: &Casters) -> Self {
        let parts = casters.meshes();
        let mut made = Self {
            positions: casters.positions.clone(),
            nodes: Grown::new(gpu, "boxes"),
            triangles: Grown::new(gpu, "triangles"),
            node_data: Vec::new(),
            triangle_data: Vec::new(),
            of: vec![0..0; parts.len()],
            fixed: (0, 0),
            is_new: true,
        };
        for (number, part) in parts.iter().enumerate().filter(|(n, _)| casters.posed_mesh(*n).is_none()) {
            made.add(number, &part.mesh, part.base_vertex);
        }
        made.fixed = (made.node_data.len(), made.triangle_data.len());
        made
    }

    /// Builds the trees of posed meshes anew.
    fn pose(&mut self, casters: &Casters) {
        self.node_data.truncate(self.fixed.0);
        self.triangle_data.truncate(self.fixed.1);
        for (number, part) in casters.meshes().iter().enumerate() {
            if let Some(posed) = casters.posed_mesh(number) {
                self.add(number, &posed, part.base_vertex);
                self.is_new = true;
            }
        }
    }

    fn add(&mut self, number: usize, mesh: &Mesh, base_vertex: u32) {
        let is_whole = |t: &[u32; 3]| t.iter().all(|i| mesh.positions.get(*i as usize).is_some_and(|p| p.is_finite()));
        let whole: Vec<[u32; 3]> = mesh.triangles().filter(is_whole).collect();
        let boxes: Vec<Boxed> = whole.iter().map(|t| around(mesh.corners(*t))).collect();
        let (first_node, mut order) = (self.node_data.len() as u32, vec![0; self.triangle_data.len() / 3]);
        let known = order.len();
        append(&boxes, &mut self.node_data, &mut order);
        let vertices = order[known..].iter().flat_map(|i| whole[*i as usize].map(|v| base_vertex + v));
        self.triangle_data.extend(vertices);
        self.of[number] = first_node..self.node_data.len() as u32;
    }
}

fn around([a, b, c]: [Vec3; 3]) -> Boxed {
    Boxed(a.min(b).min(c), a.max(b).max(c))
}

/// How far from the middle of the face there are samples.
fn reach(face: Face) -> f64 {
    if matches!(face, Face::Square | Face::Picture) { std::f64::consts::SQRT_2 } else { 1.0 }
}

/// Points of the light on its face.
fn samples(picture: Option<&Texture>, form: &Form, count: u32) -> Vec<DVec2> {
    let picture = picture.and_then(Luminance::of);
    let on_face = |u: DVec2| match form.face {
        _ if form.is_point() => DVec2::ZERO,
        Face::Ball | Face::Disc => square_to_disc(u),
        Face::Line => DVec2::new(u.x * 2.0 - 1.0, 0.0),
        Face::Square | Face::Picture => picture.as_ref().map_or(u, |p| p.sample(u)) * 2.0 - 1.0,
    };
    lattice(count as usize).into_iter().map(on_face).collect()
}
