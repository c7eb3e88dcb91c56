//! A piece of a light, most often all of it: its casters, silhouettes and wedges.

use super::draws::Draw;
use super::groups::Group;
use super::groups::find_groups;
use super::options::Batch;
use super::options::Options;
use super::pipelines::Key;
use super::pipelines::Making;
use super::pipelines::Pipelines;
use super::select::CHUNK;
use super::select::Selection;
use super::tables::Term;
use super::targets::BUNDLES;
use super::targets::Buffers;
use super::targets::GROUP;
use super::targets::Needs;
use super::targets::SINGLES;
use super::targets::Target;
use crate::area_light::{Form, Frame, ROUNDING};
use crate::casters::Edges;
use crate::receivers::Eye;
use crate::fullscreen::attachment;
use crate::silhouettes::{Extrude, Part, Silhouettes, Style};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};
use std::ops::Range;

/// Workgroups in a row, the most that every adapter allows.
const ROW: u32 = 65_535;

/// Wedges that a thread puts into bundles, see `bundle.wgsl`, and workgroups that do so at most: few edges are silhouettes, so
/// most of one a window of edges would find nothing to do.
const WINDOW: u32 = 16;
const MOST_GROUPS: u32 = 32;

/// Corners of a body and of a side, by which vertices are numbered.
const BODY_CORNERS: u32 = 6;
const SIDE_CORNERS: u32 = 4;

/// Indices of a body and of a side.
pub(super) const BODY_INDICES: u32 = 24;
const SIDE_INDICES: u32 = 6;

pub(super) struct Piece {
    pub form: Form,
    /// How shares of it are found.
    pub term: Term,
    pub selection: Selection,
    pub silhouettes: Silhouettes,
    pub buffers: Option<Buffers>,
    /// Casters or loops that are drawn one by one, where the CPU lists silhouettes.
    groups: Vec<Group>,
    /// The shadows that the eye is in: of casters that are drawn apart a slot each, of all others the first. See [`Selection::eye_counts`].
    eye_counts: Vec<[u32; 2]>,
}

/// What recording takes.
pub(super) struct Recording<'a> {
    pub options: &'a Options,
    pub pipelines: &'a Pipelines,
    pub target: &'a Target,
    pub body_indices: &'a wgpu::Buffer,
    /// Tables that shares are looked up in.
    pub tables: &'a wgpu::BindGroup,
    /// Reads what a loop or a caster comes to.
    pub apart: Option<&'a wgpu::BindGroup>,
}

impl Piece {
    pub fn new(gpu: &Gpu, form: Form, options: &Options) -> Self {
        let extrude = if options.listed() { Extrude::Cpu } else { Extrude::Compute };
        let silhouettes = Silhouettes::new(gpu, extrude);
        Self {
            form,
            term: Term::Analytic,
            selection: Selection::default(),
            silhouettes,
            buffers: None,
            groups: Vec::new(),
            eye_counts: Vec::new(),
        }
    }

    /// Silhouettes of the chosen casters, and room for their wedges.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        pipelines: &mut Pipelines,
        options: &Options,
    ) -> Result<(), Error> {
        let style = Style { weighted: true, quads: true };
        let projection = (&view.camera.clip_from_world(), is_reversed(view));
        let throws = &self.selection.throws;
        self.silhouettes.prepare(gpu, view.casters, projection, self.form.center, throws, style)?;
        self.groups.clear();
        if options.listed() {
            find_groups(view.casters, &self.silhouettes, &self.selection, options, &mut self.groups);
        }
        self.count_eye();
        let needs = Needs {
            wedges: self.silhouettes.room(Part::PassSides),
            caps: self.selection.caps.len() as u32,
            slots: self.eye_counts.len() as u32,
        };
        if self.buffers.as_ref().is_none_or(|b| !b.hold(&needs)) {
            self.buffers = Some(Buffers::new(gpu, pipelines, &needs)?);
        }
        pipelines.prepare_making(gpu, self.making(view, options));
        if options.bundles() {
            pipelines.prepare_making(gpu, Making::Bundles);
        }
        pipelines.prepare_making(gpu, Making::Caps);
        Ok(())
    }

    fn count_eye(&mut self) {
        self.eye_counts.clear();
        self.eye_counts.resize(1 + self.groups.len(), [0; 2]);
        for (throw, count) in self.selection.eye_counts.iter().enumerate() {
            let slot = self.groups.get(throw).map_or(0, |group| group.slot);
            let [facing, away] = count.unwrap_or_default();
            let sum = &mut self.eye_counts[slot as usize];
            *sum = [sum[0] + facing, sum[1] + away];
        }
    }

    /// What resolving reads: its share of the light, and the shadows that the eye is in of casters that are not drawn apart.
    pub fn record(&self) -> [f32; 4] {
        let [facing, away] = self.eye_counts.first().copied().unwrap_or_default();
        [self.form.weight as f32, facing as f32, away as f32, 0.0]
    }

    pub fn is_split(&self) -> bool {
        self.form.cell.is_some()
    }

    /// Wedges that the CPU found.
    fn listed(&self) -> u32 {
        self.silhouettes.found().map_or(0, |[sides, ..]| sides)
    }

    fn making(&self, view: &View<'_>, options: &Options) -> Making {
        Making::Wedges { reversed: is_reversed(view), halves: options.halves() }
    }

    /// Finds silhouettes and builds wedges.
    pub fn build(&self, passes: &mut Passes<'_>, view: &View<'_>, edges: &Edges, r: &Recording<'_>) {
        let Some(buffers) = &self.buffers else { return };
        let chunks = self.selection.caps.len() as u32;
        let frame = Frame { rounding: ROUNDING, cap_chunks: chunks, scale: r.target.key.scale };
        passes.upload(&buffers.light, bytemuck::bytes_of(&self.form.uniform(view, &frame)));
        passes.upload(&buffers.eye, bytemuck::bytes_of(&Eye::new(view)));
        passes.upload(&buffers.cap_chunks, bytemuck::cast_slice(&self.selection.caps));
        passes.upload(&buffers.eye_count, bytemuck::cast_slice(&self.eye_counts));
        let no_bodies = [GROUP * BODY_INDICES, 0, 0, 0, 0];
        passes.upload(&buffers.bodies, bytemuck::cast_slice(&[no_bodies; 3]));
        passes.upload(&buffers.singles, &[0; 8]);
        self.silhouettes.record(passes, edges);
        let Some(found) = self.silhouettes.found_by_gpu() else { return };
        let mut pass = passes.compute("build wedges");
        pass.set_bind_group(0, found, &[]);
        pass.set_bind_group(1, &edges.make_edges, &[]);
        if let Some(making) = r.pipelines.making(self.making(view, r.options)) {
            let groups = self.silhouettes.room(Part::PassSides).div_ceil(GROUP);
            pass.set_pipeline(making);
            pass.set_bind_group(2, &buffers.make, &[]);
            pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
        }
        let is_bundled = r.options.bundles() && !self.form.is_point();
        if let Some(bundling) = r.pipelines.making(Making::Bundles).filter(|_| is_bundled) {
            pass.set_pipeline(bundling);
            pass.set_bind_group(0, &buffers.bundle, &[]);
            let groups = self.silhouettes.room(Part::PassSides).div_ceil(WINDOW * GROUP);
            pass.dispatch_workgroups(groups.min(MOST_GROUPS), 1, 1);
            pass.set_bind_group(0, found, &[]);
        }
        let caps = r.pipelines.making(Making::Caps);
        if let Some(caps) = caps.filter(|_| chunks > 0) {
            pass.set_pipeline(caps);
            pass.set_bind_group(1, &edges.make_triangles, &[]);
            pass.set_bind_group(2, &buffers.make_caps, &[]);
            pass.dispatch_workgroups(chunks.min(ROW), chunks.div_ceil(ROW), 1);
        }
    }

    /// Adds up what casters cover of it in a layer of the target; gives the number of draws.
    pub fn add_up(&self, passes: &mut Passes<'_>, view: &View<'_>, layer: usize, r: &Recording<'_>) -> u32 {
        let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let Some(layer) = r.target.layers.get(layer) else { return 0 };
        let mut draws = 0;
        let is_soft = !self.form.is_point();
        if !r.options.apart() {
            let mut pass = self.begin(passes, view, attachment(layer, clear), r);
            match r.options.batch {
                Batch::PerWedge => {
                    draws += self.range(&mut pass, view, Draw::Sides, 0..self.listed(), r);
                    draws += self.caps(&mut pass, view, 0..self.selection.caps.len() as u32, r);
                    draws += if is_soft { self.wedge_by_wedge(&mut pass, view, r) } else { 0 };
                }
                _ => draws += self.all(&mut pass, view, r),
            }
            return draws;
        }
        let mut load = clear;
        for group in &self.groups {
            let is_apart = group.slot > 0;
            let (into, first) =
                if is_apart { (r.target.apart.as_ref().unwrap_or(layer), clear) } else { (layer, load) };
            {
                let mut pass = self.begin(passes, view, attachment(into, first), r);
                let [sides, bodies] = group.draws;
                draws += self.range(&mut pass, view, sides, group.wedges.clone(), r);
                draws += self.caps(&mut pass, view, group.caps.clone(), r);
                draws += if is_soft { self.range(&mut pass, view, bodies, group.wedges.clone(), r) } else { 0 };
            }
            if is_apart {
                draws += self.transfer(passes, view, attachment(layer, load), group, r);
            }
            load = wgpu::LoadOp::Load;
        }
        draws
    }

    fn begin<'p>(
        &self,
        passes: &'p mut Passes<'_>,
        view: &'p View<'_>,
        color: Option<wgpu::RenderPassColorAttachment<'p>>,
        r: &Recording<'p>,
    ) -> wgpu::RenderPass<'p> {
        let depth = r.target.depth(view).map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: None,
            stencil_ops: r
                .options
                .stencil
                .then_some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Discard }),
        });
        let mut pass = passes.render("wedges", &[color], depth);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        if let Some(buffers) = &self.buffers {
            pass.set_bind_group(1, &buffers.draw, &[]);
        }
        pass.set_bind_group(2, r.tables, &[]);
        pass
    }

    pub fn key(&self, view: &View<'_>, draw: Draw, target: &Target) -> Key {
        let depth = target.depth(view).map(|d| (d.texture().format(), is_reversed(view)));
        Key {
            draw,
            depth: depth.filter(|_| !draw.is_apart()),
            face: self.form.face,
            term: self.term,
            split: self.is_split(),
        }
    }

    /// All wedges at once, as the GPU counted them.
    fn all(&self, pass: &mut wgpu::RenderPass<'_>, view: &View<'_>, r: &Recording<'_>) -> u32 {
        let Some(buffers) = &self.buffers else { return 0 };
        let Some((arguments, offset)) = self.silhouettes.arguments(Part::PassSides) else { return 0 };
        let mut draws = 0;
        if let Some(pipeline) = r.pipelines.drawing(self.key(view, Draw::Sides, r.target)) {
            pass.set_pipeline(pipeline);
            pass.set_index_buffer(self.silhouettes.corner_indices().slice(..), wgpu::IndexFormat::Uint16);
            pass.draw_indexed_indirect(arguments, offset);
            draws += 1;
        }
        draws += self.caps(pass, view, 0..self.selection.caps.len() as u32, r);
        pass.set_index_buffer(r.body_indices.slice(..), wgpu::IndexFormat::Uint16);
        let bodies: &[(Draw, u64)] = match r.options.stencil {
            _ if self.form.is_point() => &[],
            _ if r.options.bundles() => &[(Draw::Singles, SINGLES), (Draw::Bundles, BUNDLES)],
            true => &[(Draw::Mask, 0), (Draw::MaskedBodies, 0)],
            false => &[(Draw::Bodies, 0)],
        };
        for (draw, arguments) in bodies {
            if let Some(pipeline) = r.pipelines.drawing(self.key(view, *draw, r.target)) {
                pass.set_pipeline(pipeline);
                pass.draw_indexed_indirect(&buffers.bodies, *arguments);
                draws += 1;
            }
        }
        draws
    }

    /// Light caps and dark caps of what is counted from infinity.
    fn caps(&self, pass: &mut wgpu::RenderPass<'_>, view: &View<'_>, chunks: Range<u32>, r: &Recording<'_>) -> u32 {
        let pipeline = r.pipelines.drawing(self.key(view, Draw::Caps, r.target));
        let Some(pipeline) = pipeline.filter(|_| !chunks.is_empty()) else { return 0 };
        pass.set_pipeline(pipeline);
        pass.draw(chunks.start * 3 * CHUNK..chunks.end * 3 * CHUNK, 0..2);
        1
    }

    /// Sides or bodies of some wedges, groups of 64 and what is left.
    fn range(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        view: &View<'_>,
        draw: Draw,
        wedges: Range<u32>,
        r: &Recording<'_>,
    ) -> u32 {
        let Some(pipeline) = r.pipelines.drawing(self.key(view, draw, r.target)) else { return 0 };
        pass.set_pipeline(pipeline);
        let (indices, corners, each) = match draw.how().is_body {
            true => (r.body_indices, BODY_CORNERS, BODY_INDICES),
            false => (self.silhouettes.corner_indices(), SIDE_CORNERS, SIDE_INDICES),
        };
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint16);
        let count = wedges.end - wedges.start;
        let (groups, left) = (count / GROUP, count % GROUP);
        let first = |number: u32| (number * corners) as i32;
        let mut draws = 0;
        if groups > 0 {
            pass.draw_indexed(0..GROUP * each, first(wedges.start), 0..groups);
            draws += 1;
        }
        if left > 0 {
            pass.draw_indexed(0..left * each, first(wedges.end - left), 0..1);
            draws += 1;
        }
        draws
    }

    /// One wedge after the other, in two halves, each with a mask if there is one (PX 4.1–4.3).
    fn wedge_by_wedge(&self, pass: &mut wgpu::RenderPass<'_>, view: &View<'_>, r: &Recording<'_>) -> u32 {
        let halves = match r.options.stencil {
            true => [(Some(Draw::FrontMask), Draw::MaskedFront), (Some(Draw::FrontMask), Draw::MaskedBack)],
            false => [(None, Draw::Front), (None, Draw::Back)],
        };
        let find = |draw| r.pipelines.drawing(self.key(view, draw, r.target));
        let halves = halves.map(|(mask, draw)| (mask.and_then(find), find(draw)));
        pass.set_index_buffer(r.body_indices.slice(..), wgpu::IndexFormat::Uint16);
        let mut draws = 0;
        for wedge in 0..self.listed() {
            for (half, (mask, draw)) in (0..).zip(halves) {
                for pipeline in [mask, draw].into_iter().flatten() {
                    pass.set_pipeline(pipeline);
                    pass.draw_indexed(0..BODY_INDICES, (wedge * BODY_CORNERS) as i32, half..half + 1);
                    draws += 1;
                }
            }
        }
        draws
    }

    /// Adds what a loop or a caster came to.
    fn transfer(
        &self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        into: Option<wgpu::RenderPassColorAttachment<'_>>,
        group: &Group,
        r: &Recording<'_>,
    ) -> u32 {
        let pipeline = group.transfer.and_then(|draw| r.pipelines.drawing(self.key(view, draw, r.target)));
        let (Some(pipeline), Some(sums)) = (pipeline, r.apart) else { return 0 };
        let mut pass = passes.render("add loop", &[into], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, sums, &[]);
        pass.draw(0..3, group.slot..group.slot + 1);
        1
    }

    pub fn bytes(&self) -> u64 {
        self.silhouettes.bytes() + self.buffers.as_ref().map_or(0, Buffers::bytes)
    }
}

pub(super) fn is_reversed(view: &View<'_>) -> bool {
    view.camera.background_depth() == 0.0
}
